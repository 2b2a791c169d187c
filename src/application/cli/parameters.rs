//! `tribosweep parameters`: the names that a grid and `--set` know.

use super::error::CliError;
use super::output::{print, terminal_width};
use crate::exit;
use crate::publish::table::listed;
use crate::study::{PARAMETERS, Parameter};
use serde_json::{Value, json};

/// Arguments of `parameters`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Print them as JSON, with the field of the study that each of them sets.
    #[arg(long)]
    json: bool,
}

/// Prints the parameters.
pub(crate) fn run(args: &Args) -> Result<u8, CliError> {
    let text = if args.json {
        format!("{:#}\n", PARAMETERS.iter().map(as_json).collect::<Value>())
    } else {
        let cells: Vec<[String; 3]> = PARAMETERS.iter().map(cells).collect();
        listed(0, &cells, terminal_width())
    };
    print(&text)?;
    Ok(exit::SUCCESS)
}

fn as_json(parameter: &Parameter) -> Value {
    json!({
        "name": parameter.name,
        "unit": Some(parameter.unit).filter(|unit| !unit.is_empty()),
        "meaning": parameter.meaning,
        "field": parameter.field(),
    })
}

fn cells(parameter: &Parameter) -> [String; 3] {
    let unit = if parameter.unit.is_empty() { String::new() } else { format!("[{}]", parameter.unit) };
    [parameter.name.to_owned(), unit, parameter.meaning.to_owned()]
}

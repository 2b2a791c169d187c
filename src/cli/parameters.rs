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
        "unit": parameter.unit(),
        "meaning": parameter.description(),
        "field": parameter.field(),
    })
}

fn cells(parameter: &Parameter) -> [String; 3] {
    let unit = parameter.unit().map_or_else(String::new, |unit| format!("[{unit}]"));
    [parameter.name.to_owned(), unit, parameter.description().to_owned()]
}

//! `tribosweep columns`: what the columns of the export mean.

use super::aligned;
use super::error::CliError;
use super::output::{print, terminal_width};
use crate::exit;
use crate::report::columns::Column;
use crate::sweep::{self, ExportColumns};
use serde_json::{Value, json};

/// Arguments of `columns`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The columns of `export --all`: every input and the whole record too.
    #[arg(long)]
    all: bool,
    /// Print them as JSON.
    #[arg(long)]
    json: bool,
}

/// Prints the columns. The grid parameters of a study are further columns of its export.
pub(crate) fn run(args: &Args) -> Result<u8, CliError> {
    let which = if args.all { ExportColumns::All } else { ExportColumns::Plain };
    let columns = sweep::columns(which, &[]);
    let text = if args.json {
        format!("{:#}\n", columns.iter().map(as_json).collect::<Value>())
    } else {
        let cells: Vec<[String; 3]> = columns.iter().map(cells).collect();
        aligned::lines(0, &cells, terminal_width())
    };
    print(&text)?;
    Ok(exit::SUCCESS)
}

fn as_json(column: &Column) -> Value {
    let unit = Some(&column.unit).filter(|unit| !unit.is_empty());
    json!({
        "name": column.name,
        "unit": unit,
        "meaning": column.meaning,
        "group": column.group.name(),
    })
}

fn cells(column: &Column) -> [String; 3] {
    let unit = if column.unit.is_empty() { String::new() } else { format!("[{}]", column.unit) };
    [column.name.to_string(), unit, column.meaning.to_string()]
}

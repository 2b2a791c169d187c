//! `tribosweep columns`: what the columns of the export and of other tables mean.

use super::error::CliError;
use super::output::{print, terminal_width};
use crate::exit;
use crate::inspect;
use crate::publish::table::{FileColumns, Head, listed};
use crate::report::{self, columns::ExportColumn};
use crate::sweep::{self, ExportColumns};
use serde_json::{Value, json};

/// Arguments of `columns`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The columns of `export --all`: every input and the whole record too.
    #[arg(long)]
    all: bool,
    /// The columns of the other tables, which are those of reports, histories and inspections.
    #[arg(long, conflicts_with = "all")]
    tables: bool,
    /// Print them as JSON.
    #[arg(long)]
    json: bool,
}

/// Prints the columns. The grid parameters of a study are further columns of its export and of its tables.
pub(crate) fn run(args: &Args) -> Result<u8, CliError> {
    let which = if args.all { ExportColumns::All } else { ExportColumns::Plain };
    let of_export = || sweep::columns(which, &[]);
    let text = match (args.tables, args.json) {
        (true, true) => format!("{:#}\n", json!(files().collect::<Vec<_>>())),
        (true, false) => files().map(|own| file_as_text(&own)).collect::<Vec<_>>().join("\n"),
        (false, true) => format!("{:#}\n", of_export().iter().map(as_json).collect::<Value>()),
        (false, false) => as_text(0, of_export().iter().map(|own| &own.column.head)),
    };
    print(&text)?;
    Ok(exit::SUCCESS)
}

/// What the other tables have.
fn files() -> impl Iterator<Item = FileColumns> {
    report::columns_of_files()
        .into_iter()
        .chain([sweep::columns_of_history()])
        .chain(inspect::columns_of_files())
}

fn as_json(own: &ExportColumn) -> Value {
    let mut column = json!(own.column.head);
    column["group"] = own.group.name().into();
    column
}

fn file_as_text(own: &FileColumns) -> String {
    format!("{}\n{}", own.files.join(", "), as_text(2, own.heads.iter()))
}

fn as_text<'a>(indent: usize, heads: impl Iterator<Item = &'a Head>) -> String {
    let cells = |head: &Head| {
        let unit = if head.unit.is_empty() { String::new() } else { format!("[{}]", head.unit) };
        [head.name.to_string(), unit, head.meaning.to_string()]
    };
    listed(indent, &heads.map(cells).collect::<Vec<_>>(), terminal_width())
}

//! One line per job, for other programs: CSV and JSON lines with the same fields.

use super::columns::{ExportColumn, of_parameters, plain, selected};
use super::parameters::is_further;
use super::row::JobRow;
use crate::publish::table::{Column, Format, Head, Table, TableWriter};
use serde_json::Value;
use std::borrow::Cow;
use std::io::{self, Write};

/// The name of a report's export without the ending.
const STEM: &str = "jobs";

/// All jobs, with the columns of the plain export.
pub fn table(rows: &[JobRow]) -> Table {
    Table::of(STEM, &columns_of(plain_of(rows)), rows)
}

/// Writes [`table`] row by row.
///
/// # Errors
/// Those of the writer.
pub fn write<W: Write>(rows: &[JobRow], format: Format, out: W) -> io::Result<()> {
    let mut export = Export::new(format, plain_of(rows), out)?;
    rows.iter().try_for_each(|row| export.write(row))?;
    export.finish()
}

fn plain_of(rows: &[JobRow]) -> Vec<ExportColumn> {
    plain(&further_names(rows).into_iter().map(str::to_owned).collect::<Vec<_>>())
}

fn columns_of(columns: impl IntoIterator<Item = ExportColumn>) -> Vec<Column<JobRow>> {
    columns.into_iter().map(ExportColumn::into_column).collect()
}

/// An export that is written row by row, so that the rows of a large study need not be in memory all at once.
pub struct Export<W: Write> {
    columns: Vec<Column<JobRow>>,
    lines: TableWriter<W>,
}

impl<W: Write> Export<W> {
    /// An export with these columns; CSV gets its header.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn new(format: Format, columns: Vec<ExportColumn>, out: W) -> io::Result<Self> {
        let columns = columns_of(columns);
        let heads: Vec<Head> = columns.iter().map(|column| column.head.clone()).collect();
        Ok(Self { columns, lines: TableWriter::new(format, &heads, out)? })
    }

    /// Writes a job.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(&mut self, row: &JobRow) -> io::Result<()> {
        self.lines.line(self.columns.iter().map(|column| column.value(row)))
    }

    /// Writes what is still buffered.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn finish(self) -> io::Result<()> {
        self.lines.finish()?.flush()
    }
}

/// The data behind a figure: for each of the rows its key, ω, μ, the given `columns` of the export, the status,
/// and the further parameters that vary.
pub(super) fn selection<'a>(
    stem: impl Into<Cow<'static, str>>,
    rows: impl IntoIterator<Item = &'a JobRow>,
    further: &[&str],
    columns: &[&'static ExportColumn],
) -> Table {
    let selected = selected(columns).cloned().chain(of_parameters(further.iter().copied()));
    Table::of(stem, &columns_of(selected), rows)
}

/// Names of the parameters other than ω and μ, in the order in which they first appear.
pub(super) fn further_names<'a>(rows: impl IntoIterator<Item = &'a JobRow>) -> Vec<&'a str> {
    let mut names = Vec::new();
    for row in rows {
        add_further_names(&mut names, &row.parameters);
    }
    names
}

/// Adds to `names` the parameters of a job other than ω and μ, each name once.
pub fn add_further_names<'a, N>(names: &mut Vec<N>, parameters: &'a [(String, Value)])
where
    N: AsRef<str> + From<&'a str>,
{
    for (name, _) in parameters.iter().filter(|(name, _)| is_further(name)) {
        if !names.iter().any(|known| known.as_ref() == name) {
            names.push(N::from(name));
        }
    }
}

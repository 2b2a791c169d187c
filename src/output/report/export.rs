//! One line per job, for other programs: CSV and JSON lines with the same fields.

use super::columns::{ExportColumn, of_parameters, plain, selected};
use super::parameters::parameter_names;
use super::row::JobRow;
use crate::publish::table::{Column, Format, Head, Table, TableWriter};
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
    plain(&parameter_names(rows.iter().map(|row| &row.parameters)))
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
/// and the other `parameters`.
pub(super) fn selection<'a>(
    stem: impl Into<Cow<'static, str>>,
    rows: impl IntoIterator<Item = &'a JobRow>,
    parameters: &[&str],
    columns: &[&'static ExportColumn],
) -> Table {
    let selected = selected(columns).cloned().chain(of_parameters(parameters));
    Table::of(stem, &columns_of(selected), rows)
}

//! One line per job, for other programs: CSV and JSON lines with the same fields.

use super::columns::{Column, plain};
use super::parameters::is_further;
use super::row::JobRow;
use crate::publish::value;
use serde::Serializer;
use serde::ser::SerializeMap;
use serde_json::Value;
use std::io::{self, Write};

/// Writes one CSV line per job below a header. A cell without a value is empty.
///
/// # Errors
/// Those of the writer.
pub fn csv<W: Write>(rows: &[JobRow], out: W) -> io::Result<()> {
    let mut export = Export::csv(plain(&owned(further_names(rows))), out)?;
    rows.iter().try_for_each(|row| export.write(row, &[]))?;
    export.finish()
}

/// Writes one JSON object per job and line, with the fields of [`csv()`]. Empty cells of the CSV are null.
///
/// # Errors
/// Those of the writer.
pub fn json_lines<W: Write>(rows: &[JobRow], out: W) -> io::Result<()> {
    let mut export = Export::json_lines(plain(&owned(further_names(rows))), out);
    rows.iter().try_for_each(|row| export.write(row, &[]))?;
    export.finish()
}

/// An export that is written row by row, so that the rows of a large study need not be in memory all at once.
pub struct Export<W: Write> {
    columns: Vec<Column>,
    lines: Lines<W>,
}

enum Lines<W: Write> {
    Csv(Box<::csv::Writer<W>>),
    Json(W),
}

impl<W: Write> Export<W> {
    /// CSV with these columns; writes the header.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn csv(columns: Vec<Column>, out: W) -> io::Result<Self> {
        let mut writer = ::csv::Writer::from_writer(out);
        writer.write_record(columns.iter().map(|column| column.name.as_bytes())).map_err(io_error)?;
        Ok(Self { columns, lines: Lines::Csv(Box::new(writer)) })
    }

    /// JSON lines with these columns.
    pub fn json_lines(columns: Vec<Column>, out: W) -> Self {
        Self { columns, lines: Lines::Json(out) }
    }

    /// Writes a job. `inputs` are the values of the columns' inputs, and may be empty if the columns have none.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(&mut self, row: &JobRow, inputs: &[Value]) -> io::Result<()> {
        let columns = &self.columns;
        match &mut self.lines {
            Lines::Csv(writer) => {
                let cells = columns.iter().map(|column| value::text(&column.value(row, inputs)));
                writer.write_record(cells).map_err(io_error)
            }
            Lines::Json(out) => {
                let mut line = serde_json::Serializer::new(&mut *out);
                let mut map = line.serialize_map(Some(columns.len()))?;
                for column in columns {
                    map.serialize_entry(&column.name, &column.value(row, inputs))?;
                }
                map.end()?;
                out.write_all(b"\n")
            }
        }
    }

    /// Writes what is still buffered.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn finish(self) -> io::Result<()> {
        match self.lines {
            Lines::Csv(mut writer) => writer.flush(),
            Lines::Json(mut out) => out.flush(),
        }
    }
}

/// The data behind a figure as CSV: for each of the rows its key, ω, μ, the given `columns` of the export, the status,
/// and further parameters.
pub(super) fn selection<'a>(
    rows: impl IntoIterator<Item = &'a JobRow>,
    further: &[&str],
    columns: &[&str],
) -> io::Result<Vec<u8>> {
    let names = ["job", "omega_rpm", "mu"].iter().chain(columns).chain(&["status"]);
    let further: Vec<String> = further.iter().map(|&name| name.to_owned()).collect();
    let parameters = plain(&further).split_off(plain(&[]).len());
    let selected: Vec<Column> =
        names.filter_map(|name| Column::find(name)).cloned().chain(parameters).collect();
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    writer.write_record(selected.iter().map(|column| column.name.as_bytes())).map_err(io_error)?;
    for row in rows {
        let cells = selected.iter().map(|column| value::text(&column.value(row, &[])));
        writer.write_record(cells).map_err(io_error)?;
    }
    writer.into_inner().map_err(|error| io::Error::other(error.to_string()))
}

/// The I/O error behind a CSV error, so that a caller can recognise a closed pipe.
pub(super) fn io_error(error: ::csv::Error) -> io::Error {
    match error.into_kind() {
        ::csv::ErrorKind::Io(source) => source,
        other => io::Error::other(format!("{other:?}")),
    }
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
pub(crate) fn add_further_names<'a, N>(names: &mut Vec<N>, parameters: &'a [(String, Value)])
where
    N: AsRef<str> + From<&'a str>,
{
    for (name, _) in parameters.iter().filter(|(name, _)| is_further(name)) {
        if !names.iter().any(|known| known.as_ref() == name) {
            names.push(N::from(name));
        }
    }
}

fn owned(names: Vec<&str>) -> Vec<String> {
    names.into_iter().map(str::to_owned).collect()
}

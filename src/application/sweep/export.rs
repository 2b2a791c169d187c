//! One row per job, for other programs.

use super::error::SweepError;
use super::rows::{StoredParameters, for_each_row, for_each_row_with_inputs, for_each_stored};
use crate::publish::table::{Format, Head};
use crate::queue::{Queue, Rows};
use crate::report::columns::{self, ExportColumn};
use crate::report::export::Export;
use crate::report::{JobRow, Windows};
use crate::study::{Parameter, input_parameters};
use indexmap::IndexSet;
use std::io::Write;

/// The columns of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ExportColumns {
    /// The most important figures, and the grid parameters.
    #[default]
    Plain,
    /// These, every input and the whole record.
    All,
}

/// What an export could not read.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Unreadable {
    /// The jobs, with the reason, in words. The first few are enough to see what it is.
    pub jobs: Vec<String>,
    /// Their number.
    pub count: u64,
}

/// Jobs that [`Unreadable`] lists.
const MOST_LISTED: usize = 10;

impl Unreadable {
    /// Notes a row if it cannot be read.
    pub fn note(&mut self, row: &JobRow) {
        let Some(reason) = row.unreadable() else { return };
        self.count += 1;
        if self.jobs.len() < MOST_LISTED {
            self.jobs.push(format!("job {} of {}: {reason}", row.job, row.study));
        }
    }
}

/// Writes one row per window of the jobs whose speed or load changes in time to `out`, study after study, as CSV.
///
/// # Errors
/// As [`export`].
pub async fn export_windows(
    queue: &mut Queue,
    studies: &[String],
    out: &mut dyn Write,
) -> Result<Unreadable, SweepError> {
    let mut unreadable = Unreadable::default();
    let grid = grid_names(queue, studies).await?;
    let mut windows = Windows::new(&grid, out).map_err(SweepError::Output)?;
    for study in studies {
        for_each_row(queue, study, Rows::All, |_, row| {
            unreadable.note(&row);
            windows.write(&row).map_err(SweepError::Output)
        })
        .await?;
    }
    windows.finish().map_err(SweepError::Output)?;
    Ok(unreadable)
}

/// The columns of an export of studies with these `grid` parameters.
pub fn columns(which: ExportColumns, grid: &[String]) -> Vec<ExportColumn> {
    match which {
        ExportColumns::Plain => columns::plain(grid),
        ExportColumns::All => {
            // A parameter that sets an input in another way has no column of its own: the input has the value.
            let is_input = |name: &str| Parameter::find(name).is_some_and(|own| own.part().is_some());
            let grid: Vec<String> = grid.iter().filter(|name| !is_input(name)).cloned().collect();
            columns::all(&input_columns(), &grid)
        }
    }
}

fn input_columns() -> Vec<Head> {
    let head = |parameter: &Parameter| Head::new(parameter.column(), parameter.unit, parameter.meaning);
    input_parameters().map(head).collect()
}

/// The grid parameters of the studies.
async fn grid_names(queue: &mut Queue, studies: &[String]) -> Result<Vec<String>, SweepError> {
    let mut names = IndexSet::new();
    for study in studies {
        // Parameters that cannot be read are an error when their row is converted.
        let own =
            |stored: serde_json::Result<StoredParameters>| stored.map_or_else(|_| Vec::new(), |own| own.grid);
        for_each_stored(queue, study, |stored| names.extend(own(stored).into_iter().map(|(name, _)| name)))
            .await?;
    }
    Ok(names.into_iter().collect())
}

/// Writes one row per job of the studies to `out`, study after study. Each study is read twice, first for the names of its
/// parameters, so that its rows need not be held in memory. A grid parameter of any study is a column of all of them. Jobs whose
/// stored result cannot be read have rows without figures; they are returned.
///
/// # Errors
/// If the database does not have one of the studies or cannot be read, and [`SweepError::Output`] if `out` fails. An unknown
/// study is noticed before anything is written.
pub async fn export(
    queue: &mut Queue,
    studies: &[String],
    which: ExportColumns,
    format: Format,
    out: &mut dyn Write,
) -> Result<Unreadable, SweepError> {
    let mut unreadable = Unreadable::default();
    let grid = grid_names(queue, studies).await?;
    let mut export = Export::new(format, columns(which, &grid), out).map_err(SweepError::Output)?;
    let mut write = |row: JobRow| {
        unreadable.note(&row);
        export.write(&row).map_err(SweepError::Output)
    };
    for study in studies {
        match which {
            ExportColumns::Plain => for_each_row(queue, study, Rows::All, |_, row| write(row)).await?,
            ExportColumns::All => for_each_row_with_inputs(queue, study, &mut write).await?,
        }
    }
    export.finish().map_err(SweepError::Output)?;
    Ok(unreadable)
}

//! From the queue's rows to the report's rows.

use super::error::SweepError;
use crate::queue::{JobState, Queue, Rows, StudyRow};
use crate::report::{JobNumerics, JobRow, RowState, export};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// The parameters of a job that are stored with its row, so that tables need not read the payload.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct RowParameters {
    /// Disk speed ω of the job in revolutions per minute.
    pub omega_rpm: f64,
    /// Local friction coefficient μ of the job.
    pub mu: f64,
    /// The grid parameters, in the study's order.
    pub grid: Vec<(String, serde_json::Value)>,
    /// What accuracy and cost depend on; absent in databases of versions that did not store it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub numerics: Option<JobNumerics>,
}

/// Reads all rows of a study, in the order of the grid.
///
/// # Errors
/// If the database has no such study or cannot be read.
pub async fn read_rows(queue: &mut Queue, study: &str) -> Result<Vec<JobRow>, SweepError> {
    let mut rows = Vec::new();
    for_each_row(queue, study, Rows::All, |_, row| {
        rows.push(row);
        Ok(())
    })
    .await?;
    Ok(rows)
}

/// Calls `visit` with the ordinal and the content of each of `which` rows of a study, up to the first error. The records
/// of a whole study as text would take several times the memory of the rows, so this never holds more than a page of
/// them.
///
/// # Errors
/// As [`read_rows`], and those of `visit`.
pub async fn for_each_row(
    queue: &mut Queue,
    study: &str,
    which: Rows<'_>,
    mut visit: impl FnMut(u64, JobRow) -> Result<(), SweepError>,
) -> Result<(), SweepError> {
    let mut visited = Ok(());
    let read = queue.each_page(study, which, |page| {
        let rows: Vec<_> = page.par_iter().map(|row| (row.ordinal, report_row(study, row))).collect();
        visited = rows.into_iter().try_for_each(|(ordinal, row)| visit(ordinal, row?));
        if visited.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    read.await?;
    visited
}

/// The names of a study's parameters other than ω and μ, in the order in which they first appear.
pub(super) async fn further_names(queue: &mut Queue, study: &str) -> Result<Vec<String>, SweepError> {
    let mut names = Vec::new();
    // Parameters that cannot be read are an error when their row is converted.
    let read = queue.each_parameters(study, |parameters| {
        if let Ok(RowParameters { grid, .. }) = serde_json::from_str(parameters) {
            export::add_further_names(&mut names, &grid);
        }
    });
    read.await?;
    Ok(names)
}

fn report_row(study: &str, row: &StudyRow) -> Result<JobRow, SweepError> {
    let unreadable = |what, reason| SweepError::Unreadable {
        subject: format!("job {} of {study}", row.key),
        what,
        reason,
    };
    let parameters: RowParameters =
        serde_json::from_str(&row.parameters).map_err(|reason| unreadable("parameters", reason))?;
    let state = match (row.state, &row.record) {
        (JobState::Pending, _) => RowState::Pending,
        (JobState::Running, _) => RowState::Running,
        (JobState::Done, Some(record)) => {
            RowState::Done(serde_json::from_str(record).map_err(|reason| unreadable("record", reason))?)
        }
        (JobState::Done, None) => RowState::Failed { error: "the record is missing".to_owned() },
        (JobState::Cancelled, _) => RowState::Cancelled,
        (JobState::Failed, _) => RowState::Failed { error: row.error.clone().unwrap_or_default() },
    };
    Ok(JobRow {
        study: study.to_owned(),
        job: row.key.clone(),
        parameters: parameters.grid,
        omega_rpm: parameters.omega_rpm,
        mu: parameters.mu,
        state,
        wall_s: row.wall_s,
        numerics: parameters.numerics,
    })
}

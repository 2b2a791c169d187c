//! From the queue's rows to the report's.

use super::error::CliError;
use super::planning::RowParameters;
use crate::queue::{Clock, JobState, Location, Queue, Rows, Settings, StudyRow};
use crate::report::{JobRow, RowState, export};
use crate::study::Study;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use std::ops::ControlFlow;
use std::path::Path;

/// The name of a study given as its name or as its file.
pub fn study_name(study: &str) -> Result<String, CliError> {
    let path = Path::new(study);
    if path.extension().is_some_and(|extension| extension == "json") {
        return Ok(Study::load(path)?.name().to_owned());
    }
    Ok(study.to_owned())
}

/// Opens an existing database to read from it.
pub async fn open(db: &Location) -> Result<Queue, CliError> {
    Ok(Queue::open_to_read(db.clone(), Clock::OfDatabase).await?)
}

/// Opens an existing database to change it.
pub async fn open_to_change(db: &Location) -> Result<Queue, CliError> {
    Ok(Queue::open_existing(db.clone(), Clock::OfDatabase, Settings::default()).await?)
}

/// All rows of a study.
pub async fn read(queue: &mut Queue, study: &str) -> Result<Vec<JobRow>, CliError> {
    let mut rows = Vec::new();
    each(queue, study, Rows::All, |_, row| {
        rows.push(row);
        Ok(())
    })
    .await?;
    Ok(rows)
}

/// Shows rows of a study to `look`, up to the first error: as text, the records of all would take several times the
/// memory of what is read from them.
pub async fn each(
    queue: &mut Queue,
    study: &str,
    which: Rows<'_>,
    mut look: impl FnMut(u64, JobRow) -> Result<(), CliError>,
) -> Result<(), CliError> {
    let mut shown = Ok(());
    let read = queue.each_page(study, which, |page| {
        let rows: Vec<_> = page.par_iter().map(|row| (row.ordinal, convert(study, row))).collect();
        shown = rows.into_iter().try_for_each(|(ordinal, row)| look(ordinal, row?));
        if shown.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    read.await?;
    shown
}

/// The names of a study's parameters other than ω and μ, in the order in which they first appear.
pub async fn further_names(queue: &mut Queue, study: &str) -> Result<Vec<String>, CliError> {
    let mut names = Vec::new();
    // Those that cannot be read are complained about with their rows.
    let read = queue.each_parameters(study, |parameters| {
        if let Ok(RowParameters { grid, .. }) = serde_json::from_str(parameters) {
            export::add_further_names(&mut names, &grid);
        }
    });
    read.await?;
    Ok(names)
}

/// What the report makes of a row.
pub fn convert(study: &str, row: &StudyRow) -> Result<JobRow, CliError> {
    let unreadable = |what: &str, error: serde_json::Error| {
        CliError::Unreadable(format!(
            "job {} of {study}: its {what} was written by another version of tribosweep ({error}); \
             submit the study to a new database",
            row.key
        ))
    };
    let parameters: RowParameters =
        serde_json::from_str(&row.parameters).map_err(|error| unreadable("parameters", error))?;
    let state = match (row.state, &row.record) {
        (JobState::Pending, _) => RowState::Pending,
        (JobState::Running, _) => RowState::Running,
        (JobState::Done, Some(record)) => {
            RowState::Done(serde_json::from_str(record).map_err(|error| unreadable("record", error))?)
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

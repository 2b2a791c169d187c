//! From the queue's rows to the report's rows.

use super::error::SweepError;
use crate::analysis::JobRecord;
use crate::queue::{Integrity, JobState, Pages, Queue, Rows, StudyRow};
use crate::report::{JobNumerics, JobRow, Parameters, RowState};
use crate::spec::JobSpec;
use crate::study::{Job, Parameter, input_parameters, inputs};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// What is stored with the row of a job, so that tables need not read the payload.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct StoredParameters {
    /// Disk speed ω of the job in revolutions per minute, whether or not the grid has it.
    pub omega_rpm: f64,
    /// Local friction coefficient μ of the job, whether or not the grid has it.
    pub mu: f64,
    /// The grid parameters, in the study's order.
    pub grid: Vec<(String, Value)>,
    /// What accuracy and cost depend on.
    pub numerics: JobNumerics,
    /// The wave in which the job was added; absent for jobs of the study's author.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wave: Option<u64>,
    /// Why it was added.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

impl StoredParameters {
    /// Reads those of a job, which `subject` names in an error.
    pub fn read(text: &str, subject: impl FnOnce() -> String) -> Result<Self, SweepError> {
        let unreadable = |reason| SweepError::Unreadable { subject: subject(), what: "parameters", reason };
        serde_json::from_str(text).map_err(unreadable)
    }

    /// β_R \[s\] of a row, if this version can read its parameters.
    pub fn beta_r_s(text: &str) -> Option<f64> {
        serde_json::from_str::<Self>(text).ok().map(|own| own.numerics.beta_r_s)
    }

    /// As they are everywhere but in the database.
    pub fn into_parameters(self) -> Parameters {
        Parameters::new(self.omega_rpm, self.mu, self.grid)
    }
}

/// The parameters of a job that may not be stored yet.
pub fn parameters_of(job: &Job) -> Parameters {
    let scene = &job.spec.scene;
    Parameters::new(scene.disk.omega_rpm, scene.contact.mu, job.parameters.clone())
}

/// Calls `visit` with what `read` makes of each row of some pages, in their order, up to the first error. A page is read on all threads.
/// The records of a whole study as text would take several times the memory of the rows, so this never holds more than a page of them.
async fn visit_pages<R: Sync, T: Send>(
    queue: &mut Queue,
    mut pages: Pages<R>,
    read: impl Fn(&R) -> Result<T, SweepError> + Sync,
    mut visit: impl FnMut(T) -> Result<(), SweepError>,
) -> Result<(), SweepError> {
    while let Some(page) = queue.next_page(&mut pages).await? {
        let read: Vec<_> = page.par_iter().map(&read).collect();
        read.into_iter().try_for_each(|row| row.and_then(&mut visit))?;
    }
    Ok(())
}

/// Reads all rows of a study, in the order of the grid.
///
/// # Errors
/// If the database has no such study or cannot be read.
pub async fn read_rows(queue: &mut Queue, study: &str) -> Result<Vec<JobRow>, SweepError> {
    let mut rows = Vec::new();
    let read = |row: &StudyRow| {
        // A specification of another version that this one cannot read has no known law.
        let has_one_mu = spec_of_row(row).is_ok_and(|spec| spec.scene.contact.law.has_one_mu());
        Ok(JobRow { has_one_mu, ..report_row(study, row)? })
    };
    let pages = queue.pages_with_payloads(study).await?;
    visit_pages(queue, pages, read, |row| {
        rows.push(row);
        Ok(())
    })
    .await?;
    Ok(rows)
}

/// Calls `visit` with the specification of the job of each row of a study, as it was stored when the job was submitted.
/// Specifications of other versions that this one cannot read are left out.
pub(super) async fn for_each_spec(
    queue: &mut Queue,
    study: &str,
    mut visit: impl FnMut(&JobSpec),
) -> Result<(), SweepError> {
    let pages = queue.pages_with_payloads(study).await?;
    visit_pages(
        queue,
        pages,
        |row| Ok(spec_of_row(row).ok()),
        |spec| {
            spec.iter().for_each(&mut visit);
            Ok(())
        },
    )
    .await
}

/// Calls `visit` with the ordinal and the content of each of `which` rows of a study, up to the first error.
///
/// # Errors
/// As [`read_rows`], and those of `visit`.
pub async fn for_each_row(
    queue: &mut Queue,
    study: &str,
    which: Rows<'_>,
    mut visit: impl FnMut(u64, JobRow) -> Result<(), SweepError>,
) -> Result<(), SweepError> {
    let pages = queue.pages_of_rows(study, which).await?;
    let read = |row: &StudyRow| Ok((row.ordinal, report_row(study, row)?));
    visit_pages(queue, pages, read, |(ordinal, row)| visit(ordinal, row)).await
}

/// As [`for_each_row`] for all rows, with the values of all [`inputs`](JobRow::inputs) of each job, in the order of
/// [`input_parameters`](crate::study::input_parameters). Inputs without an effect are null.
///
/// # Errors
/// As [`for_each_row`].
pub async fn for_each_row_with_inputs(
    queue: &mut Queue,
    study: &str,
    visit: impl FnMut(JobRow) -> Result<(), SweepError>,
) -> Result<(), SweepError> {
    let read = |row: &StudyRow| {
        let mut own = report_row(study, row)?;
        own.inputs = match spec_of_row(row) {
            Ok(spec) => input_values(&spec),
            // Without its inputs the row would be that of an unknown scene.
            Err(error) => {
                own.state = RowState::Unreadable { reason: error.to_string() };
                input_parameters().map(|_| Value::Null).collect()
            }
        };
        Ok(own)
    };
    let pages = queue.pages_with_payloads(study).await?;
    visit_pages(queue, pages, read, visit).await
}

/// Calls `visit` with what is stored as the parameters of each row of a study, or with why it cannot be read.
pub(super) async fn for_each_stored(
    queue: &mut Queue,
    study: &str,
    mut visit: impl FnMut(serde_json::Result<StoredParameters>),
) -> Result<(), SweepError> {
    let pages = queue.pages_of_parameters(study).await?;
    let read = |text: &String| Ok(serde_json::from_str(text));
    visit_pages(queue, pages, read, |stored| {
        visit(stored);
        Ok(())
    })
    .await
}

/// The job of a row that was read with its payload.
fn spec_of_row(row: &StudyRow) -> Result<JobSpec, SweepError> {
    job_spec(&row.key, row.payload.as_deref().unwrap_or_default())
}

/// The job that a payload of the database describes.
pub(super) fn job_spec(key: &str, payload: &str) -> Result<JobSpec, SweepError> {
    let unreadable =
        |reason| SweepError::Unreadable { subject: format!("job {key}"), what: "payload", reason };
    serde_json::from_str(payload).map_err(unreadable)
}

fn input_values(spec: &JobSpec) -> Vec<Value> {
    let inputs = inputs(spec);
    let value = |parameter: &Parameter| {
        let own = inputs.iter().find(|input| input.parameter == parameter);
        own.map_or(Value::Null, |input| input.value.clone())
    };
    input_parameters().map(value).collect()
}

/// A row of the queue as a row of a report, without what only the specification says. A result that cannot be read is a state of
/// the row.
pub(super) fn report_row(study: &str, row: &StudyRow) -> Result<JobRow, SweepError> {
    let mut stored = StoredParameters::read(&row.parameters, || format!("job {} of {study}", row.key))?;
    let state = row_state(row.state, row.record.as_deref(), row.error.as_deref(), row.integrity);
    Ok(JobRow {
        study: study.to_owned(),
        job: row.key.clone(),
        wave: stored.wave.unwrap_or(0),
        why: stored.why.take(),
        numerics: Some(stored.numerics.clone()),
        parameters: stored.into_parameters(),
        has_one_mu: false,
        state,
        wall_s: row.wall_s,
        inputs: Vec::new(),
    })
}

/// The state of a job with its record or its error. A result that was damaged is none: a figure with a wrong digit looks like
/// any other one.
pub(super) fn row_state(
    state: JobState,
    record: Option<&str>,
    error: Option<&str>,
    integrity: Integrity,
) -> RowState {
    let unreadable = |reason: String| RowState::Unreadable { reason };
    match (state, record) {
        (JobState::Pending, _) => RowState::Pending,
        (JobState::Running, _) => RowState::Running,
        (JobState::Cancelled, _) => RowState::Cancelled,
        (JobState::Done | JobState::Failed, _) if integrity == Integrity::Damaged => {
            unreadable("the stored result is damaged: it does not have its digest".to_owned())
        }
        (JobState::Done, Some(record)) => match read_record(record) {
            Ok(record) => RowState::Done(record),
            Err(reason) => unreadable(reason),
        },
        (JobState::Done, None) => unreadable("the stored result is missing".to_owned()),
        (JobState::Failed, _) => RowState::Failed { error: error.unwrap_or_default().to_owned() },
    }
}

/// The record that was stored as this text.
///
/// # Errors
/// Why it cannot be read, in words.
pub(super) fn read_record(text: &str) -> Result<Box<JobRecord>, String> {
    serde_json::from_str(text).map_err(|error| {
        format!("the stored result cannot be read: another version of tribosweep wrote it, or it is damaged ({error})")
    })
}

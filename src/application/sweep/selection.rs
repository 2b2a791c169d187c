//! One job of a study or of a database.

use super::database::{open_to_read, study_file, with_open};
use super::error::SweepError;
use super::rows::{StoredParameters, job_spec, row_state};
use crate::queue::{JobDetails, Location, Queue, StudyDocument};
use crate::report::{JobRow, Parameters, RowState};
use crate::solver;
use crate::spec::JobSpec;
use crate::study::{Job, Parameter, Preset, SingleJob, Study, job_key};
use serde_json::Value;

/// A job of a study, with the parameters that tell it from the others.
#[derive(Debug, Clone)]
pub struct SelectedJob {
    /// Its key.
    pub key: String,
    /// The job.
    pub spec: JobSpec,
    /// The parameters of the grid and those that were set, each once, with their values in this job.
    pub parameters: Vec<(String, Value)>,
    /// Names of the grid parameters that were not set: they have the values of the study's scene.
    pub from_scene: Vec<&'static str>,
}

/// How to name a job of a study.
const ADVICE: &str = "`tribosweep export` lists keys, or name the job by its parameters: omega_rpm=7 mu=0.4";

/// The job of a study whose key begins with `prefix`. `study` is what [`load_study`](super::load_study) has read for `given`,
/// a file or a name. A job of a study in the database is taken as it was submitted: another version may have expanded the same
/// document into other jobs.
///
/// # Errors
/// [`SweepError::NoSuchJob`] and [`SweepError::AmbiguousJob`]; if the database cannot be read.
pub async fn select_by_key(
    study: &Study,
    given: &str,
    database: &Location,
    prefix: &str,
) -> Result<SelectedJob, SweepError> {
    if study_file(given).is_some() {
        return expanded(study, prefix);
    }
    let (job, parameters) = with_open(open_to_read(database.clone()).await?, async |queue| {
        let job = only(queue.jobs_in(given, prefix, 2).await?, Some(given), prefix)?;
        let parameters = queue.parameters(given, &job.key).await?;
        Ok::<_, SweepError>((job, parameters))
    })
    .await?;
    let parameters = parameters.map_or_else(|| Ok(Vec::new()), |text| of_grid(&job.key, &text))?;
    let spec = job_spec(&job.key, &job.payload)?;
    Ok(SelectedJob { key: job.key, spec, parameters, from_scene: Vec::new() })
}

/// The job of a study in a file whose key begins with `prefix`.
fn expanded(study: &Study, prefix: &str) -> Result<SelectedJob, SweepError> {
    let jobs = study.expand(solver::VERSION)?;
    let mut found = jobs.into_iter().filter(|job| job.key.starts_with(prefix));
    match (found.next(), found.next()) {
        (Some(job), None) => Ok(SelectedJob::of_study(job)),
        (None, _) => Err(no_such_job(Some(study.name()), prefix)),
        (Some(one), Some(other)) => Err(ambiguous_job(Some(study.name()), prefix, [one.key, other.key])),
    }
}

fn no_such_job(study: Option<&str>, prefix: &str) -> SweepError {
    SweepError::NoSuchJob {
        study: study.map(str::to_owned),
        prefix: prefix.to_owned(),
        advice: if study.is_some() { ADVICE } else { "`tribosweep export` lists keys" },
    }
}

fn ambiguous_job(study: Option<&str>, prefix: &str, keys: [String; 2]) -> SweepError {
    SweepError::AmbiguousJob { study: study.map(str::to_owned), prefix: prefix.to_owned(), keys }
}

/// The job that is meant by `prefix`, of at least the first two `found` jobs of a study or of the database.
fn only(found: Vec<JobDetails>, study: Option<&str>, prefix: &str) -> Result<JobDetails, SweepError> {
    let mut found = found.into_iter();
    match (found.next(), found.next()) {
        (Some(job), None) => Ok(job),
        // A whole key may be the beginning of another one. Keys are sorted, so it comes first.
        (Some(job), Some(_)) if job.key == prefix => Ok(job),
        (None, _) => Err(no_such_job(study, prefix)),
        (Some(one), Some(other)) => Err(ambiguous_job(study, prefix, [one.key, other.key])),
    }
}

/// The job of a study with these `settings` (name, value) of parameters. Grid parameters without a setting have the value
/// of the study's scene. Messages call the settings `source_name`.
///
/// # Errors
/// As [`Study::single_on_base`].
pub fn select_by_parameters(
    study: &Study,
    source_name: &str,
    preset: Option<Preset>,
    settings: &[(String, String)],
) -> Result<SelectedJob, SweepError> {
    let SingleJob { spec, parameters, left_open } = study.single_on_base(source_name, preset, settings)?;
    let key = job_key(&spec, solver::VERSION);
    Ok(SelectedJob { key, parameters, spec, from_scene: left_open })
}

/// The jobs of a study that have these `settings` (name, value) of parameters, in the order of the study. Messages call the
/// settings `source_name`.
///
/// # Errors
/// As [`select_by_parameters`].
pub fn select_all(
    study: &Study,
    source_name: &str,
    settings: &[(String, String)],
) -> Result<Vec<SelectedJob>, SweepError> {
    // It has the values of the settings, read and checked as for a single job.
    let wanted = study.single_on_base(source_name, None, settings)?.parameters;
    let names = || settings.iter().map(|(name, _)| name.as_str());
    let mut selected = Vec::new();
    for job in study.expand(solver::VERSION)? {
        let own = values(&job.spec, names())?.into_iter().chain(job.parameters.clone());
        // A job has no preset and no damping: they are among the parameters of the grid alone.
        let own: Vec<(String, Value)> = own.filter(|(_, value)| !value.is_null()).collect();
        let fits = |name: &str| {
            let in_list = |list: &[(String, Value)]| list.iter().find(|(known, _)| known == name).cloned();
            in_list(&own) == in_list(&wanted)
        };
        if names().all(fits) {
            selected.push(SelectedJob::of_study(job));
        }
    }
    Ok(selected)
}

impl SelectedJob {
    fn of_study(job: Job) -> Self {
        Self { key: job.key, spec: job.spec, parameters: job.parameters, from_scene: Vec::new() }
    }
}

/// The values of parameters in a job, each once.
pub(super) fn values<'a>(
    spec: &JobSpec,
    names: impl Iterator<Item = &'a str>,
) -> Result<Vec<(String, Value)>, SweepError> {
    let job = serde_json::to_value(spec).map_err(SweepError::Encode)?;
    let mut values: Vec<(String, Value)> = Vec::new();
    for name in names {
        if let Some(parameter) = Parameter::find(name)
            && !values.iter().any(|(known, _)| known == name)
        {
            let value = job.pointer(parameter.pointer).cloned().unwrap_or_default();
            values.push((name.to_owned(), value));
        }
    }
    Ok(values)
}

/// A job in a database.
#[derive(Debug, Clone)]
pub struct StoredJob {
    /// Its state and how its result was obtained.
    pub details: JobDetails,
    /// The studies that have the job.
    pub studies: Vec<StudyOfJob>,
}

/// A study that has a job.
#[derive(Debug, Clone)]
pub struct StudyOfJob {
    /// The study as it was submitted.
    pub study: StudyDocument,
    /// The grid parameters of the job in this study.
    pub parameters: Vec<(String, Value)>,
}

impl StoredJob {
    /// The job as it was submitted.
    ///
    /// # Errors
    /// [`SweepError::Unreadable`].
    pub fn spec(&self) -> Result<JobSpec, SweepError> {
        job_spec(&self.details.key, &self.details.payload)
    }

    /// The job as a row of a report, without parameters of a study.
    ///
    /// # Errors
    /// [`SweepError::Unreadable`].
    pub fn row(&self) -> Result<JobRow, SweepError> {
        let JobDetails { key, state, record, error, integrity, wall_s, .. } = &self.details;
        let state = row_state(*state, record.as_deref(), error.as_deref(), *integrity);
        Ok(JobRow {
            study: self.studies.first().map(|own| own.study.name.clone()).unwrap_or_default(),
            wall_s: *wall_s,
            ..row_of_job(key, &self.spec()?, state)
        })
    }
}

/// A job that is no part of a study, as a row of a report.
pub fn row_of_job(key: &str, spec: &JobSpec, state: RowState) -> JobRow {
    JobRow {
        study: String::new(),
        job: key.to_owned(),
        parameters: Parameters::new(spec.scene.disk.omega_rpm, spec.scene.contact.mu, Vec::new()),
        has_one_mu: spec.scene.contact.law.has_one_mu(),
        state,
        wall_s: None,
        numerics: None,
        wave: 0,
        why: None,
        inputs: Vec::new(),
    }
}

/// The grid parameters of a stored row.
fn of_grid(key: &str, text: &str) -> Result<Vec<(String, Value)>, SweepError> {
    Ok(StoredParameters::read(text, || format!("job {key}"))?.grid)
}

/// The job in a database whose key is `prefix` or begins with it.
///
/// # Errors
/// [`SweepError::NoSuchJob`] and [`SweepError::AmbiguousJob`]; if the database cannot be read.
pub async fn find_job(queue: &mut Queue, prefix: &str) -> Result<StoredJob, SweepError> {
    // Two jobs are enough to know that there are several.
    let details = only(queue.jobs(prefix, 2).await?, None, prefix)?;
    let mut studies = Vec::new();
    for name in &details.studies {
        // A study may have been removed in between.
        let (Some(study), Some(parameters)) =
            (queue.study(name).await?, queue.parameters(name, &details.key).await?)
        else {
            continue;
        };
        studies.push(StudyOfJob { study, parameters: of_grid(&details.key, &parameters)? });
    }
    Ok(StoredJob { details, studies })
}

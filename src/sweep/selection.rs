//! One job of a study or of a database.

use super::error::SweepError;
use crate::queue::{JobDetails, Queue, StudyDocument};
use crate::solver;
use crate::spec::JobSpec;
use crate::study::{Parameter, Preset, Study};
use serde_json::Value;

/// A job of a study, with the parameters that tell it from the others.
#[derive(Debug, Clone)]
pub struct SelectedJob {
    /// The job.
    pub spec: JobSpec,
    /// The parameters of the grid and those that were set, each once, with their values in this job.
    pub parameters: Vec<(String, Value)>,
    /// Names of the grid parameters that were not set: they have the values of the study's scene.
    pub from_scene: Vec<&'static str>,
}

/// The job of a study whose key begins with `prefix`.
///
/// # Errors
/// [`SweepError::NoSuchJob`] and [`SweepError::AmbiguousJob`].
pub fn select_by_key(study: &Study, prefix: &str) -> Result<SelectedJob, SweepError> {
    let jobs = study.expand(solver::VERSION)?;
    let mut found = jobs.into_iter().filter(|job| job.key.starts_with(prefix));
    match (found.next(), found.next()) {
        (Some(job), None) => {
            Ok(SelectedJob { spec: job.spec, parameters: job.parameters, from_scene: Vec::new() })
        }
        (None, _) => Err(SweepError::NoSuchJob {
            study: Some(study.name().to_owned()),
            prefix: prefix.to_owned(),
            advice: "`tribosweep export` lists keys, or name the job by its parameters: omega_rpm=7 mu=0.4",
        }),
        (Some(one), Some(other)) => Err(SweepError::AmbiguousJob {
            study: Some(study.name().to_owned()),
            prefix: prefix.to_owned(),
            keys: [one.key, other.key],
        }),
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
    let (spec, from_scene) = study.single_on_base(source_name, preset, settings)?;
    let in_grid = study.axes().map(|(parameter, _)| parameter.name);
    let names = in_grid.chain(settings.iter().map(|(name, _)| name.as_str()));
    Ok(SelectedJob { parameters: values(&spec, names)?, spec, from_scene })
}

/// The values of parameters in a job, each once.
fn values<'a>(
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
    pub studies: Vec<StudyDocument>,
}

/// The job in a database whose key is `prefix` or begins with it.
///
/// # Errors
/// [`SweepError::NoSuchJob`] and [`SweepError::AmbiguousJob`]; if the database cannot be read.
pub async fn find_job(queue: &mut Queue, prefix: &str) -> Result<StoredJob, SweepError> {
    // Two jobs are enough to know that there are several.
    let mut found = queue.jobs(prefix, 2).await?.into_iter();
    let details = match (found.next(), found.next()) {
        (Some(job), None) => job,
        // A whole key may be the beginning of another one. Keys are sorted, so it comes first.
        (Some(job), Some(_)) if job.key == prefix => job,
        (None, _) => {
            return Err(SweepError::NoSuchJob {
                study: None,
                prefix: prefix.to_owned(),
                advice: "`tribosweep export` lists keys",
            });
        }
        (Some(one), Some(other)) => {
            return Err(SweepError::AmbiguousJob {
                study: None,
                prefix: prefix.to_owned(),
                keys: [one.key, other.key],
            });
        }
    };
    let mut studies = Vec::new();
    for name in &details.studies {
        // A study may have been removed in between.
        studies.extend(queue.study(name).await?);
    }
    Ok(StoredJob { details, studies })
}

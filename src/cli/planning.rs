//! From a study file to jobs for the queue.

use super::error::CliError;
use crate::queue::{NewJob, NewStudy};
use crate::report::JobNumerics;
use crate::solver::{self, Model};
use crate::spec::{Detection, JobSpec, Numerics, RunControl};
use crate::study::{Job, SharedKeys, Study, StudyError};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;

/// A study that has been read, expanded and checked.
pub struct Plan {
    /// The study.
    pub study: Study,
    /// Its jobs.
    pub jobs: Vec<Job>,
    /// For each of them the name of what it can be run together with.
    batches: Vec<String>,
    document: String,
}

/// What a row of a study remembers of its job, so that tables need not read the payload.
#[derive(Debug, Serialize, Deserialize)]
pub struct RowParameters {
    /// Disk speed ω [rpm] of the job.
    pub omega_rpm: f64,
    /// Local friction coefficient μ of the job.
    pub mu: f64,
    /// The grid parameters, in the study's order.
    pub grid: Vec<(String, serde_json::Value)>,
    /// What accuracy and cost depend on; absent in databases of versions that did not store it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub numerics: Option<JobNumerics>,
}

impl Plan {
    /// Reads and checks a study file.
    pub fn load(path: &Path) -> Result<Self, CliError> {
        // Read once: what is stored is what was checked, also from a pipe or while the file is being edited.
        let source_name = path.display().to_string();
        let document = std::fs::read_to_string(path)
            .map_err(|reason| StudyError::Read { file: source_name.clone(), reason })?;
        let study = Study::parse(&document, &source_name)?;
        let jobs = study.expand(solver::VERSION)?;
        let batches: Vec<String> = jobs
            .par_iter()
            .map_init(|| SharedKeys::new(solver::VERSION), |keys, job| keys.key(job.spec.shared_part()))
            .collect();
        preflight(path, &jobs, &batches)?;
        Ok(Self { study, jobs, batches, document })
    }

    /// The study as the queue takes it.
    pub fn for_queue(&self, priority: Option<i64>) -> Result<NewStudy, CliError> {
        let jobs = self
            .jobs
            .par_iter()
            .zip(&self.batches)
            .map_init(
                || SharedKeys::new(""),
                |cases, (job, batch)| {
                    let row = RowParameters {
                        omega_rpm: job.spec.scene.disk.omega_rpm,
                        mu: job.spec.scene.contact.mu,
                        grid: job.parameters.clone(),
                        numerics: Some(numerics(&job.spec, cases)),
                    };
                    Ok(NewJob {
                        key: job.key.clone(),
                        payload: encode(&job.spec)?,
                        parameters: encode(&row)?,
                        cost: job.cost,
                        batch: batch.clone(),
                        priority,
                    })
                },
            )
            .collect::<Result<_, CliError>>()?;
        Ok(NewStudy { name: self.study.name().to_owned(), document: self.document.clone(), jobs })
    }
}

fn encode(what: &impl Serialize) -> Result<String, CliError> {
    serde_json::to_string(what).map_err(|error| CliError::Unreadable(error.to_string()))
}

fn numerics(spec: &JobSpec, cases: &mut SharedKeys) -> JobNumerics {
    let JobSpec { scene, numerics, run, detection } = spec;
    let elements = scene.pin.elements;
    let element_volume_m3: f64 = (0..3).map(|axis| scene.pin.size_m[axis] / elements[axis] as f64).product();
    let case = JobSpec {
        scene: scene.clone(),
        numerics: Numerics::default(),
        run: RunControl::default(),
        detection: Detection::default(),
    };
    JobNumerics {
        case: case_key(case, cases),
        elements,
        element_size_m: element_volume_m3.cbrt(),
        nodes: elements.iter().map(|&n| n as u64 + 1).product(),
        beta2: numerics.beta2,
        beta_r_s: numerics.beta_r_s,
        safety_factor: numerics.time_step_s.is_none().then_some(numerics.safety_factor),
        limit_s: run.limit_s,
        stop_early: run.stop_early,
        average_last_fraction: run.average_last_fraction,
        cycles: detection.cycles,
        tolerance: detection.tolerance,
        drift_tolerance: detection.drift_tolerance,
    }
}

/// The key that all jobs of a physical case share: that of the job with everything else at its default.
fn case_key(mut case: JobSpec, cases: &mut SharedKeys) -> String {
    case.scene.pin.elements = [1, 1, 1];
    cases.key(case)
}

/// Refuses a study with a job that the solver would refuse before its first step.
fn preflight(path: &Path, jobs: &[Job], batches: &[String]) -> Result<(), CliError> {
    let mut seen = BTreeSet::new();
    for (job, batch) in jobs.iter().zip(batches) {
        if !seen.insert(batch) {
            continue;
        }
        if let Err(error) = Model::preflight(&job.spec.scene, &job.spec.numerics) {
            let point: Vec<String> =
                job.parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
            let at = if point.is_empty() { String::new() } else { format!(" (at {})", point.join(", ")) };
            return Err(CliError::Plan(format!("{}: {error}{at}", path.display())));
        }
    }
    Ok(())
}

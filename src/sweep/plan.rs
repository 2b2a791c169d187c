//! From a study to jobs in the queue.

use super::error::SweepError;
use super::numerics::numerics;
use super::rows::RowParameters;
use crate::queue::{NewJob, NewStudy, Queue, Shard, Submitted};
use crate::solver::{self, Model};
use crate::study::{Job, SharedKeys, Study, StudyError};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::Path;

/// A study that has been read, expanded into jobs and checked: the solver accepts every job.
#[derive(Debug)]
pub struct Plan {
    study: Study,
    jobs: Vec<Job>,
    /// For each job the key of its batch: jobs of one batch can be run together.
    batches: Vec<String>,
    document: String,
}

impl Plan {
    /// Reads and checks a study file.
    ///
    /// # Errors
    /// If the file cannot be read, and those of [`Plan::parse`].
    pub fn load(path: &Path) -> Result<Self, SweepError> {
        // The file is read once: what is stored is what was checked, even if it is a pipe or edited meanwhile.
        let source_name = path.display().to_string();
        let document = std::fs::read_to_string(path)
            .map_err(|reason| StudyError::Read { file: source_name.clone(), reason })?;
        Self::parse(&document, &source_name)
    }

    /// Checks the text of a study file. Messages call the file `source_name`, and its stem is the study's name unless
    /// the text gives one.
    ///
    /// # Errors
    /// Those of [`Study::parse`], and [`SweepError::RefusedJob`].
    pub fn parse(text: &str, source_name: &str) -> Result<Self, SweepError> {
        let study = Study::parse(text, source_name)?;
        let jobs = study.expand(solver::VERSION)?;
        let batches: Vec<String> = jobs
            .par_iter()
            .map_init(|| SharedKeys::new(solver::VERSION), |keys, job| keys.key(job.spec.shared_part()))
            .collect();
        preflight(source_name, &jobs, &batches)?;
        Ok(Self { study, jobs, batches, document: text.to_owned() })
    }

    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// The study's name.
    pub fn name(&self) -> &str {
        self.study.name()
    }

    /// The jobs, in the order of the grid.
    pub fn jobs(&self) -> &[Job] {
        &self.jobs
    }

    /// Submits all jobs to the database. Jobs that it has already are not added again.
    ///
    /// # Errors
    /// If the database cannot be written.
    pub async fn submit(&self, queue: &mut Queue) -> Result<Submitted, SweepError> {
        self.submit_shard(queue, Shard::WHOLE, None).await
    }

    /// Submits the jobs of one shard. Jobs of a higher priority are run first; without a `priority` new jobs get 0, and
    /// jobs that exist keep theirs.
    ///
    /// # Errors
    /// As [`Plan::submit`].
    ///
    /// # Panics
    /// If the shard's index is not below the number of shards.
    pub async fn submit_shard(
        &self,
        queue: &mut Queue,
        shard: Shard,
        priority: Option<i64>,
    ) -> Result<Submitted, SweepError> {
        Ok(queue.submit_shard(&self.new_study(priority)?, shard).await?)
    }

    /// The study in the form that the queue takes.
    fn new_study(&self, priority: Option<i64>) -> Result<NewStudy, SweepError> {
        let jobs = self
            .jobs
            .par_iter()
            .zip(&self.batches)
            .map_init(
                || SharedKeys::new(""),
                |cases, (job, batch)| {
                    let parameters = RowParameters {
                        omega_rpm: job.spec.scene.disk.omega_rpm,
                        mu: job.spec.scene.contact.mu,
                        grid: job.parameters.clone(),
                        numerics: Some(numerics(&job.spec, cases)),
                    };
                    Ok(NewJob {
                        key: job.key.clone(),
                        payload: encode(&job.spec)?,
                        parameters: encode(&parameters)?,
                        cost: job.cost,
                        batch: batch.clone(),
                        priority,
                    })
                },
            )
            .collect::<Result<_, SweepError>>()?;
        Ok(NewStudy { name: self.name().to_owned(), document: self.document.clone(), jobs })
    }
}

fn encode(value: &impl Serialize) -> Result<String, SweepError> {
    serde_json::to_string(value).map_err(SweepError::Encode)
}

/// Refuses a study with a job that the solver would refuse before its first step. One job of each batch is enough: the
/// others have the same model.
fn preflight(source_name: &str, jobs: &[Job], batches: &[String]) -> Result<(), SweepError> {
    let mut seen = BTreeSet::new();
    for (job, batch) in jobs.iter().zip(batches) {
        if !seen.insert(batch) {
            continue;
        }
        Model::preflight(&job.spec.scene, &job.spec.numerics).map_err(|reason| {
            let point: Vec<String> =
                job.parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
            SweepError::RefusedJob {
                source_name: source_name.to_owned(),
                reason: Box::new(reason),
                point: point.join(", "),
            }
        })?;
    }
    Ok(())
}

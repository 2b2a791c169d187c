//! From a study to its jobs.

use super::definition::Study;
use super::error::StudyError;
use super::key::job_key;
use crate::spec::JobSpec;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;
use serde_json::Value;
use std::collections::HashSet;

/// One job of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Job {
    /// Identifies the result: jobs of the same key have the same result. See [`job_key`].
    pub key: String,
    /// Everything that determines the result.
    pub spec: JobSpec,
    /// The grid's parameters and their values in this job, in the grid's order.
    pub parameters: Vec<(String, Value)>,
}

impl Study {
    /// All jobs: the cartesian product of the axes in the order of the file, the **first axis
    /// slowest**, the values of an axis in their order.
    ///
    /// A study with `continue` has only the jobs here that continue no other one.
    ///
    /// Grid points that are the same job (a `whole_top` clamp at several widths) appear once, as the
    /// first of them. `solver_version` is a part of the keys, see [`job_key`].
    ///
    /// # Errors
    /// None for a study from [`Study::parse`], which has checked every job. The signature leaves room
    /// for studies that are too large to be checked in advance.
    pub fn expand(&self, solver_version: &str) -> Result<Vec<Job>, StudyError> {
        Ok(self.roots(self.points(solver_version)?, solver_version))
    }

    /// The jobs at the points of the study, also those that continue others in a study with `continue`.
    ///
    /// # Errors
    /// As [`Study::expand`].
    pub fn points(&self, solver_version: &str) -> Result<Vec<Job>, StudyError> {
        let job = |(point, spec): (usize, &JobSpec)| Job {
            key: job_key(spec, solver_version),
            parameters: self.grid.parameters_at(point),
            spec: spec.clone(),
        };
        let mut jobs: Vec<Job> = self.specs.par_iter().enumerate().map(job).collect();
        let mut seen = HashSet::new();
        jobs.retain(|job| seen.insert(job.key.clone()));
        Ok(jobs)
    }
}

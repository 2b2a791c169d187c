//! From a study to its jobs.

use super::error::StudyError;
use super::key::job_key;
use super::{Study, cost, json};
use crate::spec::JobSpec;
use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
use serde::Serialize;
use serde_json::Value;
use std::collections::HashSet;

/// A grid with more points than this is taken for a slip of the keyboard.
pub const MAX_JOBS: usize = 1_000_000;

/// One job of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Job {
    /// Names the result: the same key, the same result. See [`job_key`].
    pub key: String,
    /// Everything that determines the result.
    pub spec: JobSpec,
    /// The grid's parameters and their values in this job, in the grid's order.
    pub parameters: Vec<(String, Value)>,
    /// Rough cost in node-steps, to compare jobs and to estimate what remains.
    pub cost: f64,
}

impl Study {
    /// All jobs: the cartesian product of the axes in the order of the file, the **first axis
    /// slowest**, the values of an axis in their order.
    ///
    /// Grid points that are the same job (a `whole_top` clamp at several widths) appear once, as the
    /// first of them.
    ///
    /// # Errors
    /// None for a study from [`Study::parse`], which has checked every job; the signature leaves room
    /// for studies that are too large to be checked in advance.
    pub fn expand(&self, solver_version: &str) -> Result<Vec<Job>, StudyError> {
        let point = |(indices, spec): (Vec<usize>, JobSpec)| Job {
            key: job_key(&spec, solver_version),
            cost: cost::node_steps(&spec),
            parameters: self.parameters_at(&indices),
            spec,
        };
        let mut jobs: Vec<Job> = self.points().map(point).collect();
        let mut seen = HashSet::new();
        jobs.retain(|job| seen.insert(job.key.clone()));
        Ok(jobs)
    }

    /// Every grid point with the indices of its values, in the order of [`Study::expand`].
    pub(super) fn points(&self) -> impl IndexedParallelIterator<Item = (Vec<usize>, JobSpec)> {
        (0..self.grid_size()).into_par_iter().map_init(
            || json::encode(&self.base),
            |job, number| {
                let indices = self.indices_of(number);
                for (axis, &index) in self.axes.iter().zip(&indices) {
                    axis.parameter.set(job, &axis.values[index]);
                }
                (indices, json::checked_job(job))
            },
        )
    }

    /// The parameters and values of a grid point.
    pub(super) fn parameters_at(&self, indices: &[usize]) -> Vec<(String, Value)> {
        let pair = |(axis, &index): (&super::axis::Axis, &usize)| {
            (axis.parameter.name.to_owned(), axis.values[index].clone())
        };
        self.axes.iter().zip(indices).map(pair).collect()
    }

    /// Digits of `number` in the mixed base of the axes' lengths; the last axis is the lowest digit.
    fn indices_of(&self, mut number: usize) -> Vec<usize> {
        let mut indices = vec![0; self.axes.len()];
        for (index, axis) in indices.iter_mut().zip(&self.axes).rev() {
            *index = number % axis.values.len();
            number /= axis.values.len();
        }
        indices
    }
}

//! Why a job has no record.

use crate::solver::SolverError;
use crate::spec::Violations;
use crate::stability::StabilityError;
use thiserror::Error;

/// Largest number of steps of a run. It is a thousand times the steps of the reference scene's longest jobs.
const MAX_STEPS: f64 = 5.0e7;

/// Why a job has no record.
#[derive(Debug, Error)]
pub enum JobError {
    /// The specification is not physical.
    #[error(transparent)]
    Spec(#[from] Violations),
    /// The solver refused the scene or the run diverged.
    #[error(transparent)]
    Solver(#[from] SolverError),
    /// A job without a run has no eigenvalues.
    #[error(transparent)]
    Stability(#[from] StabilityError),
    /// The time step is too small for the length of the run.
    #[error(
        "run.limit_s = {limit_s:e} s takes {steps:.1e} steps of {time_step_s:.3e} s, more than the {MAX_STEPS:.0e} \
         that a run may have: look for an extreme material, damping or holder, or give a shorter limit or a longer step"
    )]
    TooManySteps {
        /// The run's time limit \[s\].
        limit_s: f64,
        /// The time step \[s\].
        time_step_s: f64,
        /// Their ratio.
        steps: f64,
    },
    /// The run ended, but a figure overflowed.
    #[error(
        "the run ended, but {figure} is not finite: look for extreme material, load or friction values in this job"
    )]
    NotFinite {
        /// Path of the figure in the record.
        figure: String,
    },
    /// The job continues another one, whose last motion is not there.
    #[error(
        "it continues the job {parent}, whose last motion is not in this database or is one of another mesh: continue jobs along \
         a parameter that keeps the mesh, and in the database in which that job was run"
    )]
    NoParentMotion {
        /// The key of the job that it continues.
        parent: String,
    },
    /// The observer asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// Number of steps of a run. Buffers have this size and loops this length, so it has an upper limit.
pub(super) fn step_count(limit_s: f64, time_step_s: f64) -> Result<u64, JobError> {
    let steps = (limit_s / time_step_s).ceil();
    // `<=` is false for NaN.
    if steps <= MAX_STEPS {
        Ok(steps as u64)
    } else {
        Err(JobError::TooManySteps { limit_s, time_step_s, steps })
    }
}

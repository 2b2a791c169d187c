//! Why a job has no record.

use crate::solver::SolverError;
use crate::spec::{JobSpec, Rise, Violations, short};
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
    Stability(StabilityError),
    /// The time step is too small for the length of the run.
    #[error(
        "run.limit_s = {limit_s} s takes {steps:.1e} steps of {time_step_s:.3e} s, more than the {MAX_STEPS:.0e} \
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
    /// Friction rises so steeply with the slip speed that the explicit step cannot follow it.
    #[error(
        "{field}: the friction coefficient rises by {} per m/s of slip, and a time step of {} s carries \
         at most {} under the mean pressure of this load; give a flatter curve, a smaller load or a smaller time step",
        short(*.slope_s_m), short(*.time_step_s), short(*.most_s_m)
    )]
    RiseTooSteep {
        /// The field of the rise.
        field: String,
        /// Its slope \[s/m\].
        slope_s_m: f64,
        /// The time step \[s\].
        time_step_s: f64,
        /// The steepest one that is allowed \[s/m\].
        most_s_m: f64,
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
    /// The observer, or who asked for the eigenvalues, wants to stop.
    #[error("interrupted")]
    Interrupted,
}

impl From<StabilityError> for JobError {
    fn from(error: StabilityError) -> Self {
        match error {
            StabilityError::Interrupted => Self::Interrupted,
            other => Self::Stability(other),
        }
    }
}

/// Largest share of a slip speed by which friction may change it in a step at a node with the mean normal force: μ′ N Δt over the node's
/// mass. The law takes the speed of the step before, so that a node with a share of 2 or more goes from stick to slip in every step,
/// and nodes where the pressure has a peak carry several times the mean force. Beyond this share μ\* depends on the time step
/// (docs/developers/design.md).
const LARGEST_SHARE: f64 = 0.5;

/// Checks the time step of a job: number of steps of its run.
///
/// # Errors
/// If there are too many, or if a step cannot follow the job's friction law.
pub(super) fn check_step(spec: &JobSpec, time_step_s: f64) -> Result<u64, JobError> {
    if let Some(rise) = spec.scene.contact.steepest_rise().filter(|_| spec.has_run()) {
        let pin = &spec.scene.pin;
        // A node at the base has half the mass of an element above its part of the base.
        let area_mass_kg_m2 = 0.5 * pin.density_kg_m3 * pin.element_edges_m()[2];
        let pressure_pa = spec.scene.load.force_n / pin.base_area_m2();
        let most_s_m = LARGEST_SHARE * area_mass_kg_m2 / (pressure_pa * time_step_s);
        if rise.slope_s_m > most_s_m {
            let Rise { field, slope_s_m } = rise;
            return Err(JobError::RiseTooSteep { field, slope_s_m, time_step_s, most_s_m });
        }
    }
    step_count(spec.limit_of_run_s(), time_step_s)
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

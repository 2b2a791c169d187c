//! One job from its specification to its record.

use super::lanes::{Lanes, Moment};
use super::record::JobRecord;
use crate::solver::{Drive, Model, SolverError};
use crate::spec::{JobSpec, Violations};
use crate::units::rad_per_s_from_rpm;
use std::ops::ControlFlow;
use std::sync::Arc;
use thiserror::Error;

/// Largest number of steps of a run: a thousand times those of the reference scene's longest jobs.
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
    /// The time step is out of all proportion to the run.
    #[error(
        "run.limit_s = {limit_s:e} s takes {steps:.1e} steps of {time_step_s:.3e} s, more than the {MAX_STEPS:.0e} \
         that a run may have: look for extreme material or damping values, or give a shorter limit"
    )]
    TooManySteps {
        /// The run's time limit [s].
        limit_s: f64,
        /// The time step [s].
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
    /// The observer asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// Looks on while a job runs.
pub trait JobObserver {
    /// Called after every step.
    fn step(&mut self, moment: &Moment<'_, 1>) {
        let _ = moment;
    }

    /// Called every few steps with the simulated time [s]; `Break` interrupts the job.
    fn progress(&mut self, simulated_s: f64) -> ControlFlow<()> {
        let _ = simulated_s;
        ControlFlow::Continue(())
    }
}

/// An observer that only lets the job run.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unobserved;

impl JobObserver for Unobserved {}

/// Solves one job.
///
/// # Errors
/// If the specification is not physical, the solver refuses it, it takes too many steps, the run
/// diverges or a figure overflows, or `observer` interrupts it.
pub fn solve(spec: &JobSpec, observer: &mut impl JobObserver) -> Result<JobRecord, JobError> {
    spec.check()?;
    let model = Model::from_scene(&spec.scene, &spec.numerics)?;
    let mut lanes = Lanes::<1>::new(Arc::new(model));
    lanes.begin(0, 0, spec.clone())?;
    loop {
        let ended = lanes.advance(&mut |moment| observer.step(moment));
        if let Some(ended) = ended.into_iter().next() {
            return ended.result;
        }
        let simulated_s = lanes.simulated().map(|(_, simulated_s)| simulated_s).fold(0.0, f64::max);
        if observer.progress(simulated_s).is_break() {
            return Err(JobError::Interrupted);
        }
    }
}

/// Steps of a run. Buffers are sized and loops end by this number, so it must be within reason.
pub(super) fn step_count(limit_s: f64, time_step_s: f64) -> Result<u64, JobError> {
    let steps = (limit_s / time_step_s).ceil();
    // `<=` is false for NaN.
    if steps <= MAX_STEPS {
        Ok(steps as u64)
    } else {
        Err(JobError::TooManySteps { limit_s, time_step_s, steps })
    }
}

/// What the job's lane is driven by.
pub fn drive(spec: &JobSpec) -> Drive {
    Drive {
        mu: spec.scene.contact.mu,
        rate: rad_per_s_from_rpm(spec.scene.disk.omega_rpm),
        force_n: spec.scene.load.force_n,
        ramp_s: spec.scene.load.ramp_s,
    }
}

//! One job from its specification to its record.

use super::lane::LaneAnalysis;
use super::record::JobRecord;
use super::sample::Sample;
use crate::solver::energy::EnergyLedger;
use crate::solver::{Drive, Model, SolverError, State, guard, step};
use crate::spec::{JobSpec, Violations};
use crate::units::rad_per_s_from_rpm;
use std::ops::ControlFlow;
use thiserror::Error;

/// Steps between two evaluations of the stored energies (and of the divergence guard).
///
/// An evaluation costs two products with K; at 16 that is an eighth of a run. The damping's work is
/// sampled as often: about four times per period of the fastest mode that damping leaves alive.
const AUDIT_INTERVAL: u64 = 16;

/// Why a job has no record.
#[derive(Debug, Error)]
pub enum JobError {
    /// The specification is not physical.
    #[error(transparent)]
    Spec(#[from] Violations),
    /// The solver refused the scene or the run diverged.
    #[error(transparent)]
    Solver(#[from] SolverError),
    /// The observer asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// Looks on while a job runs.
pub trait JobObserver {
    /// Called after every step.
    fn sample(&mut self, sample: &Sample) {
        let _ = sample;
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
/// If the specification is not physical, the solver refuses it, the run diverges, or `observer`
/// interrupts it.
pub fn solve(spec: &JobSpec, observer: &mut impl JobObserver) -> Result<JobRecord, JobError> {
    spec.check()?;
    let model = Model::from_scene(&spec.scene, &spec.numerics)?;
    let drives = [drive(spec)];
    let mut state = State::<1>::at_rest(&model);
    let mut ledger = EnergyLedger::new(&model, AUDIT_INTERVAL);
    let mut analysis = LaneAnalysis::new(&model, spec, 0);
    let steps = (spec.run.limit_s / model.time_step_s()).ceil() as u64;
    for n in 0..steps {
        ledger.before_step(&model, &state);
        step(&model, &drives, &mut state);
        ledger.after_step(&model, &drives, &state);
        let sample = analysis.push(&model, &drives[0], &state, ledger.energies(0));
        observer.sample(&sample);
        if ledger.audits(n) {
            guard::check(&model, &drives[0], &state, 0, ledger.energies(0))?;
            if observer.progress(sample.time_s).is_break() {
                return Err(JobError::Interrupted);
            }
            if spec.run.stop_early && analysis.is_settled() {
                break;
            }
        }
    }
    guard::check_finite(&model, &state, 0)?;
    Ok(analysis.record(&model, &state, ledger.energies(0)))
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

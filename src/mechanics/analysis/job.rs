//! One job from its specification to its record.

use super::batch::{Prepared, prepared};
use super::error::{JobError, check_step};
use super::lanes::{Moment, one_lane};
use super::record::JobRecord;
use super::stability::{Structures, Verdict, judge};
use crate::solver::Model;
use crate::spec::JobSpec;
use std::ops::ControlFlow;

/// Receives the steps and the progress of a running job.
pub trait JobObserver {
    /// Is called after every step.
    fn step(&mut self, moment: &Moment<'_>) {
        let _ = moment;
    }

    /// Whether the steps are wanted even if eigenvalues could spare the run.
    fn needs_run(&self) -> bool {
        false
    }

    /// Is called every few steps with the simulated time \[s\]. `Break` interrupts the job.
    fn progress(&mut self, simulated_s: f64) -> ControlFlow<()> {
        let _ = simulated_s;
        ControlFlow::Continue(())
    }
}

/// An observer that does nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unobserved;

impl JobObserver for Unobserved {}

/// Solves one job. If the eigenvalues of steady sliding decide it, there is no run on its own mesh, unless `observer` needs
/// it. `observer` receives no steps on a coarser mesh, only the progress.
///
/// # Errors
/// If the specification is not physical, the solver refuses it, the run takes too many steps or diverges, a
/// figure overflows, or `observer` interrupts the run.
pub fn solve(spec: &JobSpec, observer: &mut dyn JobObserver) -> Result<JobRecord, JobError> {
    spec.check()?;
    let model = Model::from_scene(&spec.scene, &spec.numerics)?;
    if let Some(parent) = spec.parent() {
        return Err(JobError::NoParentMotion { parent: parent.to_owned() });
    }
    let mut lanes = one_lane(model, spec.numerics.precision);
    check_step(spec, lanes.model().time_step_s())?;
    let structures = Structures::default();
    let beginning = match prepared(spec, &structures, &mut |spent_s| observer.progress(spent_s))? {
        Prepared::GoesOn(ready) => ready.beginning,
        Prepared::Reached(record) if observer.needs_run() => {
            return solve(&on_mesh_of(spec, &record), observer);
        }
        Prepared::Reached(record) => return Ok(*record),
    };
    let verdict = judge(spec, lanes.model(), &beginning, &structures)?;
    let stability = match if observer.needs_run() { verdict.with_run() } else { verdict } {
        Verdict::Decided(record) => return Ok(*record),
        Verdict::Undecided(stability) => stability,
    };
    lanes.begin_from(0, 0, spec.clone(), beginning)?;
    if let Some(stability) = stability {
        lanes.note(0, stability);
    }
    loop {
        let ended = lanes.advance(&mut |moment| observer.step(moment));
        if let Some(ended) = ended.into_iter().next() {
            return ended.result;
        }
        let simulated_s =
            lanes.simulated().into_iter().map(|(_, simulated_s)| simulated_s).fold(0.0, f64::max);
        if observer.progress(simulated_s).is_break() {
            return Err(JobError::Interrupted);
        }
    }
}

/// The job on the mesh on which its accuracy is reached, or else on its finest one, without asking for an accuracy: what an observer sees
/// of it.
///
/// # Errors
/// As [`solve`].
pub fn on_final_mesh(
    spec: &JobSpec,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<JobSpec, JobError> {
    if spec.accuracy.is_none() {
        return Ok(spec.clone());
    }
    Ok(match prepared(spec, &Structures::default(), progress)? {
        Prepared::GoesOn(_) => JobSpec { accuracy: None, ..spec.clone() },
        Prepared::Reached(record) => on_mesh_of(spec, &record),
    })
}

fn on_mesh_of(spec: &JobSpec, record: &JobRecord) -> JobSpec {
    let mut own = JobSpec { accuracy: None, ..spec.clone() };
    own.scene.pin.elements = record.elements.unwrap_or(own.scene.pin.elements);
    own
}

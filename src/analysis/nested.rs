//! A job that first runs on a coarser mesh, and starts on its own mesh from the limit cycle found there.
//!
//! The coarser run is a part of the job. Its specification follows from that of the job alone, and it starts in the same way
//! from a still coarser mesh. If it does not end in a limit cycle, the job starts from rest.

use super::outcome::Outcome;
use crate::solver::{Model, PinMotion};
use crate::spec::{JobSpec, Numerics, StabilityMethod};
use serde::{Deserialize, Serialize};

/// Time of a run on a coarser mesh over the time of a run on the job's mesh that simulates as long: an eighth of the nodes
/// and half of the steps.
pub(super) const COST: f64 = 1.0 / 16.0;

/// How the run on a coarser mesh ended, from which a job was to start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoarseStart {
    /// Elements of the coarser mesh in x, y and z.
    pub elements: [usize; 3],
    /// How its run ended; none if it failed. The job started from rest unless it was periodic.
    pub outcome: Option<Outcome>,
    /// Simulated time \[s\] of that run, which is not part of the job's simulated time.
    pub simulated_s: f64,
    /// Macroscopic friction coefficient μ* on the coarser mesh.
    pub mu_star: Option<f64>,
    /// Fundamental frequency \[Hz\] on the coarser mesh.
    pub frequency_hz: Option<f64>,
}

impl CoarseStart {
    /// Whether the job started from the limit cycle of the coarser mesh.
    pub fn is_used(&self) -> bool {
        self.outcome == Some(Outcome::Periodic)
    }

    /// Time \[s\] that the job could have simulated on its own mesh meanwhile, about.
    pub(super) fn spent_s(&self) -> f64 {
        COST * self.simulated_s
    }
}

/// What a job on its own mesh begins from.
#[derive(Debug, Clone, PartialEq)]
pub struct Beginning {
    /// The motion on the mesh of the job; none if it begins at rest.
    pub motion: Option<PinMotion>,
    /// The run on the coarser mesh; none if there was none.
    pub start: Option<CoarseStart>,
}

impl Beginning {
    /// At rest, without a coarser mesh.
    pub const REST: Self = Self { motion: None, start: None };
}

/// The job without the ramp of its load, if it begins in a motion under the whole load.
pub(super) fn under_way(mut spec: JobSpec, start: Option<&CoarseStart>) -> JobSpec {
    if start.is_some_and(CoarseStart::is_used) || spec.parent().is_some() {
        spec.scene.load.ramp_s = 0.0;
    }
    spec
}

/// The same job on the coarser mesh from which it starts; none if it starts from rest or has no run.
pub fn coarser(spec: &JobSpec) -> Option<JobSpec> {
    let elements = spec.coarser_elements()?;
    let mut coarse = spec.clone();
    coarse.scene.pin.elements = elements;
    if coarse.numerics.time_step_s.take().is_some() {
        coarse.numerics.safety_factor = Numerics::default().safety_factor;
    }
    coarse.run.stop_early = true;
    coarse.stability = StabilityMethod::Simulate;
    Model::check_clamp(&coarse.scene).is_ok().then_some(coarse)
}

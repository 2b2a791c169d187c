//! A job that first runs on a coarser mesh, and starts on its own mesh from the limit cycle found there.
//!
//! The coarser run is a part of the job. Its specification follows from that of the job alone, and it starts in the same way
//! from a still coarser mesh. If it does not end in a limit cycle, the job starts from rest.

use super::mode::ComplexMode;
use super::outcome::{Outcome, Regime};
use crate::solver::{Model, PinMotion};
use crate::spec::{JobSpec, Numerics, StabilityMethod, Start};
use serde::{Deserialize, Serialize};

/// Time of a run on a coarser mesh over the time of a run on the job's mesh that simulates as long: it has fewer nodes and fewer steps.
pub(super) fn cost(own: [usize; 3], coarser: [usize; 3]) -> f64 {
    let elements = |counts: [usize; 3]| counts.map(|n| n as f64).iter().product::<f64>();
    let share = elements(coarser) / elements(own);
    share * libm::cbrt(share)
}

/// How the run on a coarser mesh ended that came before the job's own.
///
/// No field is skipped where it is none: a checkpoint has the fields in their order and not by their names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoarseStart {
    /// Elements of the coarser mesh in x, y and z.
    pub elements: [usize; 3],
    /// How its run ended; none if it failed.
    pub outcome: Option<Outcome>,
    /// Whether the job started from rest in any case, because a motion on another mesh is not enough for it.
    #[serde(default)]
    pub only_compared: bool,
    /// Simulated time \[s\] of that run, which is not part of the job's simulated time.
    pub simulated_s: f64,
    /// The contact regime there; none if the run failed, and in records of earlier versions.
    #[serde(default)]
    pub regime: Option<Regime>,
    /// Whether the clamp on that mesh is as wide as on the job's own. Earlier versions did not keep it.
    #[serde(default)]
    pub same_clamp: Option<bool>,
    /// The modes there, if the job computes modes only.
    #[serde(default)]
    pub modes: Vec<ComplexMode>,
    /// Macroscopic friction coefficient μ* on the coarser mesh.
    pub mu_star: Option<f64>,
    /// Fundamental frequency \[Hz\] on the coarser mesh.
    pub frequency_hz: Option<f64>,
    /// The run on a still coarser mesh that came before, if there was one.
    #[serde(default)]
    pub start: Option<Box<CoarseStart>>,
}

impl CoarseStart {
    /// Whether the job started from the limit cycle of the coarser mesh.
    pub fn is_used(&self) -> bool {
        self.outcome == Some(Outcome::Periodic) && !self.only_compared
    }

    /// Time \[s\] that the job could have simulated on its own mesh meanwhile, about.
    pub(super) fn spent_s(&self, own: [usize; 3]) -> f64 {
        let before_s = self.start.as_ref().map_or(0.0, |start| start.spent_s(own));
        before_s + cost(own, self.elements) * self.simulated_s
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

/// The same job on a coarser mesh, which it runs on first; none if it has no run there.
pub fn coarser(spec: &JobSpec) -> Option<JobSpec> {
    let mut coarse = spec.clone();
    if coarse.numerics.time_step_s.take().is_some() {
        coarse.numerics.safety_factor = Numerics::default().safety_factor;
    }
    coarse.run.stop_early = true;
    coarse.continuation = None;
    let with = |elements| {
        let mut coarse = coarse.clone();
        coarse.scene.pin.elements = elements;
        let width_m = coarse.check().ok().and_then(|()| Model::clamp_width_on_mesh_m(&coarse.scene).ok())?;
        Some((coarse, width_m))
    };
    let mut found: Vec<_> = spec.coarser_elements().into_iter().filter_map(with).collect();
    let own_m = Model::clamp_width_on_mesh_m(&spec.scene).ok()?;
    let best = found.iter().position(|(_, width_m)| is_same_width(*width_m, own_m));
    // Where the clamp is another one, a run can start from the motion, but its difference says nothing of the mesh.
    let best = best.or((spec.accuracy.is_none() && !found.is_empty()).then_some(0))?;
    let mut coarse = found.swap_remove(best).0;
    let is_level = spec.accuracy.is_some() && spec.has_run();
    let is_start = spec.has_run() && spec.starts_in_motion();
    if !(is_level || is_start) {
        // Two meshes give an error.
        coarse.run.start = Start::Rest;
    }
    if !is_level {
        coarse.accuracy = None;
    }
    // The coarser run of a job that asks for an accuracy may be its last one. On the coarsest mesh it never is.
    if spec.has_run() && (!is_level || coarser(&coarse).is_none()) {
        coarse.stability = StabilityMethod::Simulate;
    }
    Some(coarse)
}

/// The job on the coarsest mesh on which it may end, because its error is small enough there; none if it asks for no accuracy or has one
/// mesh to end on.
pub fn earliest_end(spec: &JobSpec) -> Option<JobSpec> {
    spec.accuracy?;
    let coarse = coarser(spec)?;
    coarser(&coarse)?;
    Some(earliest_end(&coarse).unwrap_or(coarse))
}

/// The clamp on the mesh of a job and on the coarser one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClampWidths {
    /// Its width on the mesh of the job \[m\].
    pub own_m: f64,
    /// Its width on the coarser mesh \[m\]; `None` if no coarser mesh fits.
    pub coarser_m: Option<f64>,
}

impl ClampWidths {
    /// Those of a job; `None` if it does not run on a coarser mesh first.
    pub fn of(spec: &JobSpec) -> Option<Self> {
        if spec.coarser_elements().is_empty() {
            return None;
        }
        let width_m = |spec: &JobSpec| Model::clamp_width_on_mesh_m(&spec.scene).ok();
        Some(Self { own_m: width_m(spec)?, coarser_m: coarser(spec).and_then(|coarse| width_m(&coarse)) })
    }

    /// Whether they differ: then the two meshes say nothing of each other.
    pub fn differ(self) -> bool {
        self.coarser_m.is_none_or(|coarser_m| !is_same_width(coarser_m, self.own_m))
    }
}

/// Whether two widths of the clamp are the same but for rounding.
pub(super) fn is_same_width(a_m: f64, b_m: f64) -> bool {
    (a_m - b_m).abs() <= 1.0e-9 * b_m
}

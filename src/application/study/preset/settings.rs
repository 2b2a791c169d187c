//! The presets and the settings that they stand for.

use crate::spec::{
    Accuracy, Clamp, DiskKind, FEWEST_ACROSS, JobSpec, Pin, Precision, Shape, StabilityMethod, Start,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use strum::{EnumString, IntoStaticStr};

/// The accuracy of a study by one word. `tribosweep presets` prints settings and measured errors.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, EnumString, IntoStaticStr,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Preset {
    /// A quick look: regimes and trends.
    Draft,
    /// The settings of figure7.
    Standard,
    /// Two thirds of the element size of the standard, to check it by.
    Reference,
    /// The coarsest mesh whose own error of μ\* is within 2 %.
    TwoPercent,
    /// The coarsest mesh whose own error of μ\* is within 1 %.
    OnePercent,
}

/// Largest refinement, relative to the desired element count, to get a node row at the clamp's edge.
const MAX_REFINEMENT: usize = 4;

/// Elements of the finest mesh of a job that asks for an accuracy over those of a draft, in each direction.
const FINEST: usize = 4;

/// Largest number of element counts that are tried: a pin of absurd size must not make the search long.
const MAX_TRIED_COUNTS: usize = 10_000;

impl Preset {
    /// All presets, the cheapest first.
    pub const ALL: [Self; 5] =
        [Self::Draft, Self::Standard, Self::Reference, Self::TwoPercent, Self::OnePercent];

    /// The name in study files.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The preset called `name`.
    pub fn find(name: &str) -> Option<Self> {
        name.parse().ok()
    }

    /// The accuracy that it asks for; none if it has one mesh.
    pub fn accuracy(self) -> Option<Accuracy> {
        match self {
            Self::TwoPercent => Some(Accuracy { mu_star: 0.02 }),
            Self::OnePercent => Some(Accuracy { mu_star: 0.01 }),
            Self::Draft | Self::Standard | Self::Reference => None,
        }
    }

    /// Elements along the pin's shortest edge, on the finest mesh if it asks for an accuracy. The resulting element size is the target in
    /// all directions.
    ///
    /// It is a count and not a size in metres, because the problem scales with the pin.
    pub fn elements_along_shortest_edge(self) -> usize {
        match self {
            Self::Draft => 10,
            Self::Standard => 20,
            Self::Reference => 30,
            Self::TwoPercent | Self::OnePercent => FINEST * Self::Draft.elements_along_shortest_edge(),
        }
    }

    /// Time step as a fraction of the stability limit.
    pub fn safety_factor(self) -> f64 {
        if self == Self::Draft { 0.9 } else { 0.7 }
    }

    /// Tolerance of the periodic state, [`Detection::tolerance`](crate::spec::Detection::tolerance).
    pub fn tolerance(self) -> f64 {
        if self == Self::Draft { 0.03 } else { 0.01 }
    }

    /// Drift of the periodic state, [`Detection::drift_tolerance`](crate::spec::Detection::drift_tolerance).
    pub fn drift_tolerance(self) -> f64 {
        if self == Self::Draft { 0.003 } else { 0.001 }
    }

    /// Element counts for a pin under a clamp. A cylinder has rows of nodes at many distances, so its counts do not depend on the clamp.
    ///
    /// In the direction across the clamp's edge it is the smallest count, from the desired one up to four times as many,
    /// that has a node row at the edge. If there is none, it is the desired count, and the solver refuses the scene with
    /// the reason.
    ///
    /// The finest mesh of an accuracy, halved twice, is that of a draft. So all of its meshes have a node row at the clamp's edge.
    pub fn elements(self, pin: &Pin, clamp: &Clamp) -> [usize; 3] {
        if self.accuracy().is_some() {
            return Self::finest_elements(pin, clamp);
        }
        let shortest_m = pin.extent_m().iter().copied().fold(f64::INFINITY, f64::min);
        let size_m = shortest_m / self.elements_along_shortest_edge() as f64;
        // Halves are rounded up: 15 mm in 2 mm elements give 8. The scene's check refuses counts out of bounds.
        let mut elements = pin.extent_m().map(|edge_m| ((edge_m / size_m + 0.5) as usize).max(1));
        if pin.shape == Shape::Cylinder {
            let across = elements[0].max(FEWEST_ACROSS);
            elements = [across, across, elements[2]];
        }
        // Rows across a cylinder are at many distances.
        let has_rows = |axis: &usize| pin.shape != Shape::Cylinder || *axis == 2;
        if let Some(axis) = clamp.side.axis_across().filter(has_rows) {
            let desired = elements[axis];
            elements[axis] = (desired..=MAX_REFINEMENT.saturating_mul(desired))
                .take(MAX_TRIED_COUNTS)
                .find(|&count| has_row(clamp.width_m, pin.extent_m()[axis], count))
                .unwrap_or(desired);
        }
        elements
    }

    /// The finest mesh of a job that asks for an accuracy and gives no mesh.
    pub(in crate::study) fn finest_elements(pin: &Pin, clamp: &Clamp) -> [usize; 3] {
        Self::Draft.elements(pin, clamp).map(|count| FINEST * count)
    }

    /// Parameters that have no effect beside a preset that takes precedence: those that it sets, and the time step, which
    /// takes precedence over the safety factor.
    pub(in crate::study) const COVERS: &'static [&'static str] =
        &["elements", "safety_factor", "time_step_s", "tolerance", "drift_tolerance", "accuracy_mu_star"];

    /// Chooses how a job on a rigid disk is solved, except for the parameters that something else `gives` by name: in the
    /// way that is fastest for the same errors (docs/evidence/speed.md). This is precision `single`, and, on meshes finer than
    /// the draft's, start `nested` and stability `eigenvalues`.
    ///
    /// A job that single precision does not suit stays in double precision.
    pub(in crate::study) fn choose_way(self, job: &mut JobSpec, gives: impl Fn(&str) -> bool) {
        if job.scene.disk.kind == DiskKind::Elastic {
            return;
        }
        if !gives("precision") && job.suits_single_precision() {
            job.numerics.precision = Precision::Single;
        }
        if self == Self::Draft && job.accuracy.is_none() {
            return;
        }
        if !gives("start") && job.run.stop_early {
            job.run.start = Start::Nested;
        }
        if !gives("stability") && job.is_of_measured_kind() {
            job.stability = StabilityMethod::Eigenvalues;
        }
    }

    /// A job with the way to solve it that the preset chooses.
    pub fn way(self, mut job: JobSpec) -> JobSpec {
        self.choose_way(&mut job, |_| false);
        job
    }

    /// Parameters of [`Self::choose_way`]. A preset that takes precedence leaves those alone that a study gives.
    pub(in crate::study) const CHOOSES: &'static [&'static str] = &["precision", "start", "stability"];

    /// Sets mesh, time step, detection and accuracy of a job, except for the parameters that something else `gives` by name. The
    /// mesh is made for the job's own pin and clamp.
    pub(in crate::study) fn fill(self, job: &mut JobSpec, gives: impl Fn(&str) -> bool) {
        if !gives("accuracy_mu_star") {
            job.accuracy = self.accuracy();
        }
        let elements = self.elements(&job.scene.pin, &job.scene.clamp);
        for (axis, name) in ["nx", "ny", "nz"].into_iter().enumerate() {
            if !gives(name) {
                job.scene.pin.elements[axis] = elements[axis];
            }
        }
        for (name, field, value) in [
            ("safety_factor", &mut job.numerics.safety_factor, self.safety_factor()),
            ("tolerance", &mut job.detection.tolerance, self.tolerance()),
            ("drift_tolerance", &mut job.detection.drift_tolerance, self.drift_tolerance()),
        ] {
            if !gives(name) {
                *field = value;
            }
        }
    }
}

/// Whether a mesh of `count` elements has a node row at `width_m` from the edge; a width of 0 is the edge itself.
fn has_row(width_m: f64, edge_m: f64, count: usize) -> bool {
    let rows = width_m / edge_m * count as f64;
    (rows - rows.round()).abs() < 1.0e-6
}

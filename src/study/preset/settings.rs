//! The presets and the settings that they stand for.

use crate::spec::{Clamp, DiskKind, FEWEST_ACROSS, JobSpec, Pin, Precision, Shape, StabilityMethod, Start};
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
    /// Two thirds of the element size and a smaller step than the standard, to check it by.
    Reference,
}

/// Largest refinement, relative to the desired element count, to get a node row at the clamp's edge.
const MAX_REFINEMENT: usize = 4;

/// Elements of the finest mesh of a job that asks for an accuracy over those of a draft, in each direction.
const FINEST: usize = 4;

/// Largest number of element counts that are tried: a pin of absurd size must not make the search long.
const MAX_TRIED_COUNTS: usize = 10_000;

impl Preset {
    /// All presets, the cheapest first.
    pub const ALL: [Self; 3] = [Self::Draft, Self::Standard, Self::Reference];

    /// The name in study files.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The preset called `name`.
    pub fn find(name: &str) -> Option<Self> {
        name.parse().ok()
    }

    /// Elements along the pin's shortest edge. The resulting element size is the target in all directions.
    ///
    /// It is a count and not a size in metres, because the problem scales with the pin.
    pub fn elements_along_shortest_edge(self) -> usize {
        match self {
            Self::Draft => 10,
            Self::Standard => 20,
            Self::Reference => 30,
        }
    }

    /// Time step as a fraction of the stability limit.
    pub fn safety_factor(self) -> f64 {
        match self {
            Self::Draft => 0.9,
            Self::Standard => 0.7,
            Self::Reference => 0.5,
        }
    }

    /// Tolerance of the periodic state, [`Detection::tolerance`](crate::spec::Detection::tolerance).
    pub fn tolerance(self) -> f64 {
        match self {
            Self::Draft => 0.03,
            Self::Standard => 0.01,
            Self::Reference => 0.003,
        }
    }

    /// Drift of the periodic state, [`Detection::drift_tolerance`](crate::spec::Detection::drift_tolerance).
    pub fn drift_tolerance(self) -> f64 {
        match self {
            Self::Draft => 0.003,
            Self::Standard => 0.001,
            Self::Reference => 0.0003,
        }
    }

    /// Element counts for a pin under a clamp. A cylinder has rows of nodes at many distances, so its counts do not depend on the clamp.
    ///
    /// In the direction across the clamp's edge it is the smallest count, from the desired one up to four times as many,
    /// that has a node row at the edge. If there is none, it is the desired count, and the solver refuses the scene with
    /// the reason.
    pub fn elements(self, pin: &Pin, clamp: &Clamp) -> [usize; 3] {
        let shortest_m = pin.extent_m().iter().copied().fold(f64::INFINITY, f64::min);
        let size_m = shortest_m / self.elements_along_shortest_edge() as f64;
        // Halves are rounded up: 15 mm in 2 mm elements give 8. The scene's check refuses counts out of bounds.
        let mut elements = pin.extent_m().map(|edge_m| ((edge_m / size_m + 0.5) as usize).max(1));
        if pin.shape == Shape::Cylinder {
            let across = elements[0].max(FEWEST_ACROSS);
            return [across, across, elements[2]];
        }
        if let Some(axis) = clamp.side.axis_across() {
            let desired = elements[axis];
            elements[axis] = (desired..=MAX_REFINEMENT.saturating_mul(desired))
                .take(MAX_TRIED_COUNTS)
                .find(|&count| has_row(clamp.width_m, pin.extent_m()[axis], count))
                .unwrap_or(desired);
        }
        elements
    }

    /// The finest mesh of a job that asks for an accuracy and gives no mesh. Halved twice it is the draft's, which has a row of nodes at the
    /// clamp's edge, so all of them have one.
    pub(in crate::study) fn finest_elements(pin: &Pin, clamp: &Clamp) -> [usize; 3] {
        Self::Draft.elements(pin, clamp).map(|count| FINEST * count)
    }

    /// Parameters that have no effect beside a preset that takes precedence: those that it sets, and the time step, which
    /// takes precedence over the safety factor.
    pub(in crate::study) const COVERS: &'static [&'static str] =
        &["elements", "safety_factor", "time_step_s", "tolerance", "drift_tolerance"];

    /// Chooses how a job on a rigid disk is solved, except for the parameters that something else `gives` by name: in the
    /// way that is fastest for the same errors (docs/performance.md). This is precision `single`, and, on meshes finer than
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

    /// Sets mesh, time step and detection of a job, except for the parameters that something else `gives` by name. The
    /// mesh is made for the job's own pin and clamp.
    pub(in crate::study) fn fill(self, job: &mut JobSpec, gives: impl Fn(&str) -> bool) {
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

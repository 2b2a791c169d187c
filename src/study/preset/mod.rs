//! Named accuracies: mesh, time step and detection by one word.

mod evidence;

pub use evidence::{CaseEvidence, Evidence, PresetEvidence, ReferenceEvidence};

use super::parameter::Parameter;
use crate::spec::{Clamp, ClampSide, Pin, Scene};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// How accurate a study is to be. `tribosweep presets` prints settings and measured errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// A quick look: regimes and trends.
    Draft,
    /// The settings of figure7.
    Standard,
    /// Two thirds of the element size and a smaller step than the standard, to check it by.
    Reference,
}

/// The parameters that presets set.
const SET: [&str; 4] = ["elements", "safety_factor", "tolerance", "drift_tolerance"];

/// The parameter, and field, that goes before the safety factor.
const TIME_STEP: &str = "time_step_s";

/// Meshes of up to so many times the wished number of elements are tried to have a node row at the clamp's edge.
const FINER_FOR_CLAMP: usize = 4;

impl Preset {
    /// All presets, the cheapest first.
    pub const ALL: [Self; 3] = [Self::Draft, Self::Standard, Self::Reference];

    /// The name in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Standard => "standard",
            Self::Reference => "reference",
        }
    }

    /// The preset called `name`.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.name() == name)
    }

    /// Elements along the pin's shortest edge. The element size that follows is aimed at in all directions.
    ///
    /// A number and not a size in metres: the problem scales with the pin.
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

    /// Element counts for a pin under a clamp.
    ///
    /// Across the clamp's edge the smallest count from the wished one up to four times it that has a node row
    /// there; without one the wished count, and the scene is refused with the reason.
    pub fn elements(self, pin: &Pin, clamp: &Clamp) -> [usize; 3] {
        let shortest_m = pin.size_m.iter().copied().fold(f64::INFINITY, f64::min);
        let size_m = shortest_m / self.elements_along_shortest_edge() as f64;
        // Halves up: 15 mm in 2 mm elements would be 8. A count out of bounds is for the scene's check to refuse.
        let mut elements = pin.size_m.map(|edge_m| ((edge_m / size_m + 0.5) as usize).max(1));
        if let Some(axis) = clamped_axis(clamp.side) {
            let wished = elements[axis];
            elements[axis] = (wished..=FINER_FOR_CLAMP.saturating_mul(wished))
                .take(MOST_TRIED)
                .find(|&count| has_row(clamp.width_m, pin.size_m[axis], count))
                .unwrap_or(wished);
        }
        elements
    }

    /// The parameters that the preset sets in a scene, by their names in grids: those of [`SET`].
    pub fn settings(self, scene: &Scene) -> Vec<(&'static str, Value)> {
        vec![
            ("elements", json!(self.elements(&scene.pin, &scene.clamp))),
            ("safety_factor", json!(self.safety_factor())),
            ("tolerance", json!(self.tolerance())),
            ("drift_tolerance", json!(self.drift_tolerance())),
        ]
    }

    /// Whether a parameter, or the whole field that it is a part of, is set by presets.
    pub(super) fn covers(parameter: &Parameter) -> bool {
        SET.iter().filter_map(|name| Parameter::find(name)).any(|own| own.sets(&parameter.field()))
            || parameter.name == TIME_STEP
    }

    /// Sets the parameters in a serialised job, except where `overrides` set them: what the command line says.
    ///
    /// The preset's time step is a fraction of the limit: one that the file gives goes.
    pub(super) fn override_job(self, job: &mut Value, overrides: &[&Parameter]) {
        let scene = super::json::checked_job(job).scene;
        self.apply(&scene, job, |parameter| overrides.iter().any(|other| other.overlaps(parameter)));
        if !overrides.iter().any(|parameter| parameter.name == TIME_STEP)
            && let Some(Value::Object(numerics)) = job.get_mut("numerics")
        {
            numerics.remove(TIME_STEP);
        }
    }

    /// Sets the parameters in a serialised job, except those that `is_given` says are given otherwise.
    pub(super) fn apply(self, scene: &Scene, job: &mut Value, is_given: impl Fn(&Parameter) -> bool) {
        for (name, value) in self.settings(scene) {
            let parameter = Parameter::find(name).expect("presets set parameters of the registry");
            if !is_given(parameter) {
                parameter.set(job, &value);
            }
        }
    }
}

/// A pin with absurd sizes must not make the search for a row long.
const MOST_TRIED: usize = 10_000;

/// The direction across which the clamp's strip has its width.
fn clamped_axis(side: ClampSide) -> Option<usize> {
    match side {
        ClampSide::InnerSide | ClampSide::OuterSide | ClampSide::BothSides => Some(0),
        ClampSide::LeadingEnd | ClampSide::TrailingEnd | ClampSide::BothEnds => Some(1),
        ClampSide::WholeTop => None,
    }
}

/// Whether a node row lies at `width_m` from the edge; a width of 0 is the edge's own row.
fn has_row(width_m: f64, edge_m: f64, count: usize) -> bool {
    let rows = width_m / edge_m * count as f64;
    (rows - rows.round()).abs() < 1.0e-6
}

//! The presets and the parameters that they set.

use crate::spec::{Clamp, ClampSide, Pin, Scene};
use crate::study::json;
use crate::study::parameter::Parameter;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
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

/// The parameters that presets set.
const PRESET_PARAMETERS: [&str; 4] = ["elements", "safety_factor", "tolerance", "drift_tolerance"];

/// The parameter and field that takes precedence over the safety factor.
const TIME_STEP: &str = "time_step_s";

/// Largest refinement, relative to the desired element count, to get a node row at the clamp's edge.
const MAX_REFINEMENT: usize = 4;

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

    /// Element counts for a pin under a clamp.
    ///
    /// In the direction across the clamp's edge it is the smallest count, from the desired one up to four times as many,
    /// that has a node row at the edge. If there is none, it is the desired count, and the solver refuses the scene with
    /// the reason.
    pub fn elements(self, pin: &Pin, clamp: &Clamp) -> [usize; 3] {
        let shortest_m = pin.size_m.iter().copied().fold(f64::INFINITY, f64::min);
        let size_m = shortest_m / self.elements_along_shortest_edge() as f64;
        // Halves are rounded up: 15 mm in 2 mm elements give 8. The scene's check refuses counts out of bounds.
        let mut elements = pin.size_m.map(|edge_m| ((edge_m / size_m + 0.5) as usize).max(1));
        if let Some(axis) = clamped_axis(clamp.side) {
            let desired = elements[axis];
            elements[axis] = (desired..=MAX_REFINEMENT.saturating_mul(desired))
                .take(MAX_TRIED_COUNTS)
                .find(|&count| has_row(clamp.width_m, pin.size_m[axis], count))
                .unwrap_or(desired);
        }
        elements
    }

    /// The values of [`PRESET_PARAMETERS`] for a scene.
    fn settings(self, scene: &Scene) -> Vec<(&'static str, Value)> {
        vec![
            ("elements", self.elements(&scene.pin, &scene.clamp).to_vec().into()),
            ("safety_factor", self.safety_factor().into()),
            ("tolerance", self.tolerance().into()),
            ("drift_tolerance", self.drift_tolerance().into()),
        ]
    }

    /// Whether presets set a parameter, or the whole field of which it sets a part.
    pub(in crate::study) fn covers(parameter: &Parameter) -> bool {
        PRESET_PARAMETERS
            .iter()
            .filter_map(|name| Parameter::find(name))
            .any(|own| own.sets(&parameter.field()))
            || parameter.name == TIME_STEP
    }

    /// Sets the parameters in a serialised job, except those that the `overrides` of the command line set.
    ///
    /// The preset's time step is a fraction of the stability limit, so a time step from the file is removed.
    pub(in crate::study) fn override_job(self, job: &mut Value, overrides: &[&Parameter]) {
        let scene = json::decode_checked(job).scene;
        self.apply(&scene, job, |parameter| overrides.iter().any(|other| other.overlaps(parameter)));
        if !overrides.iter().any(|parameter| parameter.name == TIME_STEP)
            && let Some(Value::Object(numerics)) = job.get_mut("numerics")
        {
            numerics.remove(TIME_STEP);
        }
    }

    /// Sets the parameters in a serialised job, except those for which `is_set_elsewhere` holds.
    pub(in crate::study) fn apply(
        self,
        scene: &Scene,
        job: &mut Value,
        is_set_elsewhere: impl Fn(&Parameter) -> bool,
    ) {
        for (name, value) in self.settings(scene) {
            let parameter = Parameter::find(name).expect("presets set parameters of the registry");
            if !is_set_elsewhere(parameter) {
                parameter.set(job, &value);
            }
        }
    }
}

/// The direction across which the clamp's strip has its width.
fn clamped_axis(side: ClampSide) -> Option<usize> {
    match side {
        ClampSide::InnerSide | ClampSide::OuterSide | ClampSide::BothSides => Some(0),
        ClampSide::LeadingEnd | ClampSide::TrailingEnd | ClampSide::BothEnds => Some(1),
        ClampSide::WholeTop => None,
    }
}

/// Whether a mesh of `count` elements has a node row at `width_m` from the edge; a width of 0 is the edge itself.
fn has_row(width_m: f64, edge_m: f64, count: usize) -> bool {
    let rows = width_m / edge_m * count as f64;
    (rows - rows.round()).abs() < 1.0e-6
}

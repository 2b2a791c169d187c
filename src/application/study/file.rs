//! The shape of a study file.

use super::calibrate::Calibrate;
use super::damping::Damping;
use super::grid_schema::{conditions_schema, derive_schema, grid_schema};
use super::growth::{Continue, Refine};
use super::json::present;
use super::preset::Preset;
use super::report_axes::ReportAxes;
use super::samples::given::SamplesFile;
use crate::spec::{
    Accuracy, Detection, HeightMap, MeshFile, Numerics, Roughness, RunControl, Scene, StabilityMethod,
};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Map, Value};

/// A study: a base job and a grid of parameters to vary. Whatever is not given has the value of the
/// reference scene.
#[derive(Debug, Default, Deserialize, serde::Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(title = "tribosweep study")]
pub(super) struct StudyFile {
    /// Where the JSON schema of studies is, for editors; it has no effect.
    #[serde(rename = "$schema", skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Name of the study; the file's stem when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(regex(pattern = "^[A-Za-z0-9_-]+$"))]
    pub name: Option<String>,
    /// What the study is for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// Mesh, time step and detection by one word; what the file gives itself overrides it.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "Preset")]
    pub preset: Option<Preset>,
    /// Sliding speed (m/s) of the disk under the centre of the pin, instead of `scene.disk.omega_rpm`.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub sliding_speed_m_s: Option<f64>,
    /// Damping as it is measured, instead of `numerics.beta_r_s`.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "Damping")]
    pub damping: Option<Damping>,
    /// Bodies, contact law, boundary conditions and load.
    pub scene: Scene,
    /// Integrator and time step.
    pub numerics: Numerics,
    /// How long a run lasts and what it averages over.
    pub run: RunControl,
    /// When a state counts as periodic or as decayed.
    pub detection: Detection,
    /// How a job finds out whether its steady sliding is stable.
    pub stability: StabilityMethod,
    /// How exact results are to be: each job goes from mesh to mesh until it is.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "Accuracy")]
    pub accuracy: Option<Accuracy>,
    /// Parameters that are tied to others by an expression: `{ "mu_static": "1.4 * mu" }`.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(schema_with = "derive_schema")]
    pub derive: Option<Map<String, Value>>,
    /// Parameters to vary; the jobs are all combinations. Absent: a single job.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(schema_with = "grid_schema")]
    pub grid: Option<Map<String, Value>>,
    /// Points that are no grid. The jobs are all combinations of them with those of `grid`.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "SamplesFile")]
    pub samples: Option<SamplesFile>,
    /// Only points that fulfil one of these conditions are jobs: parameters with `{ "from": a, "to": b }`, a list or a value.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(schema_with = "conditions_schema")]
    pub include: Option<Vec<Map<String, Value>>>,
    /// Points that fulfil one of these conditions are no jobs.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(schema_with = "conditions_schema")]
    pub exclude: Option<Vec<Map<String, Value>>>,
    /// Where the program adds points by itself: curves, minima, boundaries between regimes.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "Refine")]
    pub refine: Option<Refine>,
    /// Jobs that begin in the motion with which another one ended: branches and basins of limit cycles.
    #[serde(rename = "continue", skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "Continue")]
    pub continues: Option<Continue>,
    /// Measured points, and the search for the values of parameters that explain them.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "Calibrate")]
    pub calibrate: Option<Calibrate>,
    /// Axes and quantities of the report.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "ReportAxes")]
    pub report: Option<ReportAxes>,
}

impl StudyFile {
    /// An example that has every object and every name that a study file can have, for checks of its shape.
    pub(super) fn template() -> Value {
        let mut scene = Scene::default();
        scene.pin.mesh = Some(Box::new(MeshFile::template()));
        scene.pin.base.roughness = Some(Roughness::default());
        scene.pin.base.height_map = Some(HeightMap::default());
        let file = Self {
            scene,
            preset: Some(Preset::Standard),
            damping: Some(Damping::default()),
            report: Some(ReportAxes::template()),
            ..Self::default()
        };
        serde_json::to_value(file).expect("a study is plain data with string keys")
    }
}

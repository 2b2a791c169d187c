//! Measured errors of the presets. The data are written by `scripts/accuracy.py`, never by hand.

use super::settings::Preset;
use serde::{Deserialize, Serialize};

/// Errors of all presets, and where they were measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evidence {
    /// The program that wrote it.
    pub written_by: String,
    /// `solver::VERSION` of the program that was measured.
    pub solver_version: String,
    /// The scene in words.
    pub scene: String,
    /// Local friction coefficient of all cases.
    pub mu: f64,
    /// Stiffness-proportional damping β_R \[s\] of all cases.
    pub beta_r_s: f64,
    /// What the errors are taken from.
    pub reference: ReferenceEvidence,
    /// One entry a preset, in the order of [`Preset::ALL`].
    pub presets: Vec<PresetEvidence>,
}

/// What the errors are taken from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReferenceEvidence {
    /// Number of elements in x, y and z.
    pub elements: [usize; 3],
    /// Time step as a fraction of the stability limit.
    pub safety_factor: f64,
    /// Where the limits of μ* come from, in words.
    pub mu_star_source: String,
    /// The largest of its cases' uncertainties.
    pub mu_star_uncertainty: f64,
    /// Its results, each with its uncertainty.
    pub cases: Vec<CaseEvidence>,
}

/// One speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseEvidence {
    /// Disk speed ω (rpm).
    pub omega_rpm: f64,
    /// Macroscopic friction coefficient μ*.
    pub mu_star: f64,
    /// Frequency (Hz).
    pub frequency_hz: f64,
    /// Shares of stick, slip and separation.
    pub shares: [f64; 3],
    /// Of the reference: μ* in the limit of fine meshes, from which errors are taken. Its own mesh is not fine enough for that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mu_star_limit: Option<f64>,
    /// Of the reference: how well this limit is known, relative to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mu_star_uncertainty: Option<f64>,
}

/// What was measured of one preset.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PresetEvidence {
    /// Name of the preset.
    pub name: String,
    /// Elements in x, y and z on the measured scene.
    pub elements: [usize; 3],
    /// Time step as a fraction of the stability limit.
    pub safety_factor: f64,
    /// Tolerance of the periodic state.
    pub tolerance: f64,
    /// Drift of the periodic state.
    pub drift_tolerance: f64,
    /// Its results.
    pub cases: Vec<CaseEvidence>,
    /// Largest relative error of μ*, from the limit of fine meshes.
    pub mu_star_error: f64,
    /// Largest relative error of the frequency, from the reference's mesh.
    pub frequency_error: f64,
    /// Largest absolute error of a share, from the reference's mesh.
    pub shares_error: f64,
    /// Nodes × steps of all cases over those of the standard preset.
    pub relative_cost: f64,
}

const MEASURED: &str = include_str!("../presets.json");

impl Evidence {
    /// The evidence that this version was built with.
    ///
    /// # Panics
    /// If the file is not what the script writes; a test reads it.
    pub fn measured() -> Self {
        serde_json::from_str(MEASURED).expect("presets.json is written by scripts/accuracy.py")
    }

    /// What was measured of a preset.
    pub fn of(&self, preset: Preset) -> Option<&PresetEvidence> {
        self.presets.iter().find(|entry| entry.name == preset.name())
    }
}

//! Measured errors of the presets. The data are written by `scripts/mesh_errors.py`, never by hand.

use super::settings::Preset;
use serde::{Deserialize, Serialize};

/// Errors of the presets that have one mesh, over many scenes (docs/evidence/mesh_errors.md).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evidence {
    /// The program that wrote it.
    pub written_by: String,
    /// Number of scenes.
    pub scenes: usize,
    /// One entry for each preset that asks for no accuracy, in the order of [`Preset::ALL`].
    pub presets: Vec<PresetEvidence>,
}

/// What was measured of one preset. Errors are relative, of limit cycles, against the limit of fine meshes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PresetEvidence {
    /// Name of the preset.
    pub name: String,
    /// Jobs with a limit cycle whose limit is known.
    pub jobs: usize,
    /// Median of the errors of μ\*.
    pub mu_star_median: f64,
    /// The error of μ\* that 95 % of the jobs are within.
    pub mu_star_95: f64,
    /// Median of the errors of the frequency.
    pub frequency_median: f64,
    /// The error of the frequency that 95 % of the jobs are within.
    pub frequency_95: f64,
    /// Nodes × steps of the jobs, with those on coarser meshes, over those of the standard preset.
    pub relative_cost: f64,
}

const MEASURED: &str = include_str!("../presets.json");

impl Evidence {
    /// The evidence that this version was built with.
    ///
    /// # Panics
    /// If the file is not what the script writes; a test reads it.
    pub fn measured() -> Self {
        serde_json::from_str(MEASURED).expect("presets.json is written by scripts/mesh_errors.py")
    }

    /// What was measured of a preset; none if it asks for an accuracy, which each of its jobs knows by itself.
    pub fn of(&self, preset: Preset) -> Option<&PresetEvidence> {
        self.presets.iter().find(|entry| entry.name == preset.name())
    }
}

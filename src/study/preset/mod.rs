//! Named accuracies: mesh, time step and detection by one word.

mod evidence;
mod settings;

pub use evidence::{CaseEvidence, Evidence, PresetEvidence, ReferenceEvidence};
pub use settings::Preset;

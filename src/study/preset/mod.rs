//! Named accuracies: mesh, time step and detection by one word.

mod applies;
mod evidence;
mod settings;

pub use applies::PresetError;
pub use evidence::{CaseEvidence, Evidence, PresetEvidence, ReferenceEvidence};
pub use settings::Preset;

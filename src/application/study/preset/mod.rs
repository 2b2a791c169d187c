//! Named accuracies: mesh, time step and detection by one word.

mod evidence;
mod settings;

pub use evidence::{Evidence, PresetEvidence};
pub use settings::Preset;

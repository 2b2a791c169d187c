//! Where the value of a parameter comes from.

use super::covered::is_set_by_presets;
use super::damping::{DAMPERS, OF_PIN};
use super::definition::Study;
use super::parameter::Parameter;

/// Where the value of a parameter comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// The grid of the study.
    Grid,
    /// A field of the study.
    Study,
    /// The preset that the study names.
    Preset,
    /// Nobody gave it.
    Default,
}

impl Origin {
    /// The origin in a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Grid => "grid",
            Self::Study => "study",
            Self::Preset => "preset",
            Self::Default => "default",
        }
    }
}

impl Study {
    /// Where the value of a parameter comes from.
    pub fn origin(&self, parameter: &Parameter) -> Origin {
        let field = parameter.field();
        let is_preset_given =
            self.source.gives("preset") || self.varied().any(|varied| varied.name == "preset");
        let in_grid = |axis: &Parameter| axis.overlaps(parameter);
        // `scene.pin.elements` gives `scene.pin.elements[0]` too.
        let list = field.split('[').next().unwrap_or_default();
        if self.varied().any(in_grid) {
            Origin::Grid
        } else if self.source.gives(&field)
            || self.source.gives(list)
            || parameter.name == "beta_r_s" && OF_PIN.iter().any(|field| self.source.gives(field))
            || parameter.name == "alpha_r_per_s" && self.source.gives("damping.second_frequency_hz")
            || parameter.name == "omega_rpm" && self.source.gives("sliding_speed_m_s")
            || self.source.gives(&format!("derive.{}", parameter.name))
            || DAMPERS.contains(&parameter.name) && self.source.gives("damping.holder_ratio")
        {
            Origin::Study
        } else if is_preset_given && is_set_by_presets(parameter) {
            Origin::Preset
        } else {
            Origin::Default
        }
    }
}

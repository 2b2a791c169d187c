//! Which parameters presets set.

use super::parameter::Parameter;
use super::preset::Preset;

/// Whether presets set a parameter, or the whole field of which it sets a part.
pub fn is_set_by_presets(parameter: &Parameter) -> bool {
    let mut covered = Preset::COVERS.iter().chain(Preset::CHOOSES).map(|name| Parameter::named(name));
    covered.any(|own| own.sets(&parameter.field()))
}

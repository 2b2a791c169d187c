//! The names of parameters and how they are written for a reader.

use crate::publish::value::rounded_text;
use serde_json::Value;

/// The parameter that is the disk speed.
pub(super) const OMEGA: &str = "omega_rpm";
/// The parameter that is the local friction coefficient.
pub(super) const MU: &str = "mu";

/// Whether a parameter is neither ω nor μ. Those two have a place of their own in every table and figure.
pub(super) fn is_further(name: &str) -> bool {
    name != OMEGA && name != MU
}

/// `name = value`, with the symbols of the field for ω and μ.
pub fn assignment(name: &str, value: &Value) -> String {
    match name {
        OMEGA => format!("ω = {} rpm", rounded_text(value)),
        MU => format!("μ = {}", rounded_text(value)),
        _ if value.is_null() => format!("{name} not set"),
        _ => format!("{name} = {}", rounded_text(value)),
    }
}

/// Several parameters in words.
pub(super) fn assignments<'a>(parameters: impl IntoIterator<Item = (&'a str, Value)>) -> String {
    let words = parameters.into_iter().map(|(name, value)| assignment(name, &value));
    words.collect::<Vec<_>>().join(", ")
}

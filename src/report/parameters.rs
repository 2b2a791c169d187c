//! The names of parameters and how they are written for a reader.

use crate::publish::table::Head;
use crate::publish::value::{self, short, text};
use crate::units::name_and_unit;
use serde_json::Value;

/// The parameter that is the disk speed.
pub(super) const OMEGA: &str = "omega_rpm";
/// The parameter that is the local friction coefficient.
pub(super) const MU: &str = "mu";
/// Where a row comes from: the name of its study or of its file of measured points. It can be chosen like a parameter.
pub(super) const SOURCE: &str = "source";

/// Whether a parameter is neither ω nor μ. Those two have a place of their own in every table and figure.
pub(super) fn is_further(name: &str) -> bool {
    name != OMEGA && name != MU
}

/// The head of a column of a parameter.
pub(super) fn head(name: &str) -> Head {
    let meaning = match name {
        OMEGA => "rotation speed ω of the disk",
        MU => "local friction coefficient μ",
        SOURCE => "study or file",
        _ => "the grid parameter of that name",
    };
    Head::new(name.to_owned(), name_and_unit(name).1, meaning)
}

/// `name = value` as people write it: `clamp_width = 2.5 mm`, with the symbols of the field for ω and μ.
pub fn assignment(name: &str, value: &Value) -> String {
    match name {
        OMEGA => format!("ω = {}", in_words(name, value)),
        MU => format!("μ = {}", in_words(name, value)),
        _ if value.is_null() => format!("{name} not set"),
        SOURCE => in_words(name, value),
        _ => format!("{} = {}", name_and_unit(name).0, in_words(name, value)),
    }
}

/// The value of a parameter with its unit, as people write it.
pub(super) fn in_words(name: &str, value: &Value) -> String {
    let unit = name_and_unit(name).1;
    match value.as_f64() {
        Some(_) if value.is_u64() && unit.is_empty() => text(value),
        Some(x) => {
            let (factor, unit) = value::multiple(unit, x);
            with_unit(short(x / factor), unit)
        }
        None if value.is_null() => value::MISSING.to_owned(),
        None => text(value),
    }
}

/// `name = first … last`, with the unit once if it is the same.
pub(super) fn range(name: &str, first: &Value, last: &Value) -> String {
    let (from, to) = (assignment(name, first), in_words(name, last));
    let shared = to.split_once(' ').and_then(|(_, unit)| from.strip_suffix(unit));
    format!("{} … {to}", shared.unwrap_or(&from).trim_end())
}

/// A number with its unit, if it has one.
pub(super) fn with_unit(number: String, unit: &str) -> String {
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// Several parameters in words.
pub(super) fn assignments<'a>(parameters: impl IntoIterator<Item = (&'a str, Value)>) -> String {
    let words = parameters.into_iter().map(|(name, value)| assignment(name, &value));
    words.collect::<Vec<_>>().join(", ")
}

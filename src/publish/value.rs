//! Values as text: the same in CSV, tables and legends.

use serde_json::Value;

/// The parameter that is the disk speed.
pub const OMEGA: &str = "omega_rpm";
/// The parameter that is the local friction coefficient.
pub const MU: &str = "mu";

/// Stands for a result that is not there.
pub const MISSING: &str = "–";

/// The shortest text that reads back as the same number.
///
/// Exponents outside the range where digits are readable: `1e-9`, not `0.000000001`.
pub fn number(x: f64) -> String {
    if x == 0.0 {
        // Not `-0`.
        return "0".to_owned();
    }
    if (1e-4..1e15).contains(&x.abs()) { format!("{x}") } else { format!("{x:e}") }
}

/// A number for a reader: without the rounding of a computed grid, 0.15 for 0.15000000000000002.
pub fn rounded(x: f64) -> String {
    format!("{x:.9e}").parse().map_or_else(|_| number(x), number)
}

/// A number with fixed decimals, or the mark of a missing result where it is not finite.
pub fn fixed(x: f64, decimals: usize) -> String {
    if x.is_finite() { format!("{x:.decimals$}") } else { MISSING.to_owned() }
}

/// A value in a cell. Empty for null; arrays as `12x15x10`.
pub fn text(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Bool(flag) => flag.to_string(),
        Value::Number(n) if n.is_f64() => n.as_f64().map(number).unwrap_or_default(),
        Value::Number(n) => n.to_string(),
        Value::Array(items) => items.iter().map(text).collect::<Vec<_>>().join("x"),
        Value::Object(_) => value.to_string(),
    }
}

/// A value for a reader: [`text`], but numbers [`rounded`].
pub fn shown(value: &Value) -> String {
    match value {
        Value::Number(n) if n.is_f64() => n.as_f64().map(rounded).unwrap_or_default(),
        _ => text(value),
    }
}

/// `name = value`, with the symbols of the field for ω and μ.
pub fn assignment(name: &str, value: &Value) -> String {
    match name {
        OMEGA => format!("ω = {} rpm", shown(value)),
        MU => format!("μ = {}", shown(value)),
        _ if value.is_null() => format!("{name} not set"),
        _ => format!("{name} = {}", shown(value)),
    }
}

/// Sorts values that are numbers, and leaves others as they are; gives the new place of each.
pub fn sort(values: &mut Vec<Value>) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    if values.iter().all(Value::is_number) {
        let number = |at: &usize| values[*at].as_f64().unwrap_or_default();
        order.sort_by(|a, b| number(a).total_cmp(&number(b)));
    }
    let mut places = vec![0; order.len()];
    for (place, &at) in order.iter().enumerate() {
        places[at] = place;
    }
    *values = order.iter().map(|&at| values[at].clone()).collect();
    places
}

/// Text as a part of a file's name: letters, digits, `.`, `_` and `-`.
pub fn in_file_name(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-') { c } else { '-' })
        .collect()
}

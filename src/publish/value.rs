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
    digits(x, 10)
}

/// A number with so many significant digits, at least one, and no zeros after them.
pub fn digits(x: f64, digits: usize) -> String {
    format!("{x:.0$e}", digits.max(1) - 1).parse().map_or_else(|_| number(x), number)
}

/// A number with fixed decimals, or the mark of a missing result where it is not finite.
pub fn fixed(x: f64, decimals: usize) -> String {
    if x.is_finite() { format!("{x:.decimals$}") } else { MISSING.to_owned() }
}

/// A time that something took, for a reader.
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if !s.is_finite() => MISSING.to_owned(),
        s if s < 0.9995 => format!("{:.0} ms", s * 1e3),
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86_400.0),
    }
}

/// A moment, from milliseconds since 1970-01-01 UTC: `2026-11-21 23:15 UTC`.
pub fn moment(ms: i64) -> String {
    let minutes = ms.div_euclid(60_000);
    let (days, minute) = (minutes.div_euclid(1440), minutes.rem_euclid(1440));
    // Years that begin in March, in eras of 400 years of equal length.
    let from_era = days + 719_468;
    let (era, day) = (from_era.div_euclid(146_097), from_era.rem_euclid(146_097));
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let of_year = day - (365 * year + year / 4 - year / 100);
    let from_march = (5 * of_year + 2) / 153;
    let date = of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
    let year = year + 400 * era + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{date:02} {:02}:{:02} UTC", minute / 60, minute % 60)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: dates at the ends of months, years and leap years; moments before 1970.
    #[test]
    fn moments_are_dates() {
        let day = 86_400_000;
        assert_eq!(moment(0), "1970-01-01 00:00 UTC");
        assert_eq!(moment(-1), "1969-12-31 23:59 UTC");
        assert_eq!(moment(951_782_400_000), "2000-02-29 00:00 UTC");
        assert_eq!(moment(951_782_400_000 + day), "2000-03-01 00:00 UTC");
        assert_eq!(moment(1_798_761_599_999), "2026-12-31 23:59 UTC");
    }
}

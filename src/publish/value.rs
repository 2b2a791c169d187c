//! Values as text: the same in CSV, tables, legends and axes.

use crate::units::duration_text;
use serde_json::Value;
use std::time::{Duration, SystemTime};

/// The text in place of a result that does not exist.
pub const MISSING: &str = "–";

/// The shortest text that reads back as the same number.
///
/// It has an exponent where plain digits are hard to read: `1e-9`, not `0.000000001`.
pub fn number(x: f64) -> String {
    if x == 0.0 {
        // Not `-0`.
        return "0".to_owned();
    }
    if (1e-4..1e15).contains(&x.abs()) { format!("{x}") } else { format!("{x:e}") }
}

/// A number for a reader: without the rounding errors of a computed grid, 0.15 for 0.15000000000000002.
pub fn rounded(x: f64) -> String {
    significant(x, 10)
}

/// A number with at most `digits` significant digits (at least one), without trailing zeros.
pub fn significant(x: f64, digits: usize) -> String {
    format!("{x:.0$e}", digits.max(1) - 1).parse().map_or_else(|_| number(x), number)
}

/// A number with a fixed number of decimals; [`MISSING`] if it is not finite.
pub fn fixed(x: f64, decimals: usize) -> String {
    if x.is_finite() { format!("{x:.decimals$}") } else { MISSING.to_owned() }
}

/// Multiples of units in which people write quantities: unit, smallest size from which the multiple is used, factor, name.
/// The largest size comes first.
const MULTIPLES: [(&str, f64, f64, &str); 12] = [
    ("Pa", 1e8, 1e9, "GPa"),
    ("Pa", 1e5, 1e6, "MPa"),
    ("Pa", 1e2, 1e3, "kPa"),
    ("m", 1.0, 1.0, "m"),
    ("m", 1e-4, 1e-3, "mm"),
    ("m", 0.0, 1e-6, "µm"),
    ("s", 1.0, 1.0, "s"),
    ("s", 1e-4, 1e-3, "ms"),
    ("s", 1e-7, 1e-6, "µs"),
    ("s", 0.0, 1e-9, "ns"),
    ("Hz", 1e3, 1e3, "kHz"),
    ("N", 1e4, 1e3, "kN"),
];

/// The multiple of a unit in which a quantity of this size is written: its factor and its name. `("Pa", 5e8)` gives 10⁹
/// and `GPa`.
pub fn multiple<'a>(unit: &'a str, size: f64) -> (f64, &'a str) {
    let size = size.abs();
    let fits = |(of, least, ..): &&(&str, f64, f64, &str)| *of == unit && size >= *least && size > 0.0;
    MULTIPLES.iter().find(fits).map_or((1.0, unit), |(.., factor, name)| (*factor, *name))
}

/// A quantity as people write it, with four significant digits: `0.5 GPa`, `2.5 mm`. `unit` is empty for a number without
/// one.
pub fn quantity(x: f64, unit: &str) -> String {
    let (factor, name) = multiple(unit, x);
    let text = significant(x / factor, 4);
    if name.is_empty() { text } else { format!("{text} {name}") }
}

/// A duration in a unit that fits it; [`MISSING`] if it is not finite.
pub fn duration(seconds: f64) -> String {
    if seconds.is_finite() { duration_text(seconds, 1) } else { MISSING.to_owned() }
}

/// The Gregorian calendar repeats after 400 years, which are so many seconds.
const CALENDAR_PERIOD_S: i64 = 146_097 * 86_400;

/// A time to the minute, from milliseconds since 1970-01-01 UTC: `2026-11-21 23:15 UTC`.
pub fn utc_minute(ms: i64) -> String {
    let seconds = ms.div_euclid(1000);
    // humantime knows the years from 1970 to 9999 only. The remainder is in the years 1970 to 2369.
    let (periods, rest) = (seconds.div_euclid(CALENDAR_PERIOD_S), seconds.rem_euclid(CALENDAR_PERIOD_S));
    let time = SystemTime::UNIX_EPOCH + Duration::from_secs(rest.unsigned_abs());
    let text = humantime::format_rfc3339_seconds(time).to_string();
    // 2026-11-21T23:15:00Z
    let year = text[..4].parse::<i64>().unwrap_or_default() + 400 * periods;
    format!("{year:04}-{} {} UTC", &text[5..10], &text[11..16])
}

/// A value in a cell of a table: empty for null, arrays as `12x15x10`.
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

/// A value for a reader: as [`text`], with numbers [`rounded`].
pub fn rounded_text(value: &Value) -> String {
    match value {
        Value::Number(n) if n.is_f64() => n.as_f64().map(rounded).unwrap_or_default(),
        _ => text(value),
    }
}

/// Sorts the values if all of them are numbers, and otherwise leaves their order; returns the new index of each.
pub fn sort_numbers(values: &mut Vec<Value>) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    if values.iter().all(Value::is_number) {
        let number = |index: &usize| values[*index].as_f64().unwrap_or_default();
        order.sort_by(|a, b| number(a).total_cmp(&number(b)));
    }
    let mut new_indices = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        new_indices[old] = new;
    }
    *values = order.iter().map(|&index| values[index].clone()).collect();
    new_indices
}

/// Text as a part of a file name: every character but letters, digits, `.`, `_` and `-` becomes `-`.
pub fn file_name_part(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-') { c } else { '-' })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: quantities have the multiple of their unit that people write, at both ends of its range.
    #[test]
    fn quantities_are_written_as_people_write_them() {
        let cases = [
            (5e8, "Pa", "0.5 GPa"),
            (2.5e6, "Pa", "2.5 MPa"),
            (0.0025, "m", "2.5 mm"),
            (0.0026666666666666666, "m", "2.667 mm"),
            (0.0914, "m", "91.4 mm"),
            (5e-8, "s", "50 ns"),
            (0.04, "s", "40 ms"),
            (15_281.3, "Hz", "15.28 kHz"),
            (0.0, "m", "0 m"),
            (30.0, "N", "30 N"),
            (1.4251026703, "rpm", "1.425 rpm"),
            (0.4, "", "0.4"),
        ];
        for (x, unit, text) in cases {
            assert_eq!(quantity(x, unit), text);
        }
    }

    /// Protects: dates at the ends of months, years and leap years, and times before 1970 and after 9999.
    #[test]
    fn moments_are_dates() {
        let day = 86_400_000;
        assert_eq!(utc_minute(0), "1970-01-01 00:00 UTC");
        assert_eq!(utc_minute(-1), "1969-12-31 23:59 UTC");
        assert_eq!(utc_minute(951_782_400_000), "2000-02-29 00:00 UTC");
        assert_eq!(utc_minute(951_782_400_000 + day), "2000-03-01 00:00 UTC");
        assert_eq!(utc_minute(1_798_761_599_999), "2026-12-31 23:59 UTC");
        assert_eq!(utc_minute(253_402_300_800_000), "10000-01-01 00:00 UTC");
    }
}

//! Values as text: the same in CSV, tables, legends and axes.

use crate::units::duration_text;
use serde_json::Value;
use std::fmt::Display;
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

/// A number that [`significant`] writes, as a value; null if it is not finite.
pub fn significant_number(x: f64, digits: usize) -> Value {
    format!("{x:.0$e}", digits.max(1) - 1).parse::<f64>().unwrap_or(f64::NAN).into()
}

/// A number with at most so many decimals, as a value; null if it is not finite.
pub fn fixed_number(x: f64, decimals: usize) -> Value {
    format!("{x:.decimals$}").parse::<f64>().unwrap_or(f64::NAN).into()
}

/// A number with a fixed number of decimals; [`MISSING`] if it is not finite.
pub fn fixed(x: f64, decimals: usize) -> String {
    if x.is_finite() { format!("{x:.decimals$}") } else { MISSING.to_owned() }
}

/// A number for a reader: exact if it has few digits, and otherwise with four significant ones.
pub fn short(x: f64) -> String {
    exact_if_short(x).unwrap_or_else(|| significant(x, 4))
}

/// Labels of values that stand side by side: numbers of few digits are exact, and the others have the fewest significant
/// digits, at least three, that keep different values apart and in order.
pub fn labels(values: &[f64]) -> Vec<String> {
    let exact: Vec<String> = values.iter().map(|x| number(*x)).collect();
    let with_digits = |digits: usize| -> Vec<String> {
        values.iter().map(|x| exact_if_short(*x).unwrap_or_else(|| significant(*x, digits))).collect()
    };
    (3..=MOST_DIGITS).map(with_digits).find(|texts| keeps_order(values, texts)).unwrap_or(exact)
}

/// Whether the texts of different values are different numbers in the same order.
fn keeps_order(values: &[f64], texts: &[String]) -> bool {
    let read = |text: &String| text.parse().unwrap_or(f64::NAN);
    let mut pairs: Vec<(f64, f64)> = values.iter().copied().zip(texts.iter().map(read)).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    pairs.windows(2).all(|pair| pair[0].0 == pair[1].0 || pair[0].1 < pair[1].1)
}

/// Largest number of significant digits of a number that is written exactly.
const FEW_DIGITS: usize = 5;
/// So many significant digits tell all floating-point numbers apart.
const MOST_DIGITS: usize = 17;

/// The number in full, if it has few digits without the rounding errors of a computed grid.
fn exact_if_short(x: f64) -> Option<String> {
    let text = significant(x, FEW_DIGITS);
    (text == rounded(x)).then_some(text)
}

/// Multiples of units in which people write quantities: unit, smallest size from which the multiple is used, factor, name.
/// The largest size comes first.
const MULTIPLES: [(&str, f64, f64, &str); 19] = [
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
    ("N/m", 1e6, 1e6, "MN/m"),
    ("N/m", 1e3, 1e3, "kN/m"),
    ("J", 1.0, 1.0, "J"),
    ("J", 1e-4, 1e-3, "mJ"),
    ("J", 0.0, 1e-6, "µJ"),
    ("m/s", 1.0, 1.0, "m/s"),
    ("m/s", 0.0, 1e-3, "mm/s"),
];

/// The multiple of a unit in which a quantity of this size is written: its factor and its name. `("Pa", 5e8)` gives 10⁹
/// and `GPa`.
pub fn multiple(unit: &str, size: f64) -> (f64, &str) {
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

/// A number of things: `1 job`, `2 jobs`, `0 studies`. `noun` is in the singular and may have words before it.
pub fn count<N: Copy + Display + PartialEq + From<u8>>(n: N, noun: &str) -> String {
    let is_one = n == N::from(1);
    let of_several = || match noun.strip_suffix('y') {
        Some(stem) if !stem.ends_with(['a', 'e', 'o', 'u']) => format!("{stem}ies"),
        _ => format!("{noun}s"),
    };
    format!("{n} {}", if is_one { noun.to_owned() } else { of_several() })
}

/// A duration in a unit that fits it; [`MISSING`] if it is not finite.
pub fn duration(seconds: f64) -> String {
    if seconds.is_finite() { duration_text(seconds, 1) } else { MISSING.to_owned() }
}

/// The Gregorian calendar repeats after 400 years, which are so many seconds.
const CALENDAR_PERIOD_S: i64 = 146_097 * 86_400;

/// A time to the minute, from milliseconds since 1970-01-01 UTC: `2026-11-21 23:15 UTC`.
pub fn utc_minute(ms: i64) -> String {
    let (year, rest) = utc(ms);
    format!("{year:04}{} {} UTC", &rest[..6], &rest[7..12])
}

/// A time to the second: `2026-11-21 23:15:04 UTC`.
#[cfg(any(test, feature = "cli"))]
pub fn utc_second(ms: i64) -> String {
    let (year, rest) = utc(ms);
    format!("{year:04}{} {} UTC", &rest[..6], &rest[7..15])
}

/// A time as programs read it (ISO 8601): `2026-11-21T23:15:04.250Z`.
#[cfg(any(test, feature = "cli"))]
pub fn utc_iso(ms: i64) -> String {
    let (year, rest) = utc(ms);
    format!("{year:04}{}.{:03}Z", &rest[..15], ms.rem_euclid(1000))
}

/// The year of a time, and the rest as `-11-21T23:15:04Z`.
fn utc(ms: i64) -> (i64, String) {
    let seconds = ms.div_euclid(1000);
    // humantime knows the years from 1970 to 9999 only. The remainder is in the years 1970 to 2369.
    let (periods, rest) = (seconds.div_euclid(CALENDAR_PERIOD_S), seconds.rem_euclid(CALENDAR_PERIOD_S));
    let time = SystemTime::UNIX_EPOCH + Duration::from_secs(rest.unsigned_abs());
    let text = humantime::format_rfc3339_seconds(time).to_string();
    let year = text[..4].parse::<i64>().unwrap_or_default() + 400 * periods;
    (year, text[4..].to_owned())
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

/// A value for a reader: a number without the rounding errors of a computed grid.
pub fn rounded_value(value: &Value) -> Value {
    match value {
        Value::Number(n) if n.is_f64() => n.as_f64().map_or(Value::Null, |x| significant_number(x, 10)),
        _ => value.clone(),
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

/// As [`sort_numbers`] for the values that are not null; null comes last.
pub fn sort_known(values: &mut Vec<Value>) -> Vec<usize> {
    let unknown = values.iter().position(Value::is_null);
    let null = unknown.map(|at| values.remove(at));
    let mut new_indices = sort_numbers(values);
    if let (Some(at), Some(null)) = (unknown, null) {
        new_indices.insert(at, values.len());
        values.push(null);
    }
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
            (0.002_666_666_666_666_666_6, "m", "2.667 mm"),
            (0.0914, "m", "91.4 mm"),
            (5e-8, "s", "50 ns"),
            (0.04, "s", "40 ms"),
            (15_281.3, "Hz", "15.28 kHz"),
            (0.0, "m", "0 m"),
            (30.0, "N", "30 N"),
            (-0.0012, "J", "-1.2 mJ"),
            (1.425_102_670_3, "K", "1.425 K"),
            (0.4, "", "0.4"),
        ];
        for (x, unit, text) in cases {
            assert_eq!(quantity(x, unit), text);
        }
    }

    /// Protects: a number of things has the singular for one and the plural for every other number.
    #[test]
    fn things_are_counted_in_singular_and_plural() {
        let counted =
            [count(0_u64, "job"), count(1_u64, "pending job"), count(2_usize, "study"), count(2, "day")];
        assert_eq!(counted, ["0 jobs", "1 pending job", "2 studies", "2 days"]);
    }

    /// Protects: labels are as short as they can be and never merge two values. Numbers of few digits stay exact.
    #[test]
    fn labels_are_short_and_distinct() {
        assert_eq!(labels(&[1.0, 1.425_102_670_3, 2.030_917_620_9]), ["1", "1.43", "2.03"]);
        assert_eq!(labels(&[1.424_102_670_3, 1.423_902_670_3]), ["1.4241", "1.4239"]);
        assert_eq!(labels(&[12_345.0, 0.1 + 0.05]), ["12345", "0.15"]);
        assert_eq!(labels(&[1.0 / 3.0, 1.0 / 3.0]), ["0.333", "0.333"]);
        // 1.23 would stand on the wrong side of 1.234.
        assert_eq!(labels(&[1.234, 1.234_123_45]), ["1.234", "1.2341"]);
        let neighbours = [1.0f64 / 3.0, (1.0f64 / 3.0).next_up()];
        let found = labels(&neighbours);
        assert_ne!(found[0], found[1]);
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
        assert_eq!(utc_second(1_798_761_599_999), "2026-12-31 23:59:59 UTC");
        assert_eq!(utc_iso(1_798_761_599_999), "2026-12-31T23:59:59.999Z");
        assert_eq!(utc_iso(-1), "1969-12-31T23:59:59.999Z");
    }
}

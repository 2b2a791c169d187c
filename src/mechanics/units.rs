//! Units: those at the ends of names, conversions to SI, and durations in units for a reader. Texts of strangers, as a terminal may
//! show them.

use serde::Serializer;
use std::borrow::Cow;
use std::f64::consts::PI;
use std::time::Duration;

/// Angular speed [rad/s] of `omega_rpm` revolutions per minute.
pub fn rad_per_s_from_rpm(omega_rpm: f64) -> f64 {
    omega_rpm * (2.0 * PI / 60.0)
}

/// The endings of names that are units. Longer endings come first.
const ENDINGS: [(&str, &str); 20] = [
    ("_nm_s_rad", "N m s/rad"),
    ("_nm_rad", "N m/rad"),
    ("_kg_m3", "kg/m³"),
    ("_kg_m2", "kg m²"),
    ("_n_s_m", "N s/m"),
    ("_n_m", "N/m"),
    ("_pa_m", "Pa/m"),
    ("_s_m", "s/m"),
    ("_per_s", "1/s"),
    ("_m_s2", "m/s²"),
    ("_m_s", "m/s"),
    ("_rpm", "rpm"),
    ("_deg", "°"),
    ("_pa", "Pa"),
    ("_hz", "Hz"),
    ("_kg", "kg"),
    ("_n", "N"),
    ("_m", "m"),
    ("_s", "s"),
    ("_j", "J"),
];

/// A name without its unit, and the unit; empty if the name has none. Every name of a number with a unit ends with it: this is the only
/// place that says which unit a field, a parameter or a quantity has.
pub const fn name_and_unit(name: &str) -> (&str, &'static str) {
    let mut number = 0;
    while number < ENDINGS.len() {
        let (ending, unit) = ENDINGS[number];
        if let Some(stem) = without_ending(name, ending.as_bytes()) {
            return (stem, unit);
        }
        number += 1;
    }
    (name, "")
}

/// What is before the ending. Constants need the unit of a name, and the methods of texts are not for constants.
const fn without_ending<'a>(name: &'a str, ending: &[u8]) -> Option<&'a str> {
    let Some(start) = name.len().checked_sub(ending.len()) else { return None };
    let mut at = 0;
    while at < ending.len() {
        if name.as_bytes()[start + at] != ending[at] {
            return None;
        }
        at += 1;
    }
    Some(name.split_at(start).0)
}

/// A duration of so many seconds for a reader, in the unit that fits it: `350 ms`, `12.5 s`, `3.8 min`, `2.5 h`,
/// `4.0 days`.
///
/// `decimals` is the number of decimals of seconds and minutes. Without decimals the smallest unit is the second: this
/// is for estimates. Hours and days always have one decimal.
pub fn duration_text(seconds: f64, decimals: usize) -> String {
    match seconds {
        s if s < 0.9995 && decimals > 0 => format!("{:.0} ms", s * 1e3),
        s if s < 120.0 => format!("{s:.decimals$} s"),
        s if s < 7200.0 => format!("{:.decimals$} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86_400.0),
    }
}

/// A duration as a number of seconds, for [`serde`].
///
/// # Errors
/// Those of the serializer.
pub fn as_seconds<S: Serializer>(duration: &Duration, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_f64(duration.as_secs_f64())
}

/// Whether a terminal may do something else with the character than show it: control characters, which begin escape sequences,
/// and those that change the direction of text or break lines.
fn is_unsafe(c: char) -> bool {
    let turns_text =
        matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns_text || matches!(c, '\u{2028}' | '\u{2029}' | '\u{feff}')
}

/// The text on one line, in which characters that a terminal would obey are written as `\u{1b}`.
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, is_unsafe)
}

/// As [`printable`], for a text of several lines, which keep their breaks and tabs.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |c| is_unsafe(c) && !matches!(c, '\n' | '\t'))
}

fn escaped(text: &str, is_unsafe: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&is_unsafe) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_unsafe(c) { escaped.extend(c.escape_unicode()) } else { escaped.push(c) }
    }
    Cow::Owned(escaped)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the longest unit at the end of a name is its unit, and a name without a unit stays as it is.
    #[test]
    fn units_are_at_the_ends_of_names() {
        let cases = [
            ("slip_speed_max_m_s", ("slip_speed_max", "m/s")),
            ("growth_rate_per_s", ("growth_rate", "1/s")),
            ("inertia_x_kg_m2", ("inertia_x", "kg m²")),
            ("omega_rpm", ("omega", "rpm")),
            ("μ_s", ("μ", "s")),
            ("mu_star", ("mu_star", "")),
            ("s", ("s", "")),
        ];
        for (name, parts) in cases {
            assert_eq!(name_and_unit(name), parts);
        }
    }

    /// Protects: every duration is in the unit that a reader expects, with and without decimals.
    #[test]
    fn durations_are_in_the_unit_that_fits() {
        let exact = [0.35, 12.5, 228.0, 9000.0, 345_600.0].map(|seconds| duration_text(seconds, 1));
        assert_eq!(exact, ["350 ms", "12.5 s", "3.8 min", "2.5 h", "4.0 days"]);
        let rough = [0.0, 40.2, 228.0, 9000.0].map(|seconds| duration_text(seconds, 0));
        assert_eq!(rough, ["0 s", "40 s", "4 min", "2.5 h"]);
    }

    /// Protects: no escape sequence and no change of direction reaches a terminal, and other text is not changed.
    #[test]
    fn nothing_is_left_that_a_terminal_obeys() {
        assert_eq!(printable("\u{1b}]0;owned\u{7}mu"), "\\u{1b}]0;owned\\u{7}mu");
        assert_eq!(printable("a\u{202e}b\u{9b}31m\nc"), "a\\u{202e}b\\u{9b}31m\\u{a}c");
        assert_eq!(printable_lines("a\r\n\tb\u{2066}"), "a\\u{d}\n\tb\\u{2066}");
        for plain in ["μ* = 0.3 ± 0.1 °", "häßlich 測試"] {
            assert!(matches!(printable(plain), Cow::Borrowed(text) if text == plain));
        }
    }
}

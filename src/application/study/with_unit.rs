//! Numbers that are written with a unit: `"8 mm"`, `"5 kN/mm"`, `"300 rpm"`.
//!
//! A name ends with the unit of its number ([`name_and_unit`]). A text with another unit of the same kind becomes a number in that
//! unit before anything else reads it, so that a job and its key are the same in whatever unit they were written.

use super::error::Problem;
use super::locate::join;
use super::source::SourceText;
use crate::units::name_and_unit;
use serde_json::Value;
use std::f64::consts::PI;

/// Powers of mass, length, time and angle.
type Dimension = [i32; 4];

/// A unit in terms of kg, m, s and rad.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Unit {
    dimension: Dimension,
    /// What the unit is apart from a power of ten.
    factor: f64,
    /// The power of ten.
    exponent: i32,
}

const ONE: Unit = Unit { dimension: [0; 4], factor: 1.0, exponent: 0 };

/// Texts with a number and a unit, as a JSON schema describes them. The units are checked by the program alone.
pub(super) const PATTERN: &str = "^[+-]?[0-9.]+([eE][+-]?[0-9]+)? *(1/|[^0-9+., -]).*$";

/// What has no unit of its own in the table is a power of ten of one that has.
const PREFIXES: [(&str, i32); 10] = [
    ("G", 9),
    ("M", 6),
    ("k", 3),
    ("h", 2),
    ("d", -1),
    ("c", -2),
    ("m", -3),
    ("µ", -6),
    ("u", -6),
    ("n", -9),
];

/// A unit by its name, and whether it may have a prefix.
#[rustfmt::skip]
const UNITS: [(&str, Unit, bool); 19] = [
    ("m", Unit { dimension: [0, 1, 0, 0], factor: 1.0, exponent: 0 }, true),
    ("g", Unit { dimension: [1, 0, 0, 0], factor: 1.0, exponent: -3 }, true),
    ("t", Unit { dimension: [1, 0, 0, 0], factor: 1.0, exponent: 3 }, false),
    ("s", Unit { dimension: [0, 0, 1, 0], factor: 1.0, exponent: 0 }, true),
    ("min", Unit { dimension: [0, 0, 1, 0], factor: 60.0, exponent: 0 }, false),
    ("h", Unit { dimension: [0, 0, 1, 0], factor: 3600.0, exponent: 0 }, false),
    ("N", Unit { dimension: [1, 1, -2, 0], factor: 1.0, exponent: 0 }, true),
    ("Nm", Unit { dimension: [1, 2, -2, 0], factor: 1.0, exponent: 0 }, true),
    ("Ns", Unit { dimension: [1, 1, -1, 0], factor: 1.0, exponent: 0 }, true),
    ("J", Unit { dimension: [1, 2, -2, 0], factor: 1.0, exponent: 0 }, true),
    ("Pa", Unit { dimension: [1, -1, -2, 0], factor: 1.0, exponent: 0 }, true),
    ("bar", Unit { dimension: [1, -1, -2, 0], factor: 1.0, exponent: 5 }, true),
    ("Hz", Unit { dimension: [0, 0, -1, 0], factor: 1.0, exponent: 0 }, true),
    ("rad", Unit { dimension: [0, 0, 0, 1], factor: 1.0, exponent: 0 }, true),
    ("°", Unit { dimension: [0, 0, 0, 1], factor: PI / 180.0, exponent: 0 }, false),
    ("deg", Unit { dimension: [0, 0, 0, 1], factor: PI / 180.0, exponent: 0 }, false),
    ("rpm", Unit { dimension: [0, 0, -1, 1], factor: 2.0 * PI / 60.0, exponent: 0 }, false),
    ("rev", Unit { dimension: [0, 0, 0, 1], factor: 2.0 * PI, exponent: 0 }, false),
    ("U", Unit { dimension: [0, 0, 0, 1], factor: 2.0 * PI, exponent: 0 }, false),
];

impl Unit {
    /// The unit of a text such as `kN/mm`, `kg/m³` or `N s/m`; the part of the text that is no unit, if there is one.
    fn parse(text: &str) -> Result<Self, &str> {
        let mut unit = ONE;
        for (place, part) in text.split('/').enumerate() {
            let sign = if place == 0 { 1 } else { -1 };
            let names: Vec<&str> =
                part.split([' ', '·', '*', '\u{a0}']).filter(|name| !name.is_empty()).collect();
            match names[..] {
                [] => return Err(text),
                // Behind it, a divisor follows.
                ["1"] if place == 0 && part.len() < text.len() => {}
                _ => {
                    for name in names {
                        unit = unit.times(Self::power(name).ok_or(name)?, sign);
                    }
                }
            }
        }
        Ok(unit)
    }

    /// A unit with a whole exponent, such as `mm`, `m3`, `m^3` or `m³`.
    fn power(text: &str) -> Option<Self> {
        let (name, power) = if let Some(name) = text.strip_suffix('²') {
            (name, 2)
        } else if let Some(name) = text.strip_suffix('³') {
            (name, 3)
        } else if let Some(at) = text.find(['2', '3']).filter(|at| at + 1 == text.len()) {
            (text[..at].trim_end_matches('^'), if text.ends_with('2') { 2 } else { 3 })
        } else {
            (text, 1)
        };
        Some(ONE.times(Self::named(name)?, power))
    }

    fn named(name: &str) -> Option<Self> {
        let find = |name: &str| UNITS.iter().find(|(own, ..)| *own == name);
        // The Greek letter looks like the sign of micro.
        let name = name.replace('μ', "µ");
        if let Some((_, unit, _)) = find(&name) {
            return Some(*unit);
        }
        PREFIXES.iter().find_map(|(prefix, exponent)| {
            let (_, unit, _) = find(name.strip_prefix(prefix)?).filter(|(.., has_prefixes)| *has_prefixes)?;
            Some(Self { exponent: unit.exponent + exponent, ..*unit })
        })
    }

    fn times(self, other: Self, power: i32) -> Self {
        Self {
            dimension: std::array::from_fn(|at| self.dimension[at] + power * other.dimension[at]),
            factor: self.factor * other.factor.powi(power),
            exponent: self.exponent + power * other.exponent,
        }
    }
}

/// The longest text of a number with a unit \[byte\]. A longer one is quoted in part by the message about its type.
const LONGEST: usize = 64;

/// The number in `unit` that a text means. Returns `None` if it is no number with something behind it.
fn number(text: &str, unit: &str) -> Option<Result<f64, String>> {
    let (digits, given) =
        parts(text.trim()).filter(|_| text.len() <= LONGEST && !text.contains(char::is_control))?;
    Some(convert(digits, given, unit))
}

/// A number and what is behind it. Returns `None` if that cannot be a unit.
fn parts(text: &str) -> Option<(&str, &str)> {
    let is_of_number = |c: char| c.is_ascii_digit() || "+-.,".contains(c);
    let mut end = text.find(|c: char| !is_of_number(c)).unwrap_or(text.len());
    if let Some(exponent) = text[end..].strip_prefix(['e', 'E']) {
        let sign = usize::from(exponent.starts_with(['+', '-']));
        let digits = exponent[sign..].bytes().take_while(u8::is_ascii_digit).count();
        end += if digits > 0 { 1 + sign + digits } else { 0 };
    }
    let (digits, rest) = text.split_at(end);
    let rest = rest.trim();
    let is_unit = rest.starts_with(|c: char| c.is_alphabetic() || c == '°') || rest.starts_with("1/");
    (is_unit && digits.bytes().any(|byte| byte.is_ascii_digit())).then_some((digits, rest))
}

fn convert(digits: &str, given: &str, unit: &str) -> Result<f64, String> {
    if digits.contains(',') {
        return Err(format!("a number has a decimal point: {} {given}", digits.replacen(',', ".", 1)));
    }
    let wanted = Unit::parse(unit).map_err(|_| format!("expected a number in {unit}"))?;
    let found = Unit::parse(given).map_err(|name| {
        format!("`{name}` is no known unit; expected a number in {unit}, or in a unit of the same kind")
    })?;
    let mut dimension = found.dimension;
    // Revolutions per time are written without their angle.
    let turns = if unit == "rpm" && dimension == [0, 0, -1, 0] {
        dimension = wanted.dimension;
        2.0 * PI
    } else {
        1.0
    };
    if dimension != wanted.dimension {
        let hint = if unit == "rpm" && dimension == [0, 1, -1, 0] {
            "; a study has the field sliding_speed_m_s for a sliding speed"
        } else {
            ""
        };
        return Err(format!(
            "`{given}` is another kind of unit; expected a number in {unit}, or in a unit of that kind{hint}"
        ));
    }
    let (mantissa, own) = digits.split_once(['e', 'E']).unwrap_or((digits, "0"));
    let shift = own.parse::<i32>().ok().map(|own| own.saturating_add(found.exponent - wanted.exponent));
    // The exponent is changed in the text: so 0.3 mm is the same number as 0.0003.
    let number = shift.and_then(|shift| format!("{mantissa}e{shift}").parse::<f64>().ok());
    let ratio = turns * found.factor / wanted.factor;
    // Rounding to 15 digits makes 4.1 Hz the same number as 246 rpm.
    let rounded = |number: f64| format!("{:.14e}", number * ratio).parse().unwrap_or(f64::NAN);
    let number = number.map(|number| if ratio == 1.0 { number } else { rounded(number) });
    number
        .filter(|number| number.is_finite())
        .ok_or_else(|| format!("`{digits}` is no number; expected one in {unit}"))
}

/// Replaces every text with a unit in `value` by its number, and adds paths and messages of those that are wrong to `refused`. `unit` is
/// that of the name under which the value stands.
fn replace(value: &mut Value, unit: &str, path: &str, refused: &mut Vec<(String, String)>) {
    match value {
        Value::Object(fields) => {
            // The first column of a program's table is a time, whatever the second one is.
            for (name, inner) in fields.iter_mut().filter(|(name, _)| *name != "program") {
                let own = name_and_unit(name).1;
                // The ends of a range have the unit of its parameter.
                replace(inner, if own.is_empty() { unit } else { own }, &join(path, name), refused);
            }
        }
        Value::Array(items) => {
            for (index, item) in items.iter_mut().enumerate().filter(|(_, item)| !item.is_number()) {
                replace(item, unit, &format!("{path}[{index}]"), refused);
            }
        }
        Value::String(text) if !unit.is_empty() => match number(text, unit) {
            Some(Ok(number)) => *value = number.into(),
            Some(Err(message)) => refused.push((path.to_owned(), message)),
            None => {}
        },
        _ => {}
    }
}

/// Makes numbers of all texts with units in a study.
pub(super) fn in_study(value: &mut Value, source: &SourceText) -> Vec<Problem> {
    let mut refused = Vec::new();
    replace(value, "", "", &mut refused);
    let mut problems: Vec<Problem> =
        refused.into_iter().map(|(path, message)| source.problem(&path, message)).collect();
    problems.sort_by_key(|problem| problem.position);
    problems
}

/// Makes numbers of the texts with units in the value or the values of a parameter.
///
/// # Errors
/// What is wrong with the first one that is wrong.
pub(super) fn in_setting(value: &mut Value, unit: &str) -> Result<(), String> {
    let mut refused = Vec::new();
    replace(value, unit, "", &mut refused);
    refused.into_iter().next().map_or(Ok(()), |(_, message)| Err(message))
}

/// A number from a text that may have a unit, in `unit`.
///
/// # Errors
/// What is wrong with the text.
pub fn number_in(text: &str, unit: &str) -> Result<f64, String> {
    let mut value = serde_json::from_str(text).unwrap_or_else(|_| Value::from(text));
    in_setting(&mut value, unit)?;
    value
        .as_f64()
        .ok_or_else(|| format!("expected a number in {unit}, or one with another unit of the same kind"))
}

#[cfg(test)]
mod tests {
    use super::number;
    use crate::study::PARAMETERS;

    fn found(text: &str, unit: &str) -> f64 {
        number(text, unit)
            .unwrap_or_else(|| panic!("{text}: no unit"))
            .unwrap_or_else(|why| panic!("{text}: {why}"))
    }

    /// Protects: a number with another unit has the bits of the same number written in the unit of its name.
    #[test]
    fn decimal_units_change_no_bit() {
        for (text, unit, expected) in [
            ("8 mm", "m", 0.008),
            ("0.3mm", "m", 0.0003),
            ("17.3 µm", "m", 17.3e-6),
            ("17.3 μm", "m", 17.3e-6),
            ("17.3 um", "m", 17.3e-6),
            ("5 kN/mm", "N/m", 5.0e6),
            ("5e3 N/mm", "N/m", 5.0e6),
            ("2.7 GPa", "Pa", 2.7e9),
            ("2700 N/mm²", "Pa", 2.7e9),
            ("1.19 g/cm³", "kg/m³", 1190.0),
            ("1.19 g/cm^3", "kg/m³", 1190.0),
            ("1.19 t/m3", "kg/m³", 1190.0),
            ("80 g", "kg", 0.08),
            ("0.5 µs", "s", 0.5e-6),
            ("12.5 kHz", "Hz", 12_500.0),
            ("3 N s/m", "N s/m", 3.0),
            ("3 Ns/m", "N s/m", 3.0),
            ("40 Nm/rad", "N m/rad", 40.0),
            ("2 kg mm²", "kg m²", 2.0e-6),
            ("10 N/mm³", "Pa/m", 1.0e10),
            ("300 rpm", "rpm", 300.0),
            ("1e-1 mm/s", "m/s", 1.0e-4),
        ] {
            assert_eq!(found(text, unit).to_bits(), f64::to_bits(expected), "{text}");
        }
    }

    /// Protects: a speed or a time in other units has the bits of the decimal number that it is.
    #[test]
    fn revolutions_and_times_are_decimal_numbers() {
        for thousandths in 1..5000 {
            let hz = format!("{}.{:03}", thousandths / 1000, thousandths % 1000);
            let rpm = format!("{}.{:02}", thousandths * 60 / 1000, thousandths * 60 % 1000 / 10);
            let rpm: f64 = rpm.parse().unwrap();
            assert_eq!(found(&format!("{hz} Hz"), "rpm"), rpm, "{hz} Hz");
            assert_eq!(found(&format!("{hz} rev/s"), "rpm"), rpm, "{hz} rev/s");
            assert_eq!(found(&format!("{hz} min"), "s"), rpm, "{hz} min");
        }
        assert_eq!(found("90 °/s", "rpm"), 15.0);
    }

    /// Protects: angles, times and speeds of rotation are converted, to the rounding to 15 digits.
    #[test]
    fn other_units_are_converted() {
        for (text, unit, expected) in [
            ("5 Hz", "rpm", 300.0),
            ("300 1/min", "rpm", 300.0),
            ("5 rev/s", "rpm", 300.0),
            ("31.41592653589793 rad/s", "rpm", 300.0),
            ("2 min", "s", 120.0),
            ("0.5 rad", "°", 28.647_889_756_541_16),
        ] {
            let number = found(text, unit);
            assert!((number / expected - 1.0).abs() <= 1.0e-14, "{text}: {number}");
        }
    }

    /// Protects: a unit of another kind, an unknown one and a decimal comma are refused in words; what has no unit is left to others.
    #[test]
    fn wrong_units_are_refused() {
        for (text, unit, expected) in [
            ("8 kg", "m", "`kg` is another kind of unit; expected a number in m"),
            ("8 furlong", "m", "`furlong` is no known unit; expected a number in m"),
            ("0.1 m/s", "rpm", "sliding_speed_m_s for a sliding speed"),
            ("8,5 mm", "m", "a number has a decimal point: 8.5 mm"),
            ("8 m/", "m", "no known unit"),
            ("30 N/12", "N", "`12` is no known unit"),
            ("30 N 13", "N", "`13` is no known unit"),
            ("8 mm 1", "m", "`1` is no known unit"),
            ("8 kN %", "N", "`%` is no known unit"),
            ("1.2.3 mm", "m", "is no number"),
            ("1e999 mm", "m", "is no number"),
        ] {
            let message = number(text, unit).unwrap().unwrap_err();
            assert!(message.contains(expected), "{text}: {message}");
        }
        for text in ["", "mm", "8", "0,3", "0.2, 0.3", "50:400", "e3", "-"] {
            assert_eq!(number(text, "m"), None, "{text}");
        }
    }

    /// Protects: every unit at the end of a parameter's name is one that numbers can be written with.
    #[test]
    fn every_unit_of_a_parameter_is_known() {
        for parameter in PARAMETERS.iter().filter(|parameter| !parameter.unit.is_empty()) {
            assert_eq!(found(&format!("2.5 {}", parameter.unit), parameter.unit), 2.5, "{}", parameter.name);
        }
    }
}

//! What the header of a column of measured points means, if it is no name of the program.

use crate::study::misspelt_name;
use crate::units::name_and_unit;

/// What people write above columns of measured points. Their letters differ in case: F is a force, and a bare n may count anything.
#[rustfmt::skip]
const SYMBOLS: [(&str, &[&str]); 3] = [
    ("omega_rpm", &["n [rpm]", "n (rpm)", "n / rpm", "n/rpm", "n in rpm"]),
    ("frequency_hz", &["f", "Freq", "freq", "FREQ", "frequency", "Frequency", "f_hz", "f_Hz"]),
    ("mu_star", &["μ*", "µ*", "mu*", "cof", "COF", "CoF", "friction", "friction_coefficient", "coefficient of friction"]),
];

/// The field of a study for the speed of sliding, which is no column: only a scene knows the radius.
const SPEED: &str = "sliding_speed_m_s";

/// A name without the unit behind it: `n [rpm]`, `f / Hz`, `F in N`.
fn without_unit(name: &str) -> &str {
    let name = name.split(['[', '(', '/']).next().unwrap_or(name);
    name.split(" in ").next().unwrap_or(name).trim()
}

/// The name that a header means, if it means one.
fn meant_name<'a>(name: &str, known: &'a [String]) -> Option<&'a str> {
    let bare = without_unit(name);
    let symbol = SYMBOLS
        .iter()
        .find(|(_, symbols)| [bare, name].iter().any(|name| symbols.contains(name)))
        .map(|(name, _)| *name);
    let known = || known.iter().map(String::as_str);
    symbol
        .and_then(|symbol| known().find(|name| *name == symbol))
        .or_else(|| misspelt_name(name, known()))
        .or_else(|| misspelt_name(bare, known()))
}

/// The question whether a header means one of the `known` names. Returns `None` if it is like none of them.
pub(super) fn suggestion(name: &str, known: &[String]) -> Option<String> {
    // The error stands before the unit: `omega_rpm_error` is `omega_error_rpm`.
    let of_error = name.strip_suffix("_error").map(|own| {
        let stem = name_and_unit(own).0;
        format!("{stem}_error{}", &own[stem.len()..])
    });
    if let Some(meant) = of_error.filter(|own| known.contains(own) && own != name) {
        return Some(format!("did you mean `{meant}`?"));
    }
    let meant = meant_name(name, known)?;
    let unit = name_and_unit(meant).1;
    let help = if meant == "omega_rpm" && misspelt_name(without_unit(name), [SPEED]) == Some(SPEED) {
        "\n  help: ω [rpm] = 60 v / (2π R), with v in m/s and the radius R of the track in m".to_owned()
    } else if without_unit(name) == name || unit.is_empty() {
        String::new()
    } else {
        format!("\n  help: the numbers of `{meant}` are in {unit}")
    };
    Some(format!("did you mean `{meant}`?{help}"))
}

#[cfg(test)]
mod tests {
    use super::suggestion;

    /// Protects: headers as instruments write them lead to the name that they mean, with its unit, and a column of the author's own leads
    /// to none.
    #[test]
    fn headers_lead_to_names() {
        let known = ["omega_rpm", "load_n", "mu", "mu_star", "frequency_hz"].map(str::to_owned);
        for (header, name, unit) in [
            ("rpm", "omega_rpm", None),
            ("n [rpm]", "omega_rpm", Some("rpm")),
            ("n / rpm", "omega_rpm", Some("rpm")),
            ("F (N)", "load_n", Some("N")),
            ("F [kN]", "load_n", Some("N")),
            ("f [Hz]", "frequency_hz", Some("Hz")),
            ("f / Hz", "frequency_hz", Some("Hz")),
            ("COF", "mu_star", None),
            ("μ*", "mu_star", None),
            ("\u{b5}", "mu", None),
        ] {
            let help = unit
                .map_or_else(String::new, |unit| format!("\n  help: the numbers of `{name}` are in {unit}"));
            assert_eq!(suggestion(header, &known), Some(format!("did you mean `{name}`?{help}")), "{header}");
        }
        for speed in ["sliding_speed_m_s", "v [m/s]", "v (m/s)"] {
            let words = suggestion(speed, &known).unwrap_or_default();
            assert!(
                words.starts_with("did you mean `omega_rpm`?\n  help: ω [rpm] = 60 v"),
                "{speed}: {words}"
            );
        }
        for own in ["N", "n", "Bemerkung", "temperature [°C]"] {
            assert_eq!(suggestion(own, &known), None, "{own}");
        }
    }
}

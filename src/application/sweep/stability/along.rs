//! The parameters along which thresholds can be looked for, and the one that is chosen.

use crate::report::Along;
use crate::study::{Growth, Refine, Study};
use crate::sweep::growth::along;

/// The parameters of the friction coefficient and of the speed.
const MU: &str = "mu";
const OMEGA: &str = "omega_rpm";

/// All ways along which a study can have thresholds, the most natural one first: μ, then other parameters but ω in the order of the
/// file, then ω. A parameter of a zip is one way with all that move with it.
pub fn ways(study: &Study) -> Vec<Along> {
    let mut ways = Vec::new();
    for (parameter, values) in study.axes() {
        if parameter.is_continuous() && values.len() > 1 {
            ways.push(along(study, parameter.name));
        }
    }
    let zipped: Vec<&str> = study.zipped().iter().map(|parameter| parameter.name).collect();
    for parameter in study.zipped().iter().filter(|parameter| parameter.is_continuous()) {
        // Beside ω or μ the others are read along it.
        let leads = [MU, OMEGA].contains(&parameter.name);
        if leads || ![MU, OMEGA].iter().any(|name| zipped.contains(name)) {
            ways.push(along(study, parameter.name));
        }
    }
    ways.sort_by_key(|along| match along.parameter.as_str() {
        MU => 0,
        OMEGA => 2,
        _ => 1,
    });
    ways
}

/// The way that thresholds of a stored study have been looked for, or the most natural one; μ if the study varies no number.
pub fn way_of(study: &Study) -> Along {
    if let Growth { refine: Some(Refine { boundaries: Some(own), .. }), .. } = study.growth() {
        return along(study, &own.over);
    }
    ways(study).into_iter().next().unwrap_or_else(Along::mu)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn study(text: &str) -> Study {
        Study::parse(&format!("{{ \"name\": \"s\", {text} }}"), "s.json").unwrap()
    }

    fn names(text: &str) -> Vec<String> {
        ways(&study(text)).into_iter().map(|along| along.parameter).collect()
    }

    /// Protects: thresholds are those of what a study varies: μ before all, ω after all, whole numbers and single values never, and of
    /// points without an order there are none.
    #[test]
    fn thresholds_are_those_of_what_is_varied() {
        let all = r#""grid": { "omega_rpm": [5, 7], "young_modulus_pa": [1e9, 2e9], "nx": [3, 4], "mu": [0.1, 0.2] }"#;
        assert_eq!(names(all), ["mu", "young_modulus_pa", "omega_rpm"]);
        assert_eq!(names(r#""grid": { "omega_rpm": [5, 7], "mu": [0.1] }"#), ["omega_rpm"]);
        assert_eq!(names(r#""samples": { "points": [{ "mu": 0.1 }, { "mu": 0.3 }] }"#), [""; 0]);
        assert_eq!(way_of(&study(r#""grid": { "nx": [3, 4] }"#)), Along::mu());
    }

    /// Protects: a parameter of a zip is a way with all that move with it; beside μ and ω the others are read along these.
    #[test]
    fn a_zip_is_one_way() {
        let zip = study(r#""samples": { "zip": { "mu": [0.1, 0.3], "load_n": [10, 30] } }"#);
        let [along] = &ways(&zip)[..] else { panic!("one way") };
        assert_eq!((along.parameter.as_str(), along.with.as_slice()), ("mu", &["load_n".to_owned()][..]));
        let both = r#""samples": { "zip": { "mu": [0.1, 0.3], "omega_rpm": [5, 7], "load_n": [10, 30] } }"#;
        assert_eq!(names(both), ["mu", "omega_rpm"]);
        assert_eq!(ways(&study(both))[1].with, ["mu", "load_n"]);
    }
}

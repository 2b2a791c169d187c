//! The parameters along which thresholds can be looked for, and the one that is chosen.

use crate::report::{Along, Parameters};
use crate::study::{Job, Study};
use serde_json::Value;

/// The parameters of the friction coefficient and of the speed.
const MU: &str = "mu";
const OMEGA: &str = "omega_rpm";

/// All ways along which a study can have thresholds, the most natural one first: μ, then other parameters but ω in the order of the
/// file, then ω. A parameter of a zip is one way with all that move with it.
pub fn ways(study: &Study) -> Vec<Along> {
    let mut ways = Vec::new();
    for (parameter, values) in study.axes() {
        if parameter.is_continuous() && has_two(values) {
            ways.push(Along { parameter: parameter.name.to_owned(), with: Vec::new() });
        }
    }
    let zipped: Vec<&str> = study.zipped().iter().map(|parameter| parameter.name).collect();
    for parameter in study.zipped().iter().filter(|parameter| parameter.is_continuous()) {
        // Beside ω or μ the others are read along it.
        let leads = [MU, OMEGA].contains(&parameter.name);
        if leads || ![MU, OMEGA].iter().any(|name| zipped.contains(name)) {
            let with = zipped.iter().filter(|name| **name != parameter.name);
            let with = with.map(|name| (*name).to_owned()).collect();
            ways.push(Along { parameter: parameter.name.to_owned(), with });
        }
    }
    ways.sort_by_key(|along| match along.parameter.as_str() {
        MU => 0,
        OMEGA => 2,
        _ => 1,
    });
    ways
}

/// The way that thresholds of a stored study have been looked for; μ if the study varies no number.
pub fn natural(study: &Study) -> Along {
    ways(study).into_iter().next().unwrap_or_else(Along::mu)
}

fn has_two(values: &[Value]) -> bool {
    values.iter().any(|value| *value != values[0])
}

/// What all points of a series share: every parameter that does not move along it.
pub fn rest(along: &Along, parameters: &Parameters) -> Vec<(String, Value)> {
    let rest = parameters.iter().filter(|(name, _)| !along.moves(name));
    rest.map(|(name, value)| (name.to_owned(), value.clone())).collect()
}

/// The value along it of a job or a row with these parameters.
pub fn position(along: &Along, parameters: &Parameters) -> Option<f64> {
    parameters.get(&along.parameter)?.as_f64()
}

/// The values of the parameters at a place of the series of these grid jobs, which are sorted by their place. Parameters that move
/// together keep doing so: between two points each of them has its share of the way. None outside of theirs, and where one of them
/// has no values in between.
pub fn parameters_at(along: &Along, anchors: &[(f64, &Job)], x: f64) -> Option<Vec<(String, Value)>> {
    if along.with.is_empty() {
        let (_, job) = anchors.first()?;
        let others = job.parameters.iter().filter(|(name, _)| *name != along.parameter);
        let mut parameters: Vec<(String, Value)> = others.cloned().collect();
        let place = job.parameters.iter().position(|(name, _)| *name == along.parameter);
        parameters.insert(place.unwrap_or(0), (along.parameter.clone(), x.into()));
        return Some(parameters);
    }
    let above = anchors.iter().position(|(at, _)| *at >= x)?;
    let (high, upper) = anchors[above];
    let (low, lower) = anchors[above.saturating_sub(1)];
    if x < low {
        return None;
    }
    let share = if high > low { (x - low) / (high - low) } else { 0.0 };
    let moved = |((name, from), (_, to)): (&(String, Value), &(String, Value))| {
        let value = if *name == along.parameter {
            x.into()
        } else if !along.moves(name) || from == to {
            from.clone()
        } else if x == high {
            to.clone()
        } else {
            let (from, to) = (from.as_f64()?, to.as_f64()?);
            (from + share * (to - from)).into()
        };
        Some((name.clone(), value))
    };
    lower.parameters.iter().zip(&upper.parameters).map(moved).collect()
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
        assert_eq!(natural(&study(r#""grid": { "nx": [3, 4] }"#)), Along::mu());
    }

    /// Protects: the values of a zip move together, and so do those of a point in between: none belongs to another problem. Outside of
    /// the list there is no point, and its points themselves keep their values.
    #[test]
    fn a_zip_moves_together() {
        let study = study(
            r#""samples": { "zip": { "mu": [0.1, 0.3], "load_n": [10, 30] } }, "grid": { "omega_rpm": [7] }"#,
        );
        let [along] = &ways(&study)[..] else { panic!("one way") };
        assert_eq!((along.parameter.as_str(), along.with.as_slice()), ("mu", &["load_n".to_owned()][..]));
        let jobs = study.expand("v").unwrap();
        let anchors: Vec<(f64, &Job)> = jobs.iter().map(|job| (job.spec.scene.contact.mu, job)).collect();
        let at = |x: f64| {
            let job = study.job_at(&parameters_at(along, &anchors, x)?, "v")?;
            Some((job.spec.scene.contact.mu, job.spec.scene.load.force_n, job.key))
        };
        let (mu, force_n, _) = at(0.15).unwrap();
        assert!(mu == 0.15 && (force_n - 15.0).abs() < 1.0e-12, "{force_n}");
        assert_eq!(at(0.3).unwrap(), (0.3, 30.0, jobs[1].key.clone()));
        assert_eq!((at(0.05), at(0.31)), (None, None));
        let both = r#""samples": { "zip": { "mu": [0.1, 0.3], "omega_rpm": [5, 7], "load_n": [10, 30] } }"#;
        assert_eq!(names(both), ["mu", "omega_rpm"]);
        assert_eq!(ways(&self::study(both))[1].with, ["mu", "load_n"]);
    }

    /// Protects: a zip may have a value twice, with others that differ. All its points stay, and a point in between is between its neighbours
    /// of the list.
    #[test]
    fn a_value_of_a_zip_may_be_there_twice() {
        let zips =
            [("[0.1, 0.3, 0.3, 0.5]", "[10, 30, 50, 70]"), ("[0.5, 0.3, 0.3, 0.1]", "[70, 50, 30, 10]")];
        for (mu, load_n) in zips {
            let study = study(&format!(r#""samples": {{ "zip": {{ "mu": {mu}, "load_n": {load_n} }} }}"#));
            let [along] = &ways(&study)[..] else { panic!("one way") };
            let jobs = study.expand("v").unwrap();
            let mut anchors: Vec<(f64, &Job)> =
                jobs.iter().map(|job| (job.spec.scene.contact.mu, job)).collect();
            Along::sort(&mut anchors, |_| true);
            let load_n = |x: f64| {
                let parameters = parameters_at(along, &anchors, x).unwrap();
                parameters.iter().find(|(name, _)| name == "load_n").unwrap().1.as_f64().unwrap()
            };
            let found = [0.1, 0.2, 0.4, 0.5].map(load_n);
            for (found, expected) in found.into_iter().zip([10.0, 20.0, 60.0, 70.0]) {
                assert!((found - expected).abs() < 1.0e-9, "{mu}: {found}, not {expected}");
            }
        }
    }

    /// Protects: a series is what differs along the way alone.
    #[test]
    fn the_rest_is_what_does_not_move() {
        let along = Along { parameter: "force_n".to_owned(), with: vec!["mu".to_owned()] };
        let parameters = [("mu", 0.2), ("force_n", 30.0), ("young_modulus_pa", 1.0e9)];
        let parameters = parameters.map(|(name, value)| (name.to_owned(), Value::from(value)));
        let own = rest(&along, &Parameters::new(7.0, 0.2, parameters.into()));
        let expected = [("omega_rpm", 7.0), ("young_modulus_pa", 1.0e9)];
        assert_eq!(own, expected.map(|(name, value)| (name.to_owned(), Value::from(value))));
    }
}

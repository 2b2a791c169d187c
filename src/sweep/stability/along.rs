//! The parameters along which thresholds can be looked for, and the one that is chosen.

use crate::report::Along;
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
    // The figures have ω and μ along their axes, so that one of them has to stay.
    let has_both = [MU, OMEGA].iter().all(|name| zipped.contains(name));
    for parameter in study.zipped().iter().filter(|parameter| parameter.is_continuous() && !has_both) {
        // Beside ω or μ the others are read along it.
        let is_led = [MU, OMEGA].iter().any(|name| zipped.contains(name) && *name != parameter.name);
        if !is_led {
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
pub fn rest(along: &Along, omega_rpm: f64, mu: f64, parameters: &[(String, Value)]) -> Vec<(String, Value)> {
    let own = [(OMEGA, omega_rpm), (MU, mu)].map(|(name, value)| (name.to_owned(), Value::from(value)));
    let further = parameters.iter().filter(|(name, _)| !matches!(name.as_str(), OMEGA | MU)).cloned();
    own.into_iter().chain(further).filter(|(name, _)| !along.moves(name)).collect()
}

/// The value of a job along it.
pub fn position(along: &Along, job: &Job) -> Option<f64> {
    job.parameters.iter().find(|(name, _)| *name == along.parameter).and_then(|(_, value)| value.as_f64())
}

/// The values of the parameters at a place of the series of these grid jobs, which are sorted by their place. Parameters that move
/// together keep doing so: between two points each of them has its share of the way. None outside, and where one of them has no
/// values in between.
pub fn parameters_at(along: &Along, anchors: &[(f64, &Job)], x: f64) -> Option<Vec<(String, Value)>> {
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

//! How two studies differ.

use crate::publish::value;
use crate::study::{Job, PARAMETERS, Parameter, inputs};
use indexmap::IndexMap;
use rayon::iter::ParallelIterator;
use rayon::slice::ParallelSlice;
use serde_json::Value;
use std::collections::HashSet;

/// How the jobs of two studies differ.
#[derive(Debug, Clone)]
pub struct Difference {
    /// The inputs that do not have the same values in both studies, in the order of [`PARAMETERS`].
    pub inputs: Vec<InputDifference>,
    /// Jobs that both studies have.
    pub common: usize,
    /// Keys of jobs that only the first study has, in its order.
    pub only_a: Vec<String>,
    /// Keys of jobs that only the second study has, in its order.
    pub only_b: Vec<String>,
}

/// An input with its values in two studies.
#[derive(Debug, Clone, PartialEq)]
pub struct InputDifference {
    /// The input.
    pub parameter: &'static Parameter,
    /// Its values in the jobs of the first study, each once: numbers from small to large, other values in the order of
    /// the jobs. Empty if the input has no effect in any job.
    pub a: Vec<Value>,
    /// Its values in the jobs of the second study.
    pub b: Vec<Value>,
}

impl Difference {
    /// Compares two studies by their jobs, so that the ways in which they are written do not matter: a value in the scene,
    /// from a preset and from a grid is the same.
    pub fn between(a: &[Job], b: &[Job]) -> Self {
        let keys = |jobs: &[Job]| jobs.iter().map(|job| job.key.clone()).collect::<HashSet<_>>();
        let only = |jobs: &[Job], other: &HashSet<String>| -> Vec<String> {
            jobs.iter().filter(|job| !other.contains(&job.key)).map(|job| job.key.clone()).collect()
        };
        let (only_a, only_b) = (only(a, &keys(b)), only(b, &keys(a)));
        let inputs = PARAMETERS.iter().zip(values(a)).zip(values(b));
        let inputs = inputs.filter(|((_, a), b)| a != b);
        let inputs = inputs.map(|((parameter, a), b)| InputDifference { parameter, a, b }).collect();
        Self { inputs, common: a.len() - only_a.len(), only_a, only_b }
    }

    /// Whether the studies have the same jobs and inputs.
    pub fn is_empty(&self) -> bool {
        self.inputs.is_empty() && self.only_a.is_empty() && self.only_b.is_empty()
    }
}

impl InputDifference {
    /// Both sides in words: `omega_rpm: 17 values, 2 rpm to 300 rpm → 5 rpm`.
    pub fn in_words(&self) -> String {
        let Self { parameter, a, b } = self;
        let unit = parameter.unit;
        let name = parameter.name;
        let texts = [false, true].map(|is_exact| [a, b].map(|values| values_text(values, unit, is_exact)));
        if let Some([a, b]) = texts.into_iter().find(|[a, b]| a != b) {
            return format!("{name}: {a} → {b}");
        }
        let old: HashSet<String> = a.iter().map(Value::to_string).collect();
        let new = b.iter().filter(|value| !old.contains(&value.to_string())).count();
        let b = values_text(b, unit, false);
        format!("{name}: {} → {b}, {new} of them new", value::count(a.len(), "value"))
    }
}

/// The largest number of values that are written one by one.
const LISTED: usize = 3;

/// The values with four significant digits, or exactly.
fn values_text(values: &[Value], unit: &str, is_exact: bool) -> String {
    let text = |value: &Value| match value.as_f64() {
        Some(x) if !is_exact => value::quantity(x, unit),
        Some(_) if !unit.is_empty() => format!("{} {unit}", value::text(value)),
        _ => value::text(value),
    };
    match values {
        [] => "–".to_owned(),
        [first, .., last] if values.len() > LISTED && first.is_number() && last.is_number() => {
            format!("{} values, {} to {}", values.len(), text(first), text(last))
        }
        _ if values.len() > LISTED => format!("{} values", values.len()),
        _ => values.iter().map(text).collect::<Vec<_>>().join(", "),
    }
}

/// Different values by their texts, in the order in which they were added.
type Distinct = IndexMap<String, Value>;

/// Jobs whose values are collected at a time.
const CHUNK: usize = 1_000;

/// For each of [`PARAMETERS`] its values in the jobs.
fn values(jobs: &[Job]) -> Vec<Vec<Value>> {
    let parts: Vec<Vec<Distinct>> = jobs.par_chunks(CHUNK).map(distinct).collect();
    let mut all: Vec<Distinct> = PARAMETERS.iter().map(|_| Distinct::default()).collect();
    for part in parts {
        for (all, part) in all.iter_mut().zip(part) {
            for (text, value) in part {
                all.entry(text).or_insert(value);
            }
        }
    }
    let sorted = |values: Distinct| {
        let mut values: Vec<Value> = values.into_values().collect();
        value::sort_numbers(&mut values);
        values
    };
    all.into_iter().map(sorted).collect()
}

fn distinct(jobs: &[Job]) -> Vec<Distinct> {
    let mut found: Vec<Distinct> = PARAMETERS.iter().map(|_| Distinct::default()).collect();
    for job in jobs {
        // Inputs come in the order of the parameters.
        let mut places = PARAMETERS.iter().zip(&mut found);
        for input in inputs(&job.spec) {
            if let Some((_, values)) = places.find(|(parameter, _)| **parameter == *input.parameter) {
                values.entry(input.value.to_string()).or_insert(input.value);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Parameter;

    fn line(name: &str, a: &[f64], b: &[f64]) -> String {
        let values = |values: &[f64]| values.iter().map(|value| Value::from(*value)).collect();
        let parameter = Parameter::find(name).unwrap();
        InputDifference { parameter, a: values(a), b: values(b) }.in_words()
    }

    /// Protects: the two sides of a line never look the same, however small the difference is.
    #[test]
    fn the_sides_of_a_line_differ() {
        assert_eq!(line("load_n", &[30.0], &[50.0]), "load_n: 30 N → 50 N");
        assert_eq!(line("young_modulus_pa", &[5e8], &[1e9, 2e9]), "young_modulus_pa: 0.5 GPa → 1 GPa, 2 GPa");
        assert_eq!(line("mu", &[], &[0.4]), "mu: – → 0.4");
        assert_eq!(line("mu", &[0.4], &[0.400_001]), "mu: 0.4 → 0.400001");
        assert_eq!(line("load_n", &[30.0], &[30.0001]), "load_n: 30 N → 30.0001 N");
        let five = [1.0, 2.0, 3.0, 4.0, 5.0];
        let other = [1.0, 2.5, 3.0, 4.5, 5.0];
        assert_eq!(line("omega_rpm", &five, &five[..1]), "omega_rpm: 5 values, 1 rpm to 5 rpm → 1 rpm");
        assert_eq!(
            line("omega_rpm", &five, &other),
            "omega_rpm: 5 values → 5 values, 1 rpm to 5 rpm, 2 of them new"
        );
    }
}

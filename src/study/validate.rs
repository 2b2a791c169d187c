//! Every job of a grid against its physical limits, each violation told once.

use super::Study;
use super::error::Problem;
use crate::spec::FieldError;
use rayon::iter::ParallelIterator;
use serde_json::Value;
use std::collections::HashMap;

/// A violation and the grid points that have it.
struct Found {
    violation: FieldError,
    first: Vec<usize>,
    count: usize,
}

/// The problems of all jobs; the same violation in many jobs is one problem.
pub(super) fn check_jobs(study: &Study) -> Vec<Problem> {
    let mut found: Vec<Found> = Vec::new();
    let mut known: HashMap<(String, String, String), usize> = HashMap::new();
    let violations = study.points().filter_map(|(indices, spec)| Some((indices, spec.check().err()?)));
    for (indices, violations) in violations.collect::<Vec<_>>() {
        for violation in violations.0 {
            let FieldError { field, value, expected } = violation.clone();
            let index = *known.entry((field, value, expected)).or_insert(found.len());
            if index == found.len() {
                found.push(Found { violation, first: indices.clone(), count: 0 });
            }
            found[index].count += 1;
        }
    }
    found.iter().map(|found| study.describe(found)).collect()
}

impl Study {
    fn describe(&self, found: &Found) -> Problem {
        let FieldError { field, value, expected } = &found.violation;
        let axis = self.axes.iter().position(|axis| axis.parameter.sets(field));
        let message = format!("expected {expected}");
        let (problem, alone) = match axis {
            Some(axis) => {
                let (path, words) = self.axes[axis].value_path(found.first[axis]);
                let problem = self.origin.problem(&path, message).with_help(format!("set by {words}"));
                (problem, self.grid_size() / self.axes[axis].values.len())
            }
            None => (self.origin.problem(field, message), self.grid_size()),
        };
        let mut problem = Problem { field: field.clone(), value: Some(value.clone()), ..problem };
        // Fewer jobs than the value alone accounts for: another parameter has a part in it.
        if found.count < alone {
            let job = assignments(&self.parameters_at(&found.first));
            let (count, total) = (found.count, self.grid_size());
            problem.help.push(format!("in {count} of {total} jobs, first in the one with {job}"));
        }
        problem
    }
}

/// `mu = 0.4, omega_rpm = 7`.
fn assignments(parameters: &[(String, Value)]) -> String {
    let each: Vec<_> = parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    each.join(", ")
}

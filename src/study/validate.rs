//! Checks every job of a grid against its physical limits, and reports each violation once.

use super::definition::Study;
use super::error::Problem;
use crate::spec::FieldError;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use serde_json::Value;
use std::collections::HashMap;

/// A violation and the grid points that have it.
struct SharedViolation {
    violation: FieldError,
    first_point: usize,
    points: usize,
}

/// The problems of all jobs; the same violation in many jobs is one problem.
pub(super) fn check_jobs(study: &Study) -> Vec<Problem> {
    let mut found: Vec<SharedViolation> = Vec::new();
    let mut index_of: HashMap<(String, String, String), usize> = HashMap::new();
    let violations =
        study.specs.par_iter().enumerate().filter_map(|(point, spec)| Some((point, spec.check().err()?)));
    for (point, violations) in violations.collect::<Vec<_>>() {
        for violation in violations.0 {
            let FieldError { field, value, expected } = violation.clone();
            let index = *index_of.entry((field, value, expected)).or_insert(found.len());
            if index == found.len() {
                found.push(SharedViolation { violation, first_point: point, points: 0 });
            }
            found[index].points += 1;
        }
    }
    found.iter().map(|found| study.describe(found)).collect()
}

impl Study {
    fn describe(&self, found: &SharedViolation) -> Problem {
        let FieldError { field, value, expected } = &found.violation;
        let axis = self.grid.axes.iter().position(|axis| axis.parameter.sets(field));
        let message = format!("expected {expected}");
        let (problem, points_with_value) = match axis {
            Some(position) => {
                let axis = &self.grid.axes[position];
                let (path, words) = axis.value_path(self.grid.indices_of(found.first_point)[position]);
                let problem = self.source.problem(&path, message).with_help(format!("set by {words}"));
                (problem, self.grid_size() / axis.values.len())
            }
            None => (self.source.problem(field, message), self.grid_size()),
        };
        let mut problem = Problem { field: field.clone(), value: Some(value.clone()), ..problem };
        // Not all jobs with this value violate the limit: another parameter contributes.
        if found.points < points_with_value {
            let job = assignments(&self.grid.parameters_at(found.first_point));
            let (count, total) = (found.points, self.grid_size());
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

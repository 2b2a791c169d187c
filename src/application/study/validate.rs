//! Checks every job of a grid against its physical limits, and reports each violation once.

use super::definition::Study;
use super::error::Problem;
use crate::spec::FieldError;
use indexmap::IndexMap;
use serde_json::Value;

/// A violation and the grid points that have it.
struct SharedViolation {
    violation: FieldError,
    first_point: usize,
    points: usize,
}

/// The problems of all jobs, from the violations at each point of the grid; the same violation in many jobs is one problem.
pub(super) fn check_jobs(study: &Study, violations: &[Vec<FieldError>]) -> Vec<Problem> {
    let mut found: IndexMap<(String, String, String), SharedViolation> = IndexMap::new();
    for (point, violations) in violations.iter().enumerate() {
        for violation in violations {
            let FieldError { field, value, expected } = violation.clone();
            let first = || SharedViolation { violation: violation.clone(), first_point: point, points: 0 };
            found.entry((field, value, expected)).or_insert_with(first).points += 1;
        }
    }
    let found: Vec<SharedViolation> = found.into_values().collect();
    let refused: Vec<&str> = found.iter().map(|found| found.violation.field.as_str()).collect();
    // A modulus in GPa makes times and speeds unusable. Then the modulus is the reason, and it comes first.
    let mut problems = if found.is_empty() { Vec::new() } else { study.wrong_units(&refused) };
    problems.extend(found.iter().map(|found| study.describe(found)));
    problems
}

impl Study {
    fn describe(&self, found: &SharedViolation) -> Problem {
        let FieldError { field, value, expected } = &found.violation;
        let (problem, points_with_value) =
            self.problem_at(field, &format!("expected {expected}"), found.first_point);
        let mut problem = Problem { value: Some(value.clone()), ..problem };
        // Not all jobs with this value violate the limit: another parameter contributes.
        if found.points < points_with_value {
            let job = assignments(&self.grid.parameters_at(found.first_point));
            let (count, total) = (found.points, self.grid_size());
            problem.help.push(format!("in {count} of {total} jobs, first in the one with {job}"));
        }
        problem
    }

    /// A problem with the value of a field at a grid point. Also returns the number of points with this value.
    pub(super) fn problem_at(&self, field: &str, message: &str, point: usize) -> (Problem, usize) {
        let axis = self.grid.axes.iter().position(|axis| axis.parameter.sets(field));
        let Some(position) = axis else {
            if let Some(found) = self.problem_in_samples(field, message, point) {
                return found;
            }
            return (self.source.problem(field, message), self.grid_size());
        };
        let axis = &self.grid.axes[position];
        let index = self.grid.indices_of(point)[position];
        let (path, words) = axis.value_path(index);
        let problem = self.source.problem(&path, message).with_help(format!("set by {words}"));
        let value = Some(axis.values[index].to_string());
        (Problem { field: field.to_owned(), value, ..problem }, self.grid.points_like(point, position))
    }

    /// A problem with a value that the samples give.
    fn problem_in_samples(&self, field: &str, message: &str, point: usize) -> Option<(Problem, usize)> {
        let samples = self.grid.samples.as_ref()?;
        let column = samples.parameters.iter().position(|parameter| parameter.sets(field))?;
        let (row, _) = self.grid.place_of(point);
        let name = samples.parameters[column].name;
        let path = [
            format!("samples.of.{name}"),
            format!("samples.points[{row}].{name}"),
            format!("samples.zip.{name}"),
        ]
        .into_iter()
        .find(|path| self.source.gives(path));
        let problem = self.source.problem(path.as_deref().unwrap_or("samples"), message);
        let problem =
            problem.with_help(format!("set by samples, point {} of {}", row + 1, samples.rows.len()));
        let value = Some(samples.rows[row][column].to_string());
        Some((Problem { field: field.to_owned(), value, ..problem }, 1))
    }
}

/// `mu = 0.4, omega_rpm = 7`.
pub(super) fn assignments(parameters: &[(String, Value)]) -> String {
    let each: Vec<_> = parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    each.join(", ")
}

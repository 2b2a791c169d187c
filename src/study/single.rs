//! One job of a study, selected by `name=value` overrides.

use super::axis::{Axis, check_type};
use super::definition::Study;
use super::error::{Problem, StudyError};
use super::json;
use super::parameter::{Kind, Parameter, unknown_help};
use super::preset::Preset;
use super::source::shorten;
use crate::spec::JobSpec;
use serde_json::Value;

/// Stands for the file in messages about overrides.
const SOURCE: &str = "--set";

/// Largest number of values that a message lists to choose from.
const MAX_LISTED: usize = 40;

impl Study {
    /// The job with `overrides` (name, value) on top of the base job and the grid.
    ///
    /// Every parameter of the grid must be overridden or have a single value; other parameters may
    /// be overridden too. A value is read as JSON, or else as a string; `12x15x10` is a list of counts.
    ///
    /// # Errors
    /// Unknown, repeated or overlapping names, values of the wrong type, parameters of the grid that
    /// are left open, and violations of [`JobSpec::check`].
    pub fn single(&self, overrides: &[(String, String)]) -> Result<JobSpec, StudyError> {
        self.single_with_preset(None, overrides)
    }

    /// [`Study::single`] with the settings of a `preset`. The preset takes precedence over the file and the grid, and the
    /// overrides over the preset.
    ///
    /// # Errors
    /// Those of [`Study::single`].
    pub fn single_with_preset(
        &self,
        preset: Option<Preset>,
        overrides: &[(String, String)],
    ) -> Result<JobSpec, StudyError> {
        let (found, left_open) = self.select(SOURCE, preset, overrides);
        if left_open.is_empty() {
            return found;
        }
        let mut problems = match found {
            Err(StudyError::Invalid(problems)) => problems,
            _ => Vec::new(),
        };
        problems.extend(left_open.into_iter().map(|axis| self.left_open(axis)));
        Err(StudyError::Invalid(problems))
    }

    /// As [`Study::single_with_preset`], but parameters of the grid that are left open have the base job's value. Also
    /// returns the names of these parameters. `source` stands for the origin of the overrides in messages.
    ///
    /// # Errors
    /// Those of [`Study::single`] except for open parameters.
    pub fn single_on_base(
        &self,
        source: &str,
        preset: Option<Preset>,
        overrides: &[(String, String)],
    ) -> Result<(JobSpec, Vec<&'static str>), StudyError> {
        let (spec, left_open) = self.select(source, preset, overrides);
        Ok((spec?, left_open.into_iter().map(|axis| axis.parameter.name).collect()))
    }

    /// The job with these overrides, and the axes of the grid that they leave open. In these the job has the base job's
    /// value.
    fn select(
        &self,
        source: &str,
        preset: Option<Preset>,
        overrides: &[(String, String)],
    ) -> (Result<JobSpec, StudyError>, Vec<&Axis>) {
        let mut job = json::encode(&self.base);
        let mut problems = Vec::new();
        let mut overridden: Vec<&Parameter> = Vec::new();
        let mut settings = Vec::new();
        for (name, text) in overrides {
            let problem = |message| problem(source, name, text, message);
            let Some(parameter) = Parameter::find(name) else {
                problems.push(Problem { help: unknown_help(name), ..problem("no such parameter".into()) });
                continue;
            };
            if let Some(other) = overridden.iter().find(|other| other.overlaps(parameter)) {
                let message = format!("{} is already set; expected only one of the two", other.name);
                problems.push(problem(message));
            }
            overridden.push(parameter);
            let value = parameter.normalise(parse_value(parameter, text));
            match check_type(parameter, &value, &job) {
                Ok(()) => settings.push((parameter, value)),
                Err(message) => problems.push(problem(message).with_help(parameter.help())),
            }
        }
        let mut left_open = Vec::new();
        for axis in &self.grid.axes {
            match axis.values.as_slice() {
                [only] => axis.parameter.set(&mut job, only),
                _ if overridden.iter().any(|parameter| parameter.sets(&axis.parameter.field())) => {}
                _ if preset.is_some() && Preset::covers(axis.parameter) => {}
                _ => left_open.push(axis),
            }
        }
        if !problems.is_empty() {
            return (Err(StudyError::Invalid(problems)), left_open);
        }
        for (parameter, value) in &settings {
            parameter.set(&mut job, value);
        }
        if let Some(preset) = preset {
            preset.override_job(&mut job, &overridden);
        }
        (self.checked(source, &job, &overridden), left_open)
    }

    fn left_open(&self, axis: &Axis) -> Problem {
        let mut values: Vec<_> = axis.values.iter().take(MAX_LISTED).map(Value::to_string).collect();
        if axis.values.len() > MAX_LISTED {
            values.push("…".to_owned());
        }
        let name = axis.parameter.name;
        let problem = self.source.problem(&axis.path(), "expected one value for a single job");
        Problem { value: Some(format!("[{}]", values.join(", "))), ..problem }
            .with_help(format!("pick one with --set {name}={}", values[0].trim_matches('"')))
    }

    fn checked(&self, source: &str, job: &Value, overridden: &[&Parameter]) -> Result<JobSpec, StudyError> {
        let spec = json::decode_checked(job);
        let Err(violations) = spec.check() else { return Ok(spec) };
        let describe = |violation: &crate::spec::FieldError| {
            let message = format!("expected {}", violation.expected);
            let problem = if overridden.iter().any(|parameter| parameter.sets(&violation.field)) {
                problem(source, &violation.field, &violation.value, message)
            } else {
                self.source.problem(&violation.field, message)
            };
            Problem { value: Some(violation.value.clone()), ..problem }
        };
        Err(StudyError::Invalid(violations.0.iter().map(describe).collect()))
    }
}

fn problem(source: &str, field: &str, value: &str, message: String) -> Problem {
    Problem {
        file: source.to_owned(),
        position: None,
        field: field.to_owned(),
        value: Some(shorten(value)),
        message,
        help: Vec::new(),
    }
}

/// Reads the text of an override: counts as `12x15x10`, then JSON, otherwise a string.
fn parse_value(parameter: &Parameter, text: &str) -> Value {
    if matches!(parameter.kind, Kind::Counts) {
        let counts: Result<Vec<u64>, _> = text.split(['x', '×']).map(|n| n.trim().parse()).collect();
        if let Ok(counts) = counts {
            return Value::from(counts);
        }
    }
    serde_json::from_str(text).unwrap_or_else(|_| Value::from(text))
}

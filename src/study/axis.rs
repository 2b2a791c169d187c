//! One axis of a grid: a list of values or a range, with every value checked for its type.

use super::error::Problem;
use super::expand::MAX_JOBS;
use super::file::{Range, Spacing};
use super::json::decode;
use super::origin::Origin;
use super::parameter::{Kind, Parameter};
use crate::spec::JobSpec;
use serde_json::{Value, json};
use std::collections::HashMap;

/// A parameter and the values it takes.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    pub parameter: &'static Parameter,
    /// Normalised, all different, all of the parameter's type.
    pub values: Vec<Value>,
    /// Whether the file lists the values one by one, so that each has a place of its own.
    pub listed: bool,
}

impl Axis {
    /// Path in the study file.
    pub(super) fn path(&self) -> String {
        format!("grid.{}", self.parameter.name)
    }

    /// Reads the axis `grid.<parameter>`; `template` is the serialised base job.
    pub(super) fn read(
        parameter: &'static Parameter,
        given: &Value,
        template: &Value,
        origin: &Origin,
    ) -> Result<Self, Vec<Problem>> {
        let path = format!("grid.{}", parameter.name);
        let values = match given {
            Value::Array(list) if list.is_empty() => Err(vec![
                origin
                    .problem(&path, "expected at least one value")
                    .with_help("leave the parameter out to use the value of the base job"),
            ]),
            Value::Array(list) => Ok(list.clone()),
            Value::Object(_) => range(parameter, given, &path, origin),
            _ => Err(vec![origin.problem(&path, format!("expected {}", axis_form(parameter)))]),
        }?;
        let axis = Self {
            parameter,
            values: values.into_iter().map(|value| parameter.normalise(value)).collect(),
            listed: given.is_array(),
        };
        let problems = axis.problems(template, origin);
        if problems.is_empty() { Ok(axis) } else { Err(problems) }
    }

    /// Where value `index` stands in the file, as path and as words.
    pub(super) fn value_path(&self, index: usize) -> (String, String) {
        let path = self.path();
        if self.listed {
            let item = format!("{path}[{index}]");
            return (item.clone(), item);
        }
        let words = format!("{path}, value {} of {}", index + 1, self.values.len());
        (path, words)
    }

    fn problems(&self, template: &Value, origin: &Origin) -> Vec<Problem> {
        let mut first_with = HashMap::new();
        let mut problems = Vec::new();
        for (index, value) in self.values.iter().enumerate() {
            let (path, words) = self.value_path(index);
            if let Err(message) = check_type(self.parameter, value, template) {
                problems.push(origin.problem(&path, message).with_help(self.parameter.help()));
            } else if let Some(first) = first_with.insert(value.to_string(), words) {
                let message = format!("the same value as {first}; expected all values to differ");
                problems.push(origin.problem(&path, message));
                if !self.listed {
                    // A range too narrow for its count: one complaint says it.
                    break;
                }
            }
        }
        problems
    }
}

/// Whether `value` has the type of the parameter; if not, what would be right.
pub(super) fn check_type(parameter: &Parameter, value: &Value, template: &Value) -> Result<(), String> {
    if value.is_null() {
        // An optional field would take it, as "not given".
        return Err("expected a value; leave the parameter out to use its default".to_owned());
    }
    let mut job = template.clone();
    parameter.set(&mut job, value);
    decode::<JobSpec>(&job, template).map(drop).map_err(|mismatch| match mismatch.suggestion {
        Some(name) => format!("{} (did you mean `{name}`?)", mismatch.message),
        None => mismatch.message,
    })
}

fn axis_form(parameter: &Parameter) -> &'static str {
    match parameter.kind {
        Kind::Number | Kind::Count => {
            "a list of values or a range { \"from\": a, \"to\": b, \"count\": n, \"spacing\": \"linear\" or \"log\" }"
        }
        Kind::Counts => "a list of meshes, each [nx, ny, nz]",
        Kind::Flag | Kind::Name(_) => "a list of values",
    }
}

fn range(
    parameter: &Parameter,
    given: &Value,
    path: &str,
    origin: &Origin,
) -> Result<Vec<Value>, Vec<Problem>> {
    if !matches!(parameter.kind, Kind::Number | Kind::Count) {
        return Err(vec![origin.problem(path, format!("expected {}", axis_form(parameter)))]);
    }
    let range: Range = decode(given, &json!({ "spacing": "linear" }))
        .map_err(|mismatch| vec![origin.mismatch(path, mismatch)])?;
    let field = |name: &str, message: String| Err(vec![origin.problem(&format!("{path}.{name}"), message)]);
    if range.count > MAX_JOBS {
        return field("count", format!("expected at most {MAX_JOBS} values"));
    }
    if range.from == range.to && range.count != 1 {
        return field("count", "expected 1, because from equals to".to_owned());
    }
    if range.from != range.to && range.count < 2 {
        return field("count", "expected at least 2, one for each end".to_owned());
    }
    if range.spacing == Spacing::Log {
        for (name, end) in [("from", range.from), ("to", range.to)] {
            if end <= 0.0 {
                return field(name, "expected a number > 0, because the spacing is logarithmic".to_owned());
            }
        }
    }
    let values = range.values();
    if matches!(parameter.kind, Kind::Count)
        && let Some(broken) = values.iter().find(|value| value.fract() != 0.0)
    {
        let message = format!("gives the value {broken}; expected whole numbers only");
        return Err(vec![origin.problem(path, message).with_help("list the values instead")]);
    }
    Ok(values.into_iter().map(Value::from).collect())
}

impl Range {
    /// The ends exactly as given, the values between them rounded to 12 significant digits: then
    /// 0.1 to 0.6 contains 0.3 and not 0.30000000000000004, and is the same job as a listed 0.3.
    fn values(&self) -> Vec<f64> {
        let last = self.count - 1;
        let between = |step: usize| {
            let share = step as f64 / last as f64;
            let value = match self.spacing {
                Spacing::Linear => self.from * (1.0 - share) + self.to * share,
                Spacing::Log => (self.from.ln() * (1.0 - share) + self.to.ln() * share).exp(),
            };
            format!("{value:.11e}").parse().unwrap_or(value)
        };
        let value = |step| match step {
            0 => self.from,
            step if step == last => self.to,
            step => between(step),
        };
        (0..self.count).map(value).collect()
    }
}

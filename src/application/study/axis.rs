//! One axis of a grid: a list of values or a range. Every value is checked for its type.

use super::error::Problem;
use super::file::StudyFile;
use super::json::{Decoded, decode, decode_all, number_hint};
use super::locate::join;
use super::parameter::{Kind, Parameter};
use super::range::{Range, Unusable};
use super::source::SourceText;
use serde_json::{Value, json};
use std::collections::{HashMap, HashSet};

/// A parameter and the values it takes.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    pub parameter: &'static Parameter,
    /// Normalised values of the parameter's type, without repetitions.
    pub values: Vec<Value>,
    /// Whether the file lists the values one by one, so that each has a position of its own.
    pub is_listed: bool,
    /// The range as given, if it is one.
    range: Option<Value>,
}

impl Axis {
    /// An axis of values that have been checked.
    pub(super) fn of_values(parameter: &'static Parameter, values: Vec<Value>) -> Self {
        Self { parameter, values, is_listed: true, range: None }
    }

    /// Path in the study file.
    pub(super) fn path(&self) -> String {
        format!("grid.{}", self.parameter.name)
    }

    /// The axis as a study file has it.
    pub(super) fn written(&self) -> Value {
        self.range.clone().unwrap_or_else(|| Value::Array(self.values.clone()))
    }

    /// Reads the axis `grid.<parameter>`; `template` is that of a study file.
    pub(super) fn read(
        parameter: &'static Parameter,
        given: &Value,
        template: &Value,
        source: &SourceText,
    ) -> Result<Self, Vec<Problem>> {
        let path = format!("grid.{}", parameter.name);
        let axis = Self {
            parameter,
            values: values(parameter, given, &path, source)?,
            is_listed: given.is_array(),
            range: given.is_object().then(|| given.clone()),
        };
        let problems = axis.problems(template, source);
        if problems.is_empty() { Ok(axis) } else { Err(problems) }
    }

    /// Values of a parameter at `path`, a list or a range, which may be repeated.
    pub(super) fn column(
        parameter: &'static Parameter,
        given: &Value,
        path: &str,
        template: &Value,
        source: &SourceText,
    ) -> Result<Vec<Value>, Vec<Problem>> {
        let values = values(parameter, given, path, source)?;
        let mut checked = HashSet::new();
        let mut problems = Vec::new();
        for (index, value) in values.iter().enumerate() {
            if (matches!(parameter.kind, Kind::Number) && value.is_number())
                || !checked.insert(value.to_string())
            {
                continue;
            }
            if let Err(message) = check_type(parameter, value, template) {
                let path = if given.is_array() { format!("{path}[{index}]") } else { path.to_owned() };
                problems.push(source.problem(&path, message).with_help(parameter.help()));
            }
        }
        if problems.is_empty() { Ok(values) } else { Err(problems) }
    }

    /// Where value `index` stands in the file: its path, and words for messages.
    pub(super) fn value_path(&self, index: usize) -> (String, String) {
        let path = self.path();
        if self.is_listed {
            let item = format!("{path}[{index}]");
            return (item.clone(), item);
        }
        let words = format!("{path}, value {} of {}", index + 1, self.values.len());
        (path, words)
    }

    fn problems(&self, template: &Value, source: &SourceText) -> Vec<Problem> {
        let mut first_with = HashMap::new();
        let mut problems = Vec::new();
        for (index, value) in self.values.iter().enumerate() {
            let (path, words) = self.value_path(index);
            if let Err(message) = check_type(self.parameter, value, template) {
                let problem = source.problem(&path, message).with_help(self.parameter.help());
                problems.push(self.parameter.with_hint(problem, value));
            } else if let Some(first) = first_with.insert(value.to_string(), words) {
                let message = format!("the same value as {first}; expected all values to differ");
                problems.push(source.problem(&path, message));
                if !self.is_listed {
                    // The range is too narrow for its count. One message is enough.
                    break;
                }
            }
        }
        problems
    }
}

/// Checks that `value` has the type of the parameter; the error says what is expected. `template` is that of a study
/// file.
pub(super) fn check_type(parameter: &Parameter, value: &Value, template: &Value) -> Result<(), String> {
    if value.is_null() {
        // An optional field would accept null, as if it were absent.
        return Err("expected a value; leave the parameter out to use its default".to_owned());
    }
    let mut study = template.clone();
    parameter.set(&mut study, value);
    decode::<StudyFile>(&study, template).map(drop).map_err(|mismatch| match mismatch.suggestion {
        Some(name) => format!("{} (did you mean `{name}`?)", mismatch.message),
        None => mismatch.message,
    })
}

/// What an axis of the parameter looks like, for messages.
fn axis_form(parameter: &Parameter) -> &'static str {
    match parameter.kind {
        Kind::Number | Kind::Count => {
            "a list of values or a range { \"from\": a, \"to\": b, \"count\": n, \"spacing\": \"linear\" or \"log\" } or { \"from\": a, \"to\": b, \"step\": s }"
        }
        Kind::Counts => "a list of meshes, each [nx, ny, nz]",
        Kind::Flag | Kind::Name(_) => "a list of values",
    }
}

/// The values of a list or a range at `path`, normalised.
fn values(
    parameter: &'static Parameter,
    given: &Value,
    path: &str,
    source: &SourceText,
) -> Result<Vec<Value>, Vec<Problem>> {
    let values = match given {
        Value::Array(list) if list.is_empty() => Err(vec![
            source
                .problem(path, "expected at least one value")
                .with_help("leave the parameter out to use the value of the base job"),
        ]),
        Value::Array(list) => Ok(list.clone()),
        Value::Object(_) => range_values(parameter, given, path, source),
        _ => {
            let problem = source.problem(path, format!("expected {}", axis_form(parameter)));
            let list = json!([given]);
            let hint = match given {
                // A text may stand for several numbers.
                Value::String(text) if parameter.is_number() => number_hint(text),
                _ => Some(format!("write {list} for one value")),
            };
            Err(vec![Problem { help: hint.into_iter().collect(), ..problem }])
        }
    }?;
    Ok(values.into_iter().map(|value| parameter.normalise(value)).collect())
}

/// The values of the range `given`.
fn range_values(
    parameter: &Parameter,
    given: &Value,
    path: &str,
    source: &SourceText,
) -> Result<Vec<Value>, Vec<Problem>> {
    if !matches!(parameter.kind, Kind::Number | Kind::Count) {
        return Err(vec![source.problem(path, format!("expected {}", axis_form(parameter)))]);
    }
    let Decoded { value, mismatches } = decode_all::<Range>(given, &json!({ "spacing": "linear" }));
    let (Some(range), true) = (value, mismatches.is_empty()) else {
        return Err(mismatches.into_iter().map(|mismatch| source.mismatch(path, mismatch)).collect());
    };
    let values = range.values().map_err(|Unusable { field, expected }| {
        let field = if field.is_empty() { path.to_owned() } else { join(path, field) };
        vec![source.problem(&field, expected)]
    })?;
    if matches!(parameter.kind, Kind::Count)
        && let Some(fraction) = values.iter().find(|value| value.fract() != 0.0)
    {
        let message = format!("gives the value {fraction}; expected whole numbers only");
        return Err(vec![source.problem(path, message).with_help("list the values instead")]);
    }
    Ok(values.into_iter().map(Value::from).collect())
}

//! Conditions on the points of a study: which of them are jobs.

use super::error::Problem;
use super::locate::join;
use super::parameter::{Parameter, unknown_help};
use super::source::SourceText;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// The limits of a parameter, both included.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Limits {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    from: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    to: Option<f64>,
}

/// What a parameter must be.
#[derive(Debug, Clone)]
enum Wanted {
    Between(Limits),
    OneOf(Vec<Value>),
}

/// An entry: parameters with what they must be, all of them.
type Entry = Vec<(&'static Parameter, Wanted)>;

/// The conditions of a study.
#[derive(Debug, Clone, Default)]
pub(super) struct Conditions {
    include: Vec<Entry>,
    exclude: Vec<Entry>,
}

impl Conditions {
    /// Reads `include` and `exclude` of a study file.
    pub fn read(
        include: Option<&[Map<String, Value>]>,
        exclude: Option<&[Map<String, Value>]>,
        source: &SourceText,
    ) -> Result<Self, Vec<Problem>> {
        let mut problems = Vec::new();
        let mut entries = |field: &str, given: Option<&[Map<String, Value>]>| -> Vec<Entry> {
            let read = |(number, entry): (usize, &Map<String, Value>)| {
                entry_of(entry, &format!("{field}[{number}]"), source)
            };
            let (read, failed): (Vec<_>, Vec<_>) =
                given.into_iter().flatten().enumerate().map(read).partition(Result::is_ok);
            problems.extend(failed.into_iter().filter_map(Result::err).flatten());
            read.into_iter().flatten().collect()
        };
        let found = Self { include: entries("include", include), exclude: entries("exclude", exclude) };
        if problems.is_empty() { Ok(found) } else { Err(problems) }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.include.is_empty() && self.exclude.is_empty()
    }

    /// Whether a point is a job: it fulfils an entry of `include`, if there are any, and none of `exclude`. A parameter that the point
    /// does not have has its value in the job `base`.
    pub fn keep(&self, point: &[(&'static Parameter, &Value)], base: &Value) -> bool {
        let value_of = |parameter: &'static Parameter| {
            let own = point.iter().find(|(own, _)| *own == parameter).map(|(_, value)| *value);
            own.or_else(|| base.pointer(parameter.pointer))
        };
        let fulfils = |entry: &Entry| {
            entry
                .iter()
                .all(|(parameter, wanted)| value_of(parameter).is_some_and(|value| wanted.is_met(value)))
        };
        (self.include.is_empty() || self.include.iter().any(fulfils)) && !self.exclude.iter().any(fulfils)
    }
}

impl Wanted {
    fn is_met(&self, value: &Value) -> bool {
        match self {
            Self::Between(Limits { from, to }) => value.as_f64().is_some_and(|number| {
                from.is_none_or(|from| number >= from) && to.is_none_or(|to| number <= to)
            }),
            Self::OneOf(values) => values
                .iter()
                .any(|wanted| wanted == value || wanted.is_number() && wanted.as_f64() == value.as_f64()),
        }
    }
}

fn entry_of(given: &Map<String, Value>, path: &str, source: &SourceText) -> Result<Entry, Vec<Problem>> {
    if given.is_empty() {
        let message = "expected at least one parameter, such as { \"mu\": { \"from\": 0.3 } }";
        return Err(vec![source.problem(path, message)]);
    }
    let mut entry = Entry::new();
    let mut problems = Vec::new();
    for (name, wanted) in given {
        let path = join(path, name);
        let Some(parameter) = Parameter::find(name) else {
            let problem = source.problem_with_name(&path, "no such parameter");
            problems.push(Problem { help: unknown_help(name), ..problem });
            continue;
        };
        let limits = |value: &Value| serde_json::from_value::<Limits>(value.clone()).ok();
        entry.push((
            parameter,
            match wanted {
                Value::Array(values) => Wanted::OneOf(values.clone()),
                Value::Object(_) => match limits(wanted)
                    .filter(|limits| limits.from.is_some() || limits.to.is_some())
                {
                    Some(limits) if parameter.is_number() => Wanted::Between(limits),
                    Some(_) => {
                        problems.push(
                            source.problem(&path, "expected a list of values, because it is no number"),
                        );
                        continue;
                    }
                    None => {
                        problems.push(
                            source.problem(&path, "expected { \"from\": a, \"to\": b }, or one of the two"),
                        );
                        continue;
                    }
                },
                value => Wanted::OneOf(vec![value.clone()]),
            },
        ));
    }
    if problems.is_empty() { Ok(entry) } else { Err(problems) }
}

//! Points of a study that are no grid: given one by one, from a file, walked through lists together, or drawn by a design.

mod design;
pub(super) mod distribution;
mod file;
pub(super) mod given;

pub(super) use file::with_points;

use super::axis::{Axis, check_type};
use super::error::Problem;
use super::limits::MAX_JOBS;
use super::locate::join;
use super::parameter::{Kind, Parameter, unknown_help};
use super::source::SourceText;
use design::{Design, MOST_SOBOL, MOST_SOBOL_PARAMETERS};
use distribution::Distribution;
use given::SamplesFile;
use serde_json::{Map, Value, json};
use std::collections::HashSet;

/// Points with values of the same parameters.
#[derive(Debug, Clone)]
pub(super) struct Samples {
    pub parameters: Vec<&'static Parameter>,
    /// The values of each point, in the order of the parameters.
    pub rows: Vec<Vec<Value>>,
    /// The distributions of a design, in the order of the parameters; none without a design.
    pub distributions: Vec<Distribution>,
    /// As a study file has them.
    written: Value,
}

/// So many points of Sobol's sequence in the unit cube.
pub(super) fn sobol_points(count: usize, parameters: usize, seed: u64) -> Vec<Vec<f64>> {
    Design::Sobol.unit_points(count.min(MOST_SOBOL), parameters, seed)
}

/// The field of a study file.
const SAMPLES: &str = "samples";

impl SamplesFile {
    /// The points, with every value checked for its type.
    pub fn read(&self, template: &Value, source: &SourceText) -> Result<Samples, Vec<Problem>> {
        let refuse = |field: &str, message: String| {
            let path = if field.is_empty() { SAMPLES.to_owned() } else { join(SAMPLES, field) };
            Err(vec![source.problem(&path, message)])
        };
        let forms = [
            ("points", self.points.is_some()),
            ("zip", self.zip.is_some()),
            ("file", self.file.is_some()),
            ("design", self.design.is_some()),
        ];
        let given: Vec<&str> =
            forms.iter().filter(|(_, is_given)| *is_given).map(|(name, _)| *name).collect();
        if given.len() != 1 {
            return refuse("", "expected exactly one of points, zip, file and design".to_owned());
        }
        if self.design.is_none() {
            let others =
                [("count", self.count.is_some()), ("seed", self.seed.is_some()), ("of", self.of.is_some())];
            if let Some((name, _)) = others.into_iter().find(|(_, is_given)| *is_given) {
                return refuse(name, "expected it beside `design` only".to_owned());
            }
        }
        let mut distributions = Vec::new();
        let (parameters, rows) = match (&self.points, &self.zip, self.design) {
            (Some(points), ..) => listed(points, template, source)?,
            (_, Some(zip), _) => zipped(zip, template, source)?,
            (.., Some(design)) => self.drawn(design, template, source, &mut distributions)?,
            // A file has been read before.
            _ => return refuse("file", "expected a study that is read from a file".to_owned()),
        };
        let written = serde_json::to_value(self).expect("plain data with string keys");
        Ok(Samples { parameters, rows, distributions, written })
    }

    fn drawn(
        &self,
        design: Design,
        template: &Value,
        source: &SourceText,
        distributions: &mut Vec<Distribution>,
    ) -> Result<Table, Vec<Problem>> {
        let refuse = |field: &str, message: &str| Err(vec![source.problem(&join(SAMPLES, field), message)]);
        let Some(of) = self.of.as_ref().filter(|of| !of.is_empty()) else {
            return refuse(
                "of",
                "expected parameters with distributions, such as { \"mu\": { \"uniform\": [0.1, 0.6] } }",
            );
        };
        let Some(count) = self.count.filter(|count| (1..=MAX_JOBS).contains(count)) else {
            return refuse("count", &format!("expected a number of points from 1 to {MAX_JOBS}"));
        };
        if design == Design::Sobol && count > MOST_SOBOL {
            return refuse("count", &format!("expected at most {MOST_SOBOL} points of Sobol's sequence"));
        }
        if design == Design::Sobol && of.len() > MOST_SOBOL_PARAMETERS {
            return refuse("of", &format!("expected at most {MOST_SOBOL_PARAMETERS} parameters"));
        }
        let field = join(SAMPLES, "of");
        let parameters = known(of.keys(), &field, source)?;
        let mut problems = Vec::new();
        for parameter in &parameters {
            let path = join(&field, parameter.name);
            let Ok(distribution) = serde_json::from_value::<Distribution>(of[parameter.name].clone()) else {
                let message = "expected one distribution: uniform [low, high], log_uniform [low, high], normal [mean, standard \
                               deviation], truncated_normal [mean, standard deviation, low, high] or discrete [values]";
                problems.push(source.problem(&path, message));
                continue;
            };
            if let Some(message) = distribution.problem(&parameter.kind) {
                problems.push(source.problem(&path, message));
            } else if design == Design::Morris && !distribution.is_bounded() {
                let message =
                    "expected truncated_normal: a design of Morris goes from end to end of a distribution";
                problems.push(source.problem(&path, message));
            }
            if let Distribution::Discrete(values) = &distribution {
                for value in values {
                    if let Err(message) = check_type(parameter, value, template) {
                        problems.push(source.problem(&path, message).with_help(parameter.help()));
                    }
                }
            }
            distributions.push(distribution);
        }
        if !problems.is_empty() {
            return Err(problems);
        }
        let points = design.unit_points(count, parameters.len(), self.seed.unwrap_or(0));
        // The coordinates belong to the names in alphabetical order: a document that is written again may have another order.
        let mut names: Vec<&str> = parameters.iter().map(|parameter| parameter.name).collect();
        names.sort_unstable();
        let coordinate_of = |parameter: &Parameter| names.partition_point(|name| *name < parameter.name);
        let row = |point: Vec<f64>| {
            let value = |(parameter, distribution): (&&'static Parameter, &Distribution)| {
                distribution.value(point[coordinate_of(parameter)], &parameter.kind)
            };
            parameters.iter().zip(distributions.iter()).map(value).collect()
        };
        let rows = points.into_iter().map(row).collect();
        Ok((parameters, rows))
    }
}

/// Parameters and the values of each point.
type Table = (Vec<&'static Parameter>, Vec<Vec<Value>>);

/// The parameters of some names, of which no two set the same field, in the order of the file.
fn known<'a>(
    names: impl Iterator<Item = &'a String>,
    field: &str,
    source: &SourceText,
) -> Result<Vec<&'static Parameter>, Vec<Problem>> {
    let mut names: Vec<&String> = names.collect();
    names.sort_by_key(|name| source.key_position(&join(field, name)));
    let mut parameters: Vec<&'static Parameter> = Vec::new();
    let mut problems = Vec::new();
    for name in names {
        let path = join(field, name);
        let Some(parameter) = Parameter::find(name) else {
            let problem = source.problem_with_name(&path, "no such parameter");
            problems.push(Problem { help: unknown_help(name), ..problem });
            continue;
        };
        if let Some(other) = parameters.iter().find(|other| other.overlaps(parameter)) {
            let message = format!("sets the same field as {}; expected only one of the two", other.name);
            problems.push(source.problem_with_name(&path, message));
        }
        parameters.push(parameter);
    }
    if problems.is_empty() { Ok(parameters) } else { Err(problems) }
}

fn listed(
    points: &[Map<String, Value>],
    template: &Value,
    source: &SourceText,
) -> Result<Table, Vec<Problem>> {
    let field = join(SAMPLES, "points");
    let Some(first) = points.first().filter(|point| !point.is_empty()) else {
        let message = "expected at least one point, such as { \"mu\": 0.3, \"omega_rpm\": 7 }";
        return Err(vec![source.problem(&field, message)]);
    };
    let parameters = known(first.keys(), &format!("{field}[0]"), source)?;
    let mut checked = HashSet::new();
    let mut problems = Vec::new();
    let mut rows = Vec::with_capacity(points.len());
    for (number, point) in points.iter().enumerate() {
        let path = format!("{field}[{number}]");
        if point.len() != parameters.len()
            || !parameters.iter().all(|parameter| point.contains_key(parameter.name))
        {
            let names: Vec<&str> = parameters.iter().map(|parameter| parameter.name).collect();
            let message = format!("expected values of {}, as in the first point", names.join(", "));
            problems.push(source.problem(&path, message));
            continue;
        }
        let mut row = Vec::with_capacity(parameters.len());
        for parameter in &parameters {
            let value = parameter.normalise(point[parameter.name].clone());
            let path = join(&path, parameter.name);
            problems.extend(problem(parameter, &value, &path, template, source, &mut checked));
            row.push(value);
        }
        rows.push(row);
    }
    if problems.is_empty() { Ok((parameters, rows)) } else { Err(problems) }
}

/// What is wrong with the type of a value; none if it is right. A value is looked at once for each parameter, and finite numbers of
/// parameters that are numbers need no look.
fn problem(
    parameter: &'static Parameter,
    value: &Value,
    path: &str,
    template: &Value,
    source: &SourceText,
    checked: &mut HashSet<(&'static str, String)>,
) -> Option<Problem> {
    if matches!(parameter.kind, Kind::Number) && value.is_number() {
        return None;
    }
    let own = (parameter.name, value.to_string());
    if checked.contains(&own) {
        return None;
    }
    if let Err(message) = check_type(parameter, value, template) {
        return Some(source.problem(path, message).with_help(parameter.help()));
    }
    checked.insert(own);
    None
}

fn zipped(zip: &Map<String, Value>, template: &Value, source: &SourceText) -> Result<Table, Vec<Problem>> {
    let field = join(SAMPLES, "zip");
    if zip.is_empty() {
        let message =
            "expected lists of equal lengths, such as { \"mu\": [0.2, 0.4], \"omega_rpm\": [7, 20] }";
        return Err(vec![source.problem(&field, message)]);
    }
    let parameters = known(zip.keys(), &field, source)?;
    let mut columns = Vec::new();
    for parameter in &parameters {
        columns.push(Axis::column(
            parameter,
            &zip[parameter.name],
            &join(&field, parameter.name),
            template,
            source,
        )?);
    }
    let length = columns[0].len();
    if let Some(other) = columns.iter().position(|column| column.len() != length) {
        let message = format!(
            "expected {length} values, as many as {} has; it has {}",
            parameters[0].name,
            columns[other].len()
        );
        return Err(vec![source.problem(&join(&field, parameters[other].name), message)]);
    }
    let rows = (0..length).map(|row| columns.iter().map(|column| column[row].clone()).collect()).collect();
    Ok((parameters, rows))
}

impl Samples {
    /// As a study file has them.
    pub fn written(&self) -> &Value {
        &self.written
    }

    /// The different values of a parameter, in the order of the points.
    pub fn values(&self, column: usize) -> Vec<Value> {
        let mut known = HashSet::new();
        let values = self.rows.iter().map(|row| &row[column]);
        values.filter(|value| known.insert(value.to_string())).cloned().collect()
    }

    /// Without the parameters that something else decides; none if nothing is left.
    pub fn without(mut self, is_decided: impl Fn(&Parameter) -> bool) -> Option<Self> {
        let kept: Vec<usize> =
            (0..self.parameters.len()).filter(|&at| !is_decided(self.parameters[at])).collect();
        if kept.len() == self.parameters.len() {
            return Some(self);
        }
        if kept.is_empty() {
            return None;
        }
        self.parameters = kept.iter().map(|&at| self.parameters[at]).collect();
        // What is left is a list of points.
        self.distributions.clear();
        let mut known = HashSet::new();
        let rows =
            self.rows.iter().map(|row| -> Vec<Value> { kept.iter().map(|&at| row[at].clone()).collect() });
        self.rows = rows.filter(|row| known.insert(Value::from(row.clone()).to_string())).collect();
        let names = self.parameters.iter().map(|parameter| parameter.name);
        let columns = names.enumerate().map(|(at, name)| {
            let column: Vec<&Value> = self.rows.iter().map(|row| &row[at]).collect();
            (name.to_owned(), json!(column))
        });
        self.written = json!({ "zip": columns.collect::<Map<String, Value>>() });
        Some(self)
    }
}

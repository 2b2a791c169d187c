//! The study of a calibration: free parameters, whose points are drawn at all measured points.

use super::axis::Axis;
use super::calibrate::{Calibrate, Calibration, Discrepancy, EXAMPLE, FIRST_POINTS, wave_points};
use super::definition::Study;
use super::error::{Problem, StudyError};
use super::file::StudyFile;
use super::grid::Grid;
use super::growth::Growth;
use super::outline::Outline;
use super::parameter::{Parameter, unknown_help};
use super::samples::distribution::Distribution;
use super::samples::given::SamplesFile;
use super::source::{Change, GROWTH, SourceText};
use super::suggest::nearest_name;
use crate::spec::Limit;
use serde_json::{Map, Value, json};

/// A parameter that measured points are to tell.
#[derive(Debug, Clone)]
pub struct FreeParameter {
    /// The parameter.
    pub parameter: &'static Parameter,
    distribution: Distribution,
}

impl FreeParameter {
    /// The value below which a share of its distribution lies.
    pub fn value(&self, share: f64) -> Value {
        self.distribution.value(share, &self.parameter.kind)
    }

    /// Whether a job can have the value below which a share of its distribution lies.
    pub fn is_possible(&self, share: f64) -> bool {
        let value = self.value(share).as_f64();
        value.is_some_and(|value| Limit::of(&self.parameter.field()).is_none_or(|limit| limit.holds(value)))
    }

    /// Whether its distribution has two ends.
    pub fn has_ends(&self) -> bool {
        self.distribution.is_bounded()
    }

    /// The share of its distribution below a value.
    pub fn share(&self, value: f64) -> f64 {
        self.distribution.share(value)
    }
}

impl Study {
    /// The parameters that `samples` draws, with their distributions, in the order of the file; none without a design.
    pub fn free_parameters(&self) -> Vec<FreeParameter> {
        let Some(samples) = &self.grid.samples else { return Vec::new() };
        let all = samples.parameters.iter().zip(&samples.distributions);
        all.map(|(parameter, distribution)| FreeParameter { parameter, distribution: distribution.clone() })
            .collect()
    }
}

/// So many points of Sobol's sequence in a unit cube. Another seed gives other points.
pub fn sobol_points(count: usize, parameters: usize, seed: u64) -> Vec<Vec<f64>> {
    super::samples::sobol_points(count, parameters, seed)
}

/// What is wrong with a calibration in a study with these points.
pub(super) fn problems(own: &Calibrate, grid: &Grid, source: &SourceText) -> Vec<Problem> {
    let Some(samples) = grid.samples.as_ref().filter(|own| !own.distributions.is_empty()) else {
        let message = "expected `samples` with a `design` and distributions of the free parameters";
        return vec![source.problem("calibrate", message).with_help(EXAMPLE)];
    };
    let is_list = |own: &Distribution| matches!(own, Distribution::Discrete(_));
    if let Some(at) = samples.distributions.iter().position(is_list) {
        let field = format!("samples.of.{}", samples.parameters[at].name);
        let message = "expected a distribution of numbers, such as uniform [low, high]: a calibration looks between values";
        return vec![source.problem(&field, message)];
    }
    let along: Vec<_> = grid.axes.iter().map(|axis| (axis.parameter, axis.values.as_slice())).collect();
    own.problems((&samples.parameters, samples.rows.len()), &along, source)
}

impl Outline {
    /// Makes it the study of the free parameters: Sobol points of them at all measured points, and further ones where the data say so.
    pub(super) fn ask_for_calibration(
        &mut self,
        asked: &Calibration,
        own: Option<&Calibrate>,
        has_name: bool,
    ) -> Result<Growth, StudyError> {
        let refuse = |problem: Problem| Err(StudyError::Invalid(vec![problem]));
        let given = self.name().map_err(StudyError::Invalid)?;
        let name = if has_name { given } else { format!("{given}-calibration") };
        let of = self.document.pointer("/samples/of").and_then(Value::as_object).cloned();
        let Some(of) = of.filter(|of| !of.is_empty()) else {
            let message = "expected distributions of the free parameters";
            return refuse(self.source.problem("samples.of", message).with_help(EXAMPLE));
        };
        for name in &asked.free {
            if !of.contains_key(name) {
                let message = "expected a parameter with a distribution in samples.of";
                let near = nearest_name(name, of.keys().map(String::as_str));
                let mut help = match near {
                    Some(near) => vec![format!("did you mean `{near}`?")],
                    None if Parameter::find(name).is_none() => unknown_help(name),
                    None => Vec::new(),
                };
                help.push(format!("samples.of has {}", of.keys().cloned().collect::<Vec<_>>().join(", ")));
                return refuse(Problem { help, ..Problem::of_change("--free", "free", name, message) });
            }
        }
        let is_free = |name: &String| asked.free.is_empty() || asked.free.contains(name);
        let of: Map<String, Value> = of.into_iter().filter(|(name, _)| is_free(name)).collect();
        let Some(data) = asked.data.clone().or_else(|| own.map(|own| own.data.clone())) else {
            let message = "expected measured points";
            let help = "give a CSV file with --data";
            return refuse(self.source.problem("calibrate", message).with_help(help));
        };
        let measured =
            |axis: &&Axis| data.first().is_none_or(|point| point.at.contains_key(axis.parameter.name));
        if let Some(axis) = self.grid.axes.iter().find(|axis| !measured(axis) && axis.values.len() > 1) {
            let message = "the measured points have no value of it; expected a grid without it, or a column of the data";
            return refuse(self.source.problem(&axis.path(), message));
        }
        // An axis with one value says what every point has.
        let single: Vec<Axis> = self.grid.axes.iter().filter(|axis| !measured(axis)).cloned().collect();
        for axis in single {
            self.grid.axes.retain(|other| other.parameter != axis.parameter);
            axis.parameter.set(&mut self.document, &axis.values[0]);
        }
        let calibrate = Calibrate {
            data,
            discrepancy: asked.discrepancy.over(own.map_or_else(Discrepancy::default, |own| own.discrepancy)),
            most_points: asked.most_points.or_else(|| own.and_then(|own| own.most_points)),
            wave_points: own.map_or_else(wave_points, |own| own.wave_points),
        };
        let first = (FIRST_POINTS * of.len()).min(calibrate.most_points(of.len()).max(1));
        let seed = self.document.pointer("/samples/seed").cloned().unwrap_or_else(|| 0.into());
        let samples = json!({ "design": "sobol", "count": first, "seed": seed, "of": of });
        self.source.changes.push(Change::of_name("", &name));
        // What the study itself says of measured points keeps its place in messages.
        if asked.data.is_some() {
            self.source.changes.push(Change::of_growth("--data", "the measured points"));
        }
        let read: SamplesFile =
            serde_json::from_value(samples.clone()).expect("the fields are those of samples");
        let read = read.read(&StudyFile::template(), &self.source).map_err(StudyError::Invalid)?;
        self.grid.samples = Some(read);
        if let Value::Object(fields) = &mut self.document {
            fields.retain(|name, _| !GROWTH.contains(&name.as_str()));
            fields.insert("name".to_owned(), name.into());
            fields.insert("samples".to_owned(), samples);
            fields.insert("calibrate".to_owned(), json!(calibrate));
        }
        Ok(Growth { calibrate: Some(calibrate), ..Growth::default() })
    }
}

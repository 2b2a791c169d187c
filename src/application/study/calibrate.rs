//! Studies that are calibrated: what a study file says about measured points and the parameters that they are to tell.

use super::error::Problem;
use super::grid_schema::measured_schema;
use super::json::present;
use super::parameter::{Kind, Parameter};
use super::source::SourceText;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Measured points, which rule out values of the parameters that `samples` draws. The program adds points of these parameters, wave by wave,
/// until their region is known. The jobs of a point are those at all measured points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Calibrate {
    /// What was measured.
    pub data: Vec<MeasuredPoint>,
    /// What the model cannot explain, however its parameters are chosen, as one standard deviation.
    #[serde(default)]
    pub discrepancy: Discrepancy,
    /// Largest number of points of the free parameters, with those of `samples`. Absent: 30 for each free parameter.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "usize")]
    pub most_points: Option<usize>,
    /// Largest number of points that are added at a time.
    #[serde(default = "wave_points")]
    pub wave_points: usize,
}

/// A measured point: its parameters, and what was measured there.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MeasuredPoint {
    /// The values of the parameters that the grid varies.
    #[schemars(schema_with = "measured_schema")]
    pub at: Map<String, Value>,
    /// Macroscopic friction coefficient.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub mu_star: Option<f64>,
    /// Its standard deviation.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub mu_star_error: Option<f64>,
    /// Frequency of the limit cycle (Hz).
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub frequency_hz: Option<f64>,
    /// Its standard deviation (Hz).
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub frequency_error_hz: Option<f64>,
    /// Whether it squeals. Absent: it does if there is a frequency, and else it is not known.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "bool")]
    pub squeals: Option<bool>,
}

/// What a model leaves open, as shares of the measured values.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Discrepancy {
    /// Of μ*.
    pub mu_star: f64,
    /// Of the frequency.
    pub frequency: f64,
}

/// How the parameters of a calibration are given.
pub(super) const EXAMPLE: &str = "for example \"samples\": { \"design\": \"sobol\", \"count\": 20, \"of\": { \"mu\": { \"uniform\": [0.2, 0.6] } } }";

pub(super) fn wave_points() -> usize {
    8
}

/// Points of each free parameter, if a study does not say how many.
const MOST_POINTS: usize = 30;

/// First points of each free parameter that the command asks for: ten times the number of parameters are what emulators are usually begun
/// with (Loeppky, Sacks and Welch, Technometrics 51, 2009).
pub const FIRST_POINTS: usize = 10;

/// The largest number of points, for which emulators are fast.
const LARGEST: usize = 1000;

impl MeasuredPoint {
    /// Whether another point has the same parameters. 5 and 5.0 are one number.
    fn is_at(&self, other: &Self) -> bool {
        let same = |a: &Value, b: &Value| a == b || a.is_number() && a.as_f64() == b.as_f64();
        self.at.len() == other.at.len()
            && self.at.iter().all(|(name, value)| other.at.get(name).is_some_and(|own| same(value, own)))
    }

    /// Whether it squeals, if that is known.
    pub fn squeals(&self) -> Option<bool> {
        self.squeals.or(self.frequency_hz.map(|_| true))
    }
}

impl Calibrate {
    /// Largest number of points of so many free parameters.
    pub fn most_points(&self, free: usize) -> usize {
        self.most_points.unwrap_or(MOST_POINTS * free)
    }

    /// What is wrong with it in a study that draws `first` points of the parameters `free`, and varies those of `along` besides.
    pub(super) fn problems(
        &self,
        (free, first): (&[&'static Parameter], usize),
        along: &[(&'static Parameter, &[Value])],
        source: &SourceText,
    ) -> Vec<Problem> {
        let mut found = Vec::new();
        for parameter in free.iter().filter(|own| !matches!(own.kind, Kind::Number)) {
            let message =
                format!("{}: expected free parameters that are numbers with decimals", parameter.name);
            found.push(source.problem("samples.of", message));
        }
        let most = self.most_points(free.len());
        if !(first..=LARGEST).contains(&most) {
            let message = format!(
                "expected a number of points from {first}, those of `samples`, to {LARGEST}; it is {most}"
            );
            found.push(source.problem("calibrate.most_points", message));
        }
        if !(1..=LARGEST).contains(&self.wave_points) {
            let message = format!("expected a number of points from 1 to {LARGEST}");
            found.push(source.problem("calibrate.wave_points", message));
        }
        for (field, share) in
            [("mu_star", self.discrepancy.mu_star), ("frequency", self.discrepancy.frequency)]
        {
            if !(0.0..1.0).contains(&share) {
                let message = "expected a share of the measured value, at least 0 and below 1";
                found.push(source.problem(&format!("calibrate.discrepancy.{field}"), message));
            }
        }
        if self.data.is_empty() {
            found.push(source.problem("calibrate.data", "expected at least one measured point"));
        }
        for (number, point) in self.data.iter().enumerate() {
            let field = format!("calibrate.data[{number}]");
            found.extend(point.problems(&field, along, source));
            let is_twice = self.data[..number].iter().any(|other| other.is_at(point));
            if is_twice {
                let message = "an earlier point has the same parameters; expected their mean";
                found.push(source.problem(&format!("{field}.at"), message));
            }
        }
        found
    }
}

impl MeasuredPoint {
    fn problems(
        &self,
        field: &str,
        along: &[(&'static Parameter, &[Value])],
        source: &SourceText,
    ) -> Vec<Problem> {
        let mut found = Vec::new();
        let mut refuse = |name: &str, message: String| {
            let path = if name.is_empty() { field.to_owned() } else { format!("{field}.{name}") };
            found.push(source.problem(&path, message));
        };
        let values = [
            ("mu_star", self.mu_star, "mu_star_error", self.mu_star_error),
            ("frequency_hz", self.frequency_hz, "frequency_error_hz", self.frequency_error_hz),
        ];
        for (name, value, of_error, error) in values {
            match (value, error) {
                (Some(value), _) if !(value > 0.0 && value.is_finite()) => {
                    refuse(name, "expected a number > 0".to_owned());
                }
                (Some(_), None) => refuse(
                    "",
                    format!("{name} has no {of_error}; without an error, nothing can be ruled out by it"),
                ),
                (_, Some(error)) if !(error > 0.0 && error.is_finite()) => {
                    refuse(of_error, "expected a number > 0".to_owned());
                }
                (None, Some(_)) => refuse(of_error, format!("expected `{name}` beside it")),
                _ => {}
            }
        }
        if self.frequency_hz.is_some() && self.squeals == Some(false) {
            refuse(
                "squeals",
                "what does not squeal has no frequency; expected true, or no frequency".to_owned(),
            );
        }
        if self.mu_star.is_none() && self.frequency_hz.is_none() && self.squeals.is_none() {
            refuse("", "expected mu_star, frequency_hz or squeals".to_owned());
        }
        let names: Vec<&str> = along.iter().map(|(parameter, _)| parameter.name).collect();
        if self.at.len() != names.len() || !names.iter().all(|name| self.at.contains_key(*name)) {
            let wanted = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            refuse("at", format!("expected a value of each parameter that `grid` varies: {wanted}"));
            return found;
        }
        for (parameter, values) in along {
            let own = parameter.normalise(self.at[parameter.name].clone());
            if !values.contains(&own) {
                let message =
                    format!("expected a value of grid.{}: there are no jobs for it", parameter.name);
                refuse(&format!("at.{}", parameter.name), message);
            }
        }
        found
    }
}

/// Parts of a discrepancy that a command gives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DiscrepancyGiven {
    /// Of μ*.
    pub mu_star: Option<f64>,
    /// Of the frequency.
    pub frequency: Option<f64>,
}

impl DiscrepancyGiven {
    /// The parts that are given, and the others of `own`.
    pub(super) fn over(self, own: Discrepancy) -> Discrepancy {
        Discrepancy {
            mu_star: self.mu_star.unwrap_or(own.mu_star),
            frequency: self.frequency.unwrap_or(own.frequency),
        }
    }
}

/// A calibration that a command asks for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Calibration {
    /// The names of the free parameters, all of `samples.of`; the others have their values of the scene. Empty: all that are there.
    pub free: Vec<String>,
    /// What was measured; none if the study says it.
    pub data: Option<Vec<MeasuredPoint>>,
    /// Instead of that of the study, where it is given.
    pub discrepancy: DiscrepancyGiven,
    /// Instead of that of the study.
    pub most_points: Option<usize>,
}

//! Studies that grow: what a study file says about jobs that depend on the results of others.

use super::calibrate::Calibrate;
use super::error::Problem;
use super::limits::MAX_JOBS;
use super::parameter::{Kind, PARAMETERS, Parameter};
use super::source::{GROWTH, SourceText};
use super::suggest::nearest_name;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

/// Where the program adds points by itself, wave by wave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Refine {
    /// Curves of a quantity over a parameter, until they are known well enough.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curves: Option<Curves>,
    /// Boundaries between jobs of different kinds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boundaries: Option<Boundaries>,
    /// Largest number of jobs of the study, with those of its grid.
    pub most_jobs: usize,
    /// Largest number of jobs that are added at a time. It is a part of the plan: another number gives other points.
    pub wave_jobs: usize,
}

impl Default for Refine {
    fn default() -> Self {
        Self { curves: None, boundaries: None, most_jobs: 1_000, wave_jobs: 64 }
    }
}

/// Curves of a quantity over a parameter: one for each combination of the other parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Curves {
    /// The parameter along the curves: one that the grid varies.
    #[schemars(schema_with = "number_schema")]
    pub over: String,
    /// The quantity: a column of the export.
    #[serde(default = "mu_star")]
    pub of: String,
    /// The error of straight lines between neighbouring points, as the second differences estimate it, is to be at most this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// The smallest value of each curve is to lie so near to its neighbours, in the unit of the parameter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum_within: Option<f64>,
    /// Intervals that are not longer than this are not divided for `within`. Absent: `minimum_within`, or a thousandth of the range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub finest: Option<f64>,
}

/// What the two sides of a boundary differ in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Whether steady sliding is stable: by the growth rate where eigenvalues were computed, and else by how the run ended.
    #[default]
    Stability,
    /// The contact regime.
    Regime,
    /// The status: how the job ended.
    Status,
}

/// Boundaries along a parameter: one line for each combination of the other parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Boundaries {
    /// The parameter along which a boundary is looked for: one that the grid varies.
    #[schemars(schema_with = "number_schema")]
    pub over: String,
    /// What the two sides differ in.
    #[serde(default)]
    pub between: Side,
    /// Width within which each boundary is to be known, in the unit of the parameter. Exactly one of `within` and `within_share` is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// The same as a share of the value at the boundary. Near zero a boundary is known to 1/4096 of the distance of the points of
    /// the grid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within_share: Option<f64>,
    /// Neighbours that are further from each other get points in equal steps first. Absent: they get none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_step: Option<f64>,
}

/// Jobs that begin in the motion with which another one ended. Exactly one of `along` and `kicks` is given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Continue {
    /// The parameter along which each job continues its neighbour: one that the grid varies.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "number_schema")]
    pub along: Option<String>,
    /// Ways along that parameter.
    pub directions: Vec<Direction>,
    /// Number of jobs that continue each point of the study with different random velocities, to find its limit cycles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kicks: Option<u32>,
    /// Root mean square (m/s) of the velocities that are added at the beginning of a job. Absent: 10⁻⁴ m/s along a parameter, so
    /// that unstable sliding is left; needed with `kicks`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kick_m_s: Option<f64>,
}

impl Default for Continue {
    fn default() -> Self {
        Self { along: None, directions: vec![Direction::Up, Direction::Down], kicks: None, kick_m_s: None }
    }
}

/// A way along a parameter.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    JsonSchema,
    strum::IntoStaticStr,
    strum::EnumString,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Direction {
    /// From the smallest value to the largest.
    Up,
    /// From the largest value to the smallest.
    Down,
}

impl Direction {
    /// The name used in study files and tables.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// The name under which rows have their direction.
pub const DIRECTION: &str = "direction";

/// The name under which rows have the number of their kick: 0 for the job that is kicked.
pub const KICK: &str = "kick";

/// Velocity that takes a chain away from unstable sliding \[m/s\]: below a thousandth of usual sliding speeds.
const CHAIN_KICK_M_S: f64 = 1.0e-4;

/// Most jobs of a wave: the lanes of a thousand cores.
pub const MOST_WAVE_JOBS: usize = 10_000;

/// How a study grows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Growth {
    /// Points that are added where they are needed.
    pub refine: Option<Refine>,
    /// Jobs that continue others.
    pub continues: Option<Continue>,
    /// Points that measured values do not rule out.
    pub calibrate: Option<Calibrate>,
}

fn mu_star() -> String {
    "mu_star".to_owned()
}

fn number_schema(_: &mut SchemaGenerator) -> Schema {
    let numbers = PARAMETERS
        .iter()
        .filter(|parameter| matches!(parameter.kind, Kind::Number))
        .map(|parameter| parameter.name);
    json_schema!({ "type": "string", "enum": numbers.collect::<Vec<_>>() })
}

impl Growth {
    /// Whether there is any.
    pub fn is_any(&self) -> bool {
        self.refine.is_some() || self.continues.is_some() || self.calibrate.is_some()
    }

    /// What is wrong with it in a study that varies these parameters and has `size` points. The names of quantities are not known here.
    pub(super) fn problems(
        &self,
        varied: &[&'static Parameter],
        size: usize,
        source: &SourceText,
    ) -> Vec<Problem> {
        let mut found = Vec::new();
        if let Some(refine) = self.refine.as_ref().filter(|own| !(size..=MAX_JOBS).contains(&own.most_jobs)) {
            let message = format!(
                "expected a number of jobs from {size}, those of the grid, to {MAX_JOBS}; it is {}",
                refine.most_jobs
            );
            found.push(source.problem("refine.most_jobs", message));
        }
        let most_kicks = MAX_JOBS / size.max(1) - 1;
        if self.continues.as_ref().and_then(|own| own.kicks).is_some_and(|kicks| kicks as usize > most_kicks)
        {
            let message =
                format!("expected at most {most_kicks}, so that the study has at most {MAX_JOBS} jobs");
            found.push(source.problem("continue.kicks", message));
        }
        let given = [self.refine.is_some(), self.continues.is_some(), self.calibrate.is_some()];
        let mut given = GROWTH.into_iter().zip(given).filter(|(_, is_given)| *is_given);
        if let (Some((first, _)), Some((second, _))) = (given.next(), given.next()) {
            found.push(source.problem(second, format!("expected only one of `{first}` and `{second}`")));
        }
        let mut along = |field: &str, name: &str| {
            let numbers = || varied.iter().filter(|parameter| matches!(parameter.kind, Kind::Number));
            if !numbers().any(|parameter| parameter.name == name) {
                let problem = source.problem(field, "expected a number with decimals that the study varies");
                let names: Vec<_> = numbers().map(|parameter| parameter.name).collect();
                let nearest = nearest_name(name, names.iter().copied());
                let mut help: Vec<_> =
                    nearest.into_iter().map(|name| format!("did you mean `{name}`?")).collect();
                help.push(format!(
                    "it varies {}",
                    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
                ));
                found.push(Problem { help, ..problem });
            }
        };
        if let Some(curves) = self.refine.as_ref().and_then(|refine| refine.curves.as_ref()) {
            along("refine.curves.over", &curves.over);
        }
        if let Some(boundaries) = self.refine.as_ref().and_then(|refine| refine.boundaries.as_ref()) {
            along("refine.boundaries.over", &boundaries.over);
        }
        if let Some(name) = self.continues.as_ref().and_then(|own| own.along.as_deref()) {
            along("continue.along", name);
        }
        let mut positive = |field: &str, value: Option<f64>| {
            if value.is_some_and(|value| !(value > 0.0 && value.is_finite())) {
                found.push(source.problem(field, "expected a number > 0"));
            }
        };
        if let Some(Refine { curves, boundaries, .. }) = &self.refine {
            if let Some(curves) = curves {
                positive("refine.curves.within", curves.within);
                positive("refine.curves.minimum_within", curves.minimum_within);
                positive("refine.curves.finest", curves.finest);
            }
            if let Some(boundaries) = boundaries {
                positive("refine.boundaries.within", boundaries.within);
                positive("refine.boundaries.within_share", boundaries.within_share);
                positive("refine.boundaries.largest_step", boundaries.largest_step);
            }
        }
        positive("continue.kick_m_s", self.continues.as_ref().and_then(|own| own.kick_m_s));
        if let Some(refine) = &self.refine {
            refine.add_problems(source, &mut found);
        }
        if let Some(own) = &self.continues {
            own.add_problems(source, &mut found);
        }
        found
    }
}

impl Refine {
    fn add_problems(&self, source: &SourceText, found: &mut Vec<Problem>) {
        if self.curves.is_none() && self.boundaries.is_none() {
            found.push(source.problem("refine", "expected `curves`, `boundaries`, or both"));
        }
        if self.curves.as_ref().is_some_and(|own| own.within.is_none() && own.minimum_within.is_none()) {
            found.push(source.problem("refine.curves", "expected `within`, `minimum_within`, or both"));
        }
        if self.boundaries.as_ref().is_some_and(|own| own.within.is_some() == own.within_share.is_some()) {
            found.push(source.problem("refine.boundaries", "expected either `within` or `within_share`"));
        }
        if !(1..=MOST_WAVE_JOBS).contains(&self.wave_jobs) {
            let message = format!("expected a number of jobs from 1 to {MOST_WAVE_JOBS}");
            found.push(source.problem("refine.wave_jobs", message));
        }
    }
}

impl Continue {
    fn add_problems(&self, source: &SourceText, found: &mut Vec<Problem>) {
        match (&self.along, self.kicks) {
            (None, None) | (Some(_), Some(_)) => {
                found.push(source.problem("continue", "expected either `along` or `kicks`"));
            }
            (None, Some(kicks)) => {
                if kicks == 0 {
                    found.push(source.problem("continue.kicks", "expected at least 1"));
                }
                if self.kick_m_s.is_none() {
                    let message = "expected `kick_m_s`, a speed to be compared with that of sliding";
                    found.push(source.problem("continue", message));
                }
            }
            (Some(_), None) => {}
        }
        let repeated =
            self.directions.iter().enumerate().any(|(at, own)| self.directions[..at].contains(own));
        if self.directions.is_empty() || repeated {
            found.push(source.problem("continue.directions", "expected `up`, `down`, or both"));
        }
    }
}

impl Continue {
    /// The velocity that is added at the beginning of each job \[m/s\].
    pub fn kick_m_s(&self) -> f64 {
        self.kick_m_s.unwrap_or(CHAIN_KICK_M_S)
    }
}

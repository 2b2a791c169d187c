//! Warnings about studies that can be run, but hardly mean what their author wants: strains beyond the linear model,
//! values in another unit, grids whose jobs repeat each other. A warning never keeps a study from running.

mod physics;
mod similarity;
mod units;
mod unused;

use super::definition::Study;
use super::error::Problem;
use super::json::encode;
use super::validate::assignments;
use crate::spec::JobSpec;
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;
use std::fmt;

pub(super) use physics::refused_strain;

/// What a warning is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum About {
    /// The result: it may not be what the author wants to know.
    Result,
    /// The cost alone: the result is right, and could be had for less.
    Cost,
}

/// Something in a study that is allowed and yet doubtful. Displayed like a [`Problem`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Warning {
    /// What is doubtful, in one word: `unit`, `size`, `friction`, `strain`, `speed`, `locking`, `damping`, `two_dampings`, `mesh_error`, `disk_mesh`, `clamp`, `unused` or `repetition`.
    pub kind: &'static str,
    /// Whether it is about the result or the cost.
    pub about: About,
    /// Number of jobs that it concerns; a job that appears twice in the grid counts twice.
    pub jobs: usize,
    /// Place, value, message and advice.
    #[serde(flatten)]
    pub problem: Problem,
}

impl Warning {
    fn new(kind: &'static str, jobs: usize, problem: Problem) -> Self {
        let about = if matches!(kind, "damping" | "repetition") { About::Cost } else { About::Result };
        Self { kind, about, jobs, problem }
    }

    /// Whether it is a doubt about the result, and not a remark about the cost alone.
    pub fn is_doubt(&self) -> bool {
        self.about == About::Result
    }

    /// The warning on one line and without its place in the file, for readers who do not edit the file now.
    pub fn in_words(&self) -> String {
        let Problem { field, value, message, help, .. } = &self.problem;
        let value = value.as_ref().map_or_else(String::new, |value| format!(" = {value}"));
        let help: Vec<String> = help.iter().map(|line| format!("; {line}")).collect();
        format!("{field}{value}: {message}{}", help.concat())
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.problem.fmt(f)
    }
}

/// A doubt about one job.
#[derive(Debug)]
struct Doubt {
    kind: &'static str,
    /// Paths of the fields that may have to be changed, the most likely one first.
    fields: Vec<String>,
    /// How doubtful the job is, to find the worst job of a kind; without a unit.
    size: f64,
    message: String,
    help: String,
}

fn owned(fields: &[&str]) -> Vec<String> {
    fields.iter().map(|&field| field.to_owned()).collect()
}

/// The doubts about one job. A value in another unit is not followed by its consequences.
fn doubts(spec: &JobSpec) -> Vec<Doubt> {
    let mut found = units::doubts(spec);
    let is_in_doubt = |field: &String| found.iter().any(|doubt| doubt.fields.contains(field));
    let further: Vec<Doubt> =
        physics::doubts(spec).into_iter().filter(|doubt| !doubt.fields.iter().any(is_in_doubt)).collect();
    found.extend(further);
    found
}

/// What is doubtful about one job.
pub fn job_warnings(spec: &JobSpec) -> Vec<Warning> {
    let is_meant =
        |doubt: &Doubt| doubt.kind != "size" || spec.scene.pin.size_m != JobSpec::default().scene.pin.size_m;
    doubts(spec).into_iter().filter(is_meant).map(|doubt| doubt.of_job(spec)).collect()
}

impl Doubt {
    /// The warning about one job.
    fn of_job(self, spec: &JobSpec) -> Warning {
        let Self { kind, fields, message, help, .. } = self;
        // A job has no field for what only a study can give, such as a loss factor.
        let own = fields.iter().find_map(|field| Some((field, value_of(field, spec)?)));
        let (field, value) = own.map_or((&fields[0], None), |(field, value)| (field, Some(value)));
        let field = field.clone();
        let problem =
            Problem { file: String::new(), position: None, field, value, message, help: vec![help] };
        Warning::new(kind, 1, problem)
    }
}

/// The doubts of one kind about one field in all jobs.
struct Shared {
    doubt: Doubt,
    worst: usize,
    first: usize,
    jobs: usize,
}

impl Study {
    /// What is doubtful about the study: each kind once for a field, with the number of jobs, the first and the worst.
    pub fn warnings(&self) -> Vec<Warning> {
        let mut warnings: Vec<Warning> =
            self.shared_doubts(doubts).iter().map(|it| self.warning(it)).collect();
        warnings.extend(self.unused());
        warnings.extend(self.repetition());
        warnings
    }

    /// The values that look like another unit, except in the `refused` fields. They are the likely causes of violations.
    pub(super) fn wrong_units(&self, refused: &[&str]) -> Vec<Problem> {
        let shared = self.shared_doubts(units::doubts);
        let is_refused =
            |shared: &&Shared| shared.doubt.fields.iter().any(|field| refused.contains(&field.as_str()));
        let other = shared.iter().filter(|shared| !is_refused(shared));
        other.map(|shared| self.warning(shared).problem).collect()
    }

    fn shared_doubts(&self, of: impl Fn(&JobSpec) -> Vec<Doubt> + Sync) -> Vec<Shared> {
        let mut found: Vec<Shared> = Vec::new();
        let all = self.specs.par_iter().enumerate().map(|(point, spec)| (point, of(spec)));
        for (point, doubts) in all.filter(|(_, doubts)| !doubts.is_empty()).collect::<Vec<_>>() {
            let is_meant = |doubt: &Doubt| match doubt.kind {
                // Edges of a block that nobody gives say nothing about a cylinder.
                "size" => doubt.fields.iter().any(|field| self.has_value(field)),
                // Who gives both dampings themselves means their sum.
                "two_dampings" => !self.has_value("numerics.beta_r_s"),
                _ => true,
            };
            for doubt in doubts.into_iter().filter(is_meant) {
                let same = |other: &&mut Shared| {
                    other.doubt.kind == doubt.kind && other.doubt.fields == doubt.fields
                };
                match found.iter_mut().find(same) {
                    None => found.push(Shared { doubt, worst: point, first: point, jobs: 1 }),
                    Some(shared) => {
                        shared.jobs += 1;
                        if doubt.size > shared.doubt.size {
                            (shared.doubt, shared.worst) = (doubt, point);
                        }
                    }
                }
            }
        }
        found
    }

    /// Whether the study or its grid gives a field.
    fn has_value(&self, field: &str) -> bool {
        self.source.gives(field) || self.grid.parameters().any(|parameter| parameter.sets(field))
    }

    fn warning(&self, Shared { doubt, worst, first, jobs }: &Shared) -> Warning {
        // The study's author can change what the study gives, and only knows that.
        let field = doubt.fields.iter().find(|field| self.has_value(field)).unwrap_or(&doubt.fields[0]);
        let (mut problem, _) = self.problem_at(field, &doubt.message, *worst);
        problem.value = problem.value.or_else(|| value_of(field, &self.specs[*worst]));
        problem.help.push(doubt.help.clone());
        if *jobs < self.grid_size() {
            let [first, worst] = [first, worst].map(|point| assignments(&self.grid.parameters_at(*point)));
            let most = if first == worst { String::new() } else { format!(", the worst is {worst}") };
            problem.help.push(format!("in {jobs} of {} jobs, first at {first}{most}", self.grid_size()));
        }
        Warning::new(doubt.kind, *jobs, problem)
    }
}

/// The value of a field of a job as JSON.
fn value_of(field: &str, spec: &JobSpec) -> Option<String> {
    let pointer = format!("/{}", field.replace(['.', '['], "/").replace(']', ""));
    encode(spec).pointer(&pointer).map(ToString::to_string)
}

/// A number for a message, with three significant digits.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    if rounded == 0.0 || (1.0e-3..1.0e6).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// A share as per cent, with three significant digits.
fn percent(share: f64) -> String {
    format!("{} %", short(100.0 * share))
}

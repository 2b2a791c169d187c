//! Why a job is in trouble.

use crate::analysis::{JobRecord, Obstacle, Outcome};
use crate::publish::value;
use crate::report::row::{JobNumerics, JobRow, RowState};
use serde::Serialize;

/// What is wrong with a job.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Cause {
    /// `failed` or `not periodic`.
    pub what: &'static str,
    /// Equal for jobs with the same cause, even if the numbers in the message differ.
    #[serde(skip)]
    pub class: String,
    /// The cause in words, with the numbers of one job.
    pub why: String,
}

/// What is wrong with a job; none if nothing is.
pub fn cause(row: &JobRow) -> Option<Cause> {
    match &row.state {
        RowState::Failed { error } => {
            Some(Cause { what: "failed", class: without_numbers(error), why: error.clone() })
        }
        RowState::Done(record) if record.outcome == Outcome::NotPeriodic => {
            let (class, why) = obstacle(record, row.numerics.as_ref());
            Some(Cause { what: "not periodic", class, why })
        }
        _ => None,
    }
}

fn obstacle(record: &JobRecord, numerics: Option<&JobNumerics>) -> (String, String) {
    let growth = record.growth_rate_per_s.filter(|rate| rate.is_finite());
    let growth = growth.map_or_else(String::new, |rate| format!(" (growth rate {rate:.0} /s)"));
    match &record.obstacle {
        None => ("time limit".to_owned(), "the time limit came first".to_owned()),
        Some(Obstacle::FewCycles { found, needed }) => (
            "few cycles".to_owned(),
            format!("the time limit came after {found} of the {needed} cycles that have to repeat{growth}"),
        ),
        Some(Obstacle::SlipOnly) => (
            "slip only".to_owned(),
            format!("all nodes slip all the time, and neither growth nor decay is established{growth}"),
        ),
        Some(Obstacle::Swing { imbalance, covered_s }) => (
            "swing".to_owned(),
            format!(
                "the last cycles repeat, but something still swings or creeps: the mean forces of clamp and contact differ by {} of the load{}",
                significant(imbalance.abs()),
                covered_s.map_or_else(String::new, |time_s| format!(
                    ", and the cycles must repeat over {}",
                    value::quantity(time_s, "s")
                ))
            ),
        ),
        Some(Obstacle::Flow { share }) => (
            "flow".to_owned(),
            format!(
                "the material goes on yielding: the share of plastic work is neither constant nor negligible: {}",
                significant(*share)
            ),
        ),
        Some(Obstacle::Creep { still_to_come, imbalance }) => (
            "creep".to_owned(),
            format!(
                "the oscillations decay, but the mean friction still changes by about {}, and the mean forces of clamp and contact differ by {} of \
                 the load",
                significant(*still_to_come),
                significant(imbalance.abs())
            ),
        ),
        Some(Obstacle::Unsteady { figure, spread, drift }) => (
            format!("unsteady {figure}"),
            format!(
                "{figure} is not the same from cycle to cycle: it spreads by {} and drifts by {}{}",
                significant(*spread),
                significant(*drift),
                numerics.map_or_else(String::new, tolerated)
            ),
        ),
    }
}

fn tolerated(numerics: &JobNumerics) -> String {
    let JobNumerics { tolerance, drift_tolerance, .. } = numerics;
    format!(" (tolerated: {} and {})", value::number(*tolerance), value::number(*drift_tolerance))
}

/// A number with three digits, which are enough to compare it with a tolerance.
fn significant(x: f64) -> String {
    value::significant(x, 3)
}

/// A message with its numbers replaced, so that jobs that failed alike at different steps have the same class.
fn without_numbers(text: &str) -> String {
    let is_number = |word: &str| word.chars().any(|c| c.is_ascii_digit());
    text.split_whitespace().map(|word| if is_number(word) { "#" } else { word }).collect::<Vec<_>>().join(" ")
}

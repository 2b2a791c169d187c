//! Jobs that differ in one parameter.

use crate::analysis::{JobRecord, Outcome, Regime};
use crate::report::JobRow;
use crate::study::Side;
use indexmap::IndexMap;
use serde_json::Value;

/// The jobs of a study that differ in one parameter alone, from its smallest value to its largest.
#[derive(Debug)]
pub struct Series<'a> {
    /// The other parameters with their values.
    pub rest: Vec<(String, Value)>,
    pub points: Vec<(f64, &'a JobRow)>,
}

/// The series along a parameter, in the order of their first jobs. Only those that have two jobs that the study's author asked for: a
/// point that was added to one series is no beginning of another one.
pub fn series_along<'a>(rows: &'a [JobRow], along: &str) -> Vec<Series<'a>> {
    let mut found: IndexMap<String, (usize, Series<'a>)> = IndexMap::new();
    for row in rows {
        let Some(x) =
            row.parameters.of_grid().iter().find(|(name, _)| name == along).and_then(|(_, x)| x.as_f64())
        else {
            continue;
        };
        let rest: Vec<_> =
            row.parameters.of_grid().iter().filter(|(name, _)| name != along).cloned().collect();
        let key = serde_json::to_string(&rest).unwrap_or_default();
        let (given, series) = found.entry(key).or_insert_with(|| (0, Series { rest, points: Vec::new() }));
        *given += usize::from(row.wave == 0);
        series.points.push((x, row));
    }
    let mut found: Vec<Series<'a>> =
        found.into_values().filter(|(given, _)| *given >= 2).map(|(_, series)| series).collect();
    for series in &mut found {
        series.points.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        series.points.dedup_by_key(|(x, _)| x.to_bits());
    }
    found
}

impl Series<'_> {
    /// The parameters of a point, in the order of the study.
    pub fn at(&self, along: &str, x: f64) -> Vec<(String, Value)> {
        let order = self.points.first().map_or(self.rest.as_slice(), |(_, row)| row.parameters.of_grid());
        order
            .iter()
            .map(|(name, value)| (name.clone(), if name == along { x.into() } else { value.clone() }))
            .collect()
    }

    /// The points with a value, and the positions of those without one.
    pub fn known<T>(&self, value: impl Fn(&JobRow) -> Option<T>) -> (Vec<(f64, T)>, Vec<f64>) {
        let mut unknown = Vec::new();
        let mut known = Vec::new();
        for (x, row) in &self.points {
            match value(row) {
                Some(value) => known.push((*x, value)),
                None => unknown.push(*x),
            }
        }
        (known, unknown)
    }
}

/// The kind of a job on one side of a boundary, with the growth rate \[1/s\] that tells how far the boundary is.
#[derive(Debug, Clone, PartialEq)]
pub struct Kind {
    pub name: String,
    pub rate_per_s: Option<f64>,
}

/// The kind of a job; none if it is not known.
pub fn kind(row: &JobRow, side: Side) -> Option<Kind> {
    let record = row.record();
    match side {
        Side::Stability => {
            let of_mode = record?.stability.as_ref().and_then(|own| own.modes.first());
            let of_mode = of_mode.map(|mode| mode.growth_rate_per_s);
            let is_stable = of_mode.map(|rate| rate < 0.0).or_else(|| is_stable(record?))?;
            // The rate of a run counts if it says the same.
            let of_run = record?.growth_rate_per_s.filter(|rate| (*rate < 0.0) == is_stable);
            let name = if is_stable { "stable" } else { "unstable" }.to_owned();
            Some(Kind { name, rate_per_s: of_mode.or(of_run) })
        }
        Side::Regime => {
            let regime = record?.regime;
            (regime != Regime::Undecided).then(|| Kind { name: regime.name().to_owned(), rate_per_s: None })
        }
        Side::Status => {
            record?;
            Some(Kind { name: row.status().to_owned(), rate_per_s: None })
        }
    }
}

/// Whether the run says that sliding is stable; none if it says neither.
fn is_stable(record: &JobRecord) -> Option<bool> {
    match (record.outcome, record.regime) {
        (Outcome::Decayed, _) => Some(true),
        (Outcome::NotPeriodic | Outcome::Completed, Regime::Undecided | Regime::Stable) => None,
        (Outcome::Periodic | Outcome::Unstable | Outcome::NotPeriodic | Outcome::Completed, _) => Some(false),
    }
}

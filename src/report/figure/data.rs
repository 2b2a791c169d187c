//! The points of a figure.

use crate::analysis::{JobRecord, Outcome, Regime};
use crate::publish::plot::axis::Axis;
use crate::report::layout::{Group, Layout};
use crate::report::row::JobRow;
use serde_json::Value;

/// What curves show over the disk speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ordinate {
    MuStar,
    Frequency,
}

/// One job's result in a figure.
pub(super) struct Point<'a> {
    pub row: &'a JobRow,
    /// The value of the parameter along the axis.
    pub at: &'a Value,
    /// Its position on the axis.
    pub x: f64,
    pub y: f64,
    /// Standard error of `y`; 0 if it is not known.
    pub error: f64,
    pub regime: Regime,
    pub periodic: bool,
}

/// All results for one friction coefficient.
pub(super) struct Curve<'a> {
    pub mu: f64,
    /// Results from left to right.
    pub points: Vec<Point<'a>>,
    /// Runs of points that a line joins.
    pub stretches: Vec<Vec<(f64, f64)>>,
}

/// One curve for each μ of the study, even if this group has no results for it, so that all figures of a study have the
/// same colours and legend.
pub(super) fn curves<'a>(layout: &Layout, group: &'a Group, plot: Ordinate, x_axis: &Axis) -> Vec<Curve<'a>> {
    let at: Vec<Option<f64>> = group.axis_values.iter().map(|value| x_axis.position(value)).collect();
    let mut results: Vec<Vec<LocatedResult>> = vec![Vec::new(); layout.mus.len()];
    for job in &group.jobs {
        if let (Some(x), Some(record)) = (at[job.axis_index], job.row.record()) {
            results[job.mu_index].push(LocatedResult {
                x,
                at: &group.axis_values[job.axis_index],
                row: job.row,
                record,
            });
        }
    }
    layout
        .mus
        .iter()
        .zip(results)
        .map(|(&mu, mut results)| {
            results.sort_by(|a, b| a.x.total_cmp(&b.x));
            let points = results.iter().filter_map(|found| point(plot, found)).collect();
            Curve { mu, points, stretches: stretches(plot, &results) }
        })
        .collect()
}

/// A job with a result, and its position on the axis.
#[derive(Clone, Copy)]
struct LocatedResult<'a> {
    x: f64,
    at: &'a Value,
    row: &'a JobRow,
    record: &'a JobRecord,
}

fn point<'a>(plot: Ordinate, found: &LocatedResult<'a>) -> Option<Point<'a>> {
    let LocatedResult { x, at, row, record } = *found;
    let (y, error) = match plot {
        Ordinate::MuStar => (record.mu_star, record.mu_star_se),
        Ordinate::Frequency => (record.frequency_hz?, 0.0),
    };
    let error = if error.is_finite() { error.abs() } else { 0.0 };
    let periodic = record.outcome != Outcome::NotPeriodic;
    y.is_finite().then_some(Point { row, at, x, y, error, regime: record.regime, periodic })
}

/// The lines of a curve. Jobs at the same position are represented by their mean. A job that is done but has no value (no
/// frequency, because nothing oscillates) interrupts the line, which would otherwise claim a value there.
fn stretches(plot: Ordinate, results: &[LocatedResult]) -> Vec<Vec<(f64, f64)>> {
    let mut stretches = vec![Vec::new()];
    for here in results.chunk_by(|a, b| a.x == b.x) {
        let values: Vec<f64> = here.iter().filter_map(|found| Some(point(plot, found)?.y)).collect();
        if values.is_empty() {
            stretches.push(Vec::new());
        } else if let Some(stretch) = stretches.last_mut() {
            stretch.push((here[0].x, values.iter().sum::<f64>() / values.len() as f64));
        }
    }
    stretches.retain(|stretch| stretch.len() > 1);
    stretches
}

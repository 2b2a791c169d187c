//! The points of a figure.

use super::Plot;
use crate::analysis::{JobRecord, Outcome, Regime};
use crate::publish::plot::axis::Axis;
use crate::report::layout::{Group, Layout};

/// One job's result in a figure.
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
    /// Standard error of `y`; 0 where none is known.
    pub error: f64,
    pub regime: Regime,
    pub periodic: bool,
}

/// All results for one friction coefficient.
pub(super) struct Curve {
    pub mu: f64,
    /// Results from left to right.
    pub points: Vec<Point>,
    /// Stretches to be joined by a line.
    pub stretches: Vec<Vec<(f64, f64)>>,
}

/// One curve per μ of the study, also where this group has no results: colours and legend stay the
/// same in all its figures.
pub(super) fn curves(layout: &Layout, group: &Group, plot: Plot, x_axis: &Axis) -> Vec<Curve> {
    let at: Vec<Option<f64>> = group.axis_values.iter().map(|value| x_axis.place(value)).collect();
    let mut results: Vec<Vec<(f64, &JobRecord)>> = vec![Vec::new(); layout.mus.len()];
    for job in &group.jobs {
        if let (Some(x), Some(record)) = (at[job.at], job.row.record()) {
            results[job.mu].push((x, record));
        }
    }
    layout
        .mus
        .iter()
        .zip(results)
        .map(|(&mu, mut results)| {
            results.sort_by(|a, b| a.0.total_cmp(&b.0));
            let points = results.iter().filter_map(|&(x, record)| point(plot, x, record)).collect();
            Curve { mu, points, stretches: stretches(plot, &results) }
        })
        .collect()
}

fn point(plot: Plot, x: f64, record: &JobRecord) -> Option<Point> {
    let (y, error) = match plot {
        Plot::MuStar => (record.mu_star, record.mu_star_se),
        Plot::Frequency => (record.frequency_hz?, 0.0),
    };
    let error = if error.is_finite() { error.abs() } else { 0.0 };
    let periodic = record.outcome != Outcome::NotPeriodic;
    y.is_finite().then_some(Point { x, y, error, regime: record.regime, periodic })
}

/// Joins neighbours; jobs at the same place by their mean. A job that is done but has no value (no
/// oscillation, hence no frequency) ends a stretch: a line across it would claim one.
fn stretches(plot: Plot, results: &[(f64, &JobRecord)]) -> Vec<Vec<(f64, f64)>> {
    let mut stretches = vec![Vec::new()];
    for here in results.chunk_by(|a, b| a.0 == b.0) {
        let values: Vec<f64> =
            here.iter().filter_map(|&(x, record)| Some(point(plot, x, record)?.y)).collect();
        if values.is_empty() {
            stretches.push(Vec::new());
        } else if let Some(stretch) = stretches.last_mut() {
            stretch.push((here[0].0, values.iter().sum::<f64>() / values.len() as f64));
        }
    }
    stretches.retain(|stretch| stretch.len() > 1);
    stretches
}

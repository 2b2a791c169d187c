//! The points of a figure.

use crate::analysis::{Outcome, Regime};
use crate::publish::plot::axis::Axis;
use crate::report::layout::{Group, Layout, Series};
use crate::report::parameters::MU;
use crate::report::row::JobRow;
use crate::report::scalar::Scalar;
use serde_json::Value;

/// One result in a figure.
pub(super) struct Point<'a> {
    pub row: &'a JobRow,
    /// The value of the parameter along the axis.
    pub at: &'a Value,
    /// Its position on the axis.
    pub x: f64,
    pub y: f64,
    /// Error of `y`; 0 if it is not known.
    pub error: f64,
    /// The contact regime; none for a measured point.
    pub regime: Option<Regime>,
    pub periodic: bool,
    /// Whether it counts for the range of the axis. If it does not, it may be beyond the axis.
    pub settled: bool,
}

/// All results of one series in one group.
pub(super) struct Curve<'a> {
    pub series: &'a Series,
    /// Results from left to right.
    pub points: Vec<Point<'a>>,
    /// Runs of points that a line joins. Measured points are not joined.
    pub stretches: Vec<Vec<(f64, f64)>>,
}

/// One curve for each series of the layout, even if this group has no results for it, so that all panels of a report have
/// the same colours and legend.
pub(super) fn curves<'a>(
    layout: &'a Layout,
    group: &'a Group,
    scalar: &Scalar,
    x_axis: &Axis,
) -> Vec<Curve<'a>> {
    let at: Vec<Option<f64>> = group.axis_values.iter().map(|value| layout.position(x_axis, value)).collect();
    let mut results: Vec<Vec<LocatedResult>> = vec![Vec::new(); layout.series.len()];
    for job in &group.jobs {
        if let (Some(x), true) = (at[job.axis_index], job.row.has_result()) {
            let at = &group.axis_values[job.axis_index];
            results[job.series].push(LocatedResult { x, at, row: job.row });
        }
    }
    let curve = |(series, mut results): (&'a Series, Vec<LocatedResult<'a>>)| {
        results.sort_by(|a, b| a.x.total_cmp(&b.x));
        let points = results.iter().filter_map(|found| point(scalar, found)).collect();
        let is_joined = layout.scattered.is_empty()
            && !layout.sources.get(series.source).is_some_and(|source| source.is_measured);
        let stretches = if is_joined { stretches(scalar, &results) } else { Vec::new() };
        Curve { series, points, stretches }
    };
    layout.series.iter().zip(results).map(curve).collect()
}

/// The friction coefficients at which a panel has a guide line μ\* = μ, each with the series whose colour it has; none if
/// all curves share one coefficient.
pub(super) fn guides(layout: &Layout, group: &Group) -> Vec<(f64, Option<usize>)> {
    let mut guides: Vec<(f64, Option<usize>)> = Vec::new();
    if layout.by == MU {
        for (index, series) in layout.series.iter().enumerate() {
            let mu = series.value.as_f64();
            guides.extend(mu.map(|mu| (mu, Some(index))));
        }
        guides.dedup_by(|a, b| a.0.to_bits() == b.0.to_bits());
        return guides;
    }
    let mut mus = group.jobs.iter().map(|job| job.row.mu).filter(|mu| mu.is_finite());
    let first = mus.next();
    let is_same = mus.all(|mu| Some(mu) == first);
    guides.extend(first.filter(|_| is_same).map(|mu| (mu, None)));
    guides
}

/// A row with a result, and its position on the axis.
#[derive(Clone, Copy)]
struct LocatedResult<'a> {
    x: f64,
    at: &'a Value,
    row: &'a JobRow,
}

fn point<'a>(scalar: &Scalar, found: &LocatedResult<'a>) -> Option<Point<'a>> {
    let LocatedResult { x, at, row } = *found;
    let record = row.record();
    Some(Point {
        row,
        at,
        x,
        y: scalar.value(row)?,
        error: scalar.error(row).unwrap_or(0.0),
        regime: record.map(|record| record.regime),
        periodic: record.is_none_or(|record| record.outcome != Outcome::NotPeriodic),
        settled: scalar.is_settled(row),
    })
}

/// The lines of a curve. Jobs at the same position are represented by their mean. A job that is done but has no value
/// that counts (no frequency, because nothing oscillates or because the run is not periodic) interrupts the line, which
/// would otherwise claim a value there.
fn stretches(scalar: &Scalar, results: &[LocatedResult]) -> Vec<Vec<(f64, f64)>> {
    let mut stretches = vec![Vec::new()];
    for here in results.chunk_by(|a, b| a.x == b.x) {
        let settled = here.iter().filter(|found| scalar.is_settled(found.row));
        let values: Vec<f64> = settled.filter_map(|found| scalar.value(found.row)).collect();
        if values.is_empty() {
            stretches.push(Vec::new());
        } else if let Some(stretch) = stretches.last_mut() {
            stretch.push((here[0].x, values.iter().sum::<f64>() / values.len() as f64));
        }
    }
    stretches.retain(|stretch| stretch.len() > 1);
    stretches
}

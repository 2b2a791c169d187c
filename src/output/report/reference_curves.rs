//! The curves of the reference of a comparison, and what they are at a place on the axis.

use super::layout::{Group, Layout};
use super::row::JobRow;
use super::scalar::Scalar;
use crate::publish::chart::Axis;
use crate::publish::value;
use std::collections::BTreeMap;

/// A point of the reference.
pub(super) struct ReferencePoint {
    pub value: f64,
    pub error: Option<f64>,
    pub interpolated: bool,
    /// Whether a run behind it is not periodic.
    pub is_open: bool,
}

/// The curves of the reference in a group by the index of their series: rows from left to right.
pub(super) type Curves<'a> = BTreeMap<usize, Vec<(f64, &'a JobRow)>>;

pub(super) fn reference_curves<'a>(layout: &Layout, group: &Group<'a>, x_axis: &Axis) -> Curves<'a> {
    let mut curves = Curves::new();
    for job in group.jobs.iter().filter(|job| layout.series[job.series].source == 0) {
        if let Some(x) = layout.position(x_axis, &group.axis_values[job.axis_index]) {
            curves.entry(job.series).or_default().push((x, job.row));
        }
    }
    for curve in curves.values_mut() {
        curve.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    curves
}

/// Where a point is on a curve.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Place {
    Between,
    Equal,
}

/// Positions on the axis that differ by less than this share are equal.
const SAME: f64 = 1e-9;

fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

/// The points of a curve at a position. Curves ascend, and a study may have many points.
fn points_at<'c, 'a>(curve: &'c [(f64, &'a JobRow)], x: f64) -> &'c [(f64, &'a JobRow)] {
    let first = curve.partition_point(|(at, _)| *at < x && !is_same(*at, x));
    let count = curve[first..].partition_point(|(at, _)| is_same(*at, x));
    &curve[first..first + count]
}

pub(super) fn position_in(curve: &[(f64, &JobRow)], x: f64, x_axis: &Axis) -> Option<Place> {
    if !points_at(curve, x).is_empty() {
        return Some(Place::Equal);
    }
    neighbours(curve, x, x_axis).map(|_| Place::Between)
}

/// The points of a curve at a place that have all scattered parameters of a row, as far as those are known: between points that are no grid nothing
/// can be interpolated.
pub(super) fn alike<'a>(
    curve: &[(f64, &'a JobRow)],
    x: f64,
    layout: &Layout,
    row: &JobRow,
) -> Vec<(f64, &'a JobRow)> {
    let is_alike = |(_, other): &&(f64, &JobRow)| {
        let mut values = layout.scattered.iter().map(|name| [row.parameter(name), other.parameter(name)]);
        values.all(|[own, other]| own.is_null() || value::text(&own) == value::text(&other))
    };
    points_at(curve, x).iter().filter(is_alike).copied().collect()
}

/// The positions of the next jobs on both sides; none if values cannot be interpolated.
fn neighbours(curve: &[(f64, &JobRow)], x: f64, x_axis: &Axis) -> Option<(f64, f64)> {
    if let Axis::Names(_) = x_axis {
        return None;
    }
    let above = curve.partition_point(|(at, _)| *at <= x);
    let below = curve.partition_point(|(at, _)| *at < x).checked_sub(1)?;
    Some((curve[below].0, curve.get(above)?.0))
}

/// Whether the reference squeals at a position, and whether that is known of the neighbours on both sides alone. None if jobs do not
/// say it, or say different things.
pub(super) fn squeals_at(curve: &[(f64, &JobRow)], x: f64, x_axis: &Axis) -> Option<(bool, bool)> {
    let all = |x: f64| {
        let mut found = points_at(curve, x).iter().map(|(_, row)| row.squeals());
        let first = found.next()??;
        found.all(|other| other == Some(first)).then_some(first)
    };
    if !points_at(curve, x).is_empty() {
        return Some((all(x)?, false));
    }
    let (left, right) = neighbours(curve, x, x_axis)?;
    let (left, right) = (all(left)?, all(right)?);
    (left == right).then_some((left, true))
}

/// The reference at a position: the mean of the jobs there, or interpolated between the neighbours, if both have a value.
pub(super) fn reference_at(
    curve: &[(f64, &JobRow)],
    x: f64,
    x_axis: &Axis,
    scalar: &Scalar,
) -> Option<ReferencePoint> {
    if !points_at(curve, x).is_empty() {
        return mean_at(curve, x, scalar);
    }
    let (left, right) = neighbours(curve, x, x_axis)?;
    let (from, to) = (mean_at(curve, left, scalar)?, mean_at(curve, right, scalar)?);
    let share = match x_axis {
        Axis::Log(_) => (x / left).ln() / (right / left).ln(),
        _ => (x - left) / (right - left),
    };
    let error = from.error.zip(to.error).map(|(a, b)| ((1.0 - share) * a).hypot(share * b));
    let value = from.value + share * (to.value - from.value);
    Some(ReferencePoint { value, error, interpolated: true, is_open: from.is_open || to.is_open })
}

fn mean_at(curve: &[(f64, &JobRow)], x: f64, scalar: &Scalar) -> Option<ReferencePoint> {
    let here = || points_at(curve, x).iter().map(|(_, row)| *row).filter(|row| scalar.is_settled(row));
    let values: Vec<f64> = here().filter_map(|row| scalar.value(row)).collect();
    let count = values.len() as f64;
    let errors: Option<Vec<f64>> = here().map(|row| scalar.error(row)).collect();
    // The error of a mean of independent values.
    let error = errors.map(|errors| errors.iter().map(|e| e * e).sum::<f64>().sqrt() / count);
    (count > 0.0).then(|| ReferencePoint {
        value: values.iter().sum::<f64>() / count,
        error,
        interpolated: false,
        is_open: here().any(JobRow::is_open),
    })
}

//! Which parameters move a quantity, how far and in which direction.

use super::parameters;
use crate::report::row::{JobRow, RowState};
use crate::report::scalar::Scalar;
use nalgebra::{DMatrix, DVector};

/// What a parameter does to a quantity between the ends of its values.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::report) struct Mover {
    pub parameter: String,
    /// The smallest and the largest value of the parameter.
    pub ends: [f64; 2],
    /// By how much the quantity changes from one end to the other, as a share of its mean.
    pub change: f64,
}

/// The least share of the variance that must follow a plane, so that its slopes say something.
const FOLLOWS: f64 = 0.8;

/// The smallest singular value of points over the largest one, below which parameters vary together.
const ALIKE: f64 = 1.0e-3;

/// What counts as no change of a quantity, as a share of it.
const ROUNDING: f64 = 1.0e-9;

/// What each parameter does to a quantity, the largest change first: the slopes of the plane over all parameters with the least squares, times
/// the distances of their ends. On a full grid of two values these are the mean differences. Only values of limit cycles and of steady
/// sliding count, as in figures. The parameter `axis` is part of the plane, but explains nothing.
///
/// # Errors
/// Why the jobs say nothing, as the end of a sentence that begins with their study.
pub(in crate::report) fn movers(
    rows: &[JobRow],
    scalar: &Scalar,
    axis: Option<&str>,
) -> Result<Vec<Mover>, &'static str> {
    let is_done = |row: &&JobRow| matches!(row.state, RowState::Done(_)) && scalar.is_settled(row);
    let with_value = |row| Some((row, scalar.value(row).filter(|y| y.is_finite())?));
    let (rows, y): (Vec<&JobRow>, Vec<f64>) = rows.iter().filter(is_done).filter_map(with_value).unzip();
    if rows.is_empty() {
        return Err("has no finished job with this quantity");
    }
    let all = parameters(&rows);
    if all.iter().any(|own| !own.is_number) {
        return Err("varies something that is no number, so its changes have no direction");
    }
    if all.iter().all(|own| Some(own.name.as_str()) == axis) {
        return Err("varies no parameter but that along the axis");
    }
    let (count, columns) = (y.len(), all.len() + 1);
    if count < columns + 1 {
        return Err("has too few jobs for its parameters");
    }
    let ends: Vec<[f64; 2]> = all
        .iter()
        .map(|own| {
            own.values
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)])
        })
        .collect();
    // Each parameter goes from 0 to 1, so that its coefficient is its change.
    let entry = |row: usize, column: usize| match column.checked_sub(1) {
        None => 1.0,
        Some(own) => (all[own].values[row] - ends[own][0]) / (ends[own][1] - ends[own][0]),
    };
    let design = DMatrix::from_fn(count, columns, entry);
    let values = DVector::from_vec(y);
    let parts = design.clone().svd(true, true);
    let largest = parts.singular_values.max();
    if parts.rank(ALIKE * largest) < columns {
        return Err("varies parameters together, whose parts cannot be told apart");
    }
    let plane = parts.solve(&values, 0.0).map_err(|_| "has points from which no plane follows")?;
    let mean = values.mean();
    let left = (&design * &plane - &values).norm_squared();
    let variance = values.map(|y| y - mean).norm_squared();
    // What does not change but for rounding follows any plane.
    let rounding = count as f64 * (ROUNDING * mean).powi(2);
    if left > ((1.0 - FOLLOWS) * variance).max(rounding) {
        return Err("has values that follow no plane over its parameters");
    }
    let mover = |(at, own): (usize, &super::Parameter)| Mover {
        parameter: own.name.clone(),
        ends: ends[at],
        change: plane[at + 1] / mean.abs(),
    };
    let mut found: Vec<Mover> = all.iter().enumerate().map(mover).collect();
    found.retain(|own| own.change.is_finite() && Some(own.parameter.as_str()) != axis);
    found.sort_by(|a, b| b.change.abs().total_cmp(&a.change.abs()));
    Ok(found)
}

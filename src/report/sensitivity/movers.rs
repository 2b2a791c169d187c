//! Which parameters move a quantity, how far and in which direction.

use super::parameters;
use crate::report::row::{JobRow, RowState};
use crate::report::scalar::Scalar;
use indexmap::IndexMap;

/// What a parameter does to a quantity between the ends of its values.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::report) struct Mover {
    pub parameter: String,
    /// The smallest and the largest value of the parameter.
    pub ends: [f64; 2],
    /// By how much the quantity changes from one end to the other, as a share of its mean.
    pub change: f64,
}

/// What each parameter that is a number does to a quantity, the largest change first: the mean over pairs of points that differ in it alone
/// and have its ends. Where there are no such pairs, it is the slope of a straight line through all points, times the distance of the ends.
pub(in crate::report) fn movers(rows: &[JobRow], scalar: &Scalar) -> Vec<Mover> {
    let is_done = |row: &&JobRow| matches!(row.state, RowState::Done(_)) && scalar.value(row).is_some();
    let rows: Vec<&JobRow> = rows.iter().filter(is_done).collect();
    let y: Vec<f64> = rows.iter().filter_map(|row| scalar.value(row)).collect();
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let all = parameters(&rows);
    let mover = |own: &super::Parameter| {
        let ends = own
            .values
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)]);
        let mut groups: IndexMap<Vec<u64>, [Option<f64>; 2]> = IndexMap::new();
        for (at, y) in y.iter().enumerate() {
            let others = all.iter().filter(|other| other.name != own.name);
            let pair = groups.entry(others.map(|other| other.values[at].to_bits()).collect()).or_default();
            for (end, value) in ends.iter().zip(pair) {
                if own.values[at] == *end {
                    *value = Some(*y);
                }
            }
        }
        let changes: Vec<f64> = groups.values().filter_map(|[low, high]| Some((*high)? - (*low)?)).collect();
        let change = if changes.is_empty() {
            slope(&own.values, &y) * (ends[1] - ends[0])
        } else {
            changes.iter().sum::<f64>() / changes.len() as f64
        };
        Mover { parameter: own.name.clone(), ends, change: change / mean.abs() }
    };
    let mut found: Vec<Mover> = all.iter().filter(|own| own.is_number).map(mover).collect();
    found.retain(|own| own.change.is_finite());
    found.sort_by(|a, b| b.change.abs().total_cmp(&a.change.abs()));
    found
}

/// The slope of the straight line with the least squares.
fn slope(x: &[f64], y: &[f64]) -> f64 {
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    let (x_mean, y_mean) = (mean(x), mean(y));
    let products = x.iter().zip(y).map(|(x, y)| (x - x_mean) * (y - y_mean));
    products.sum::<f64>() / x.iter().map(|x| (x - x_mean).powi(2)).sum::<f64>()
}

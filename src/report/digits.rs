//! Results with the digits that the larger of their two errors leaves: the statistical one, and that of mesh and step.
//!
//! Where the second is not measured, a fixed number of digits is shown, because the statistical error alone would promise
//! too many.

use super::row::JobRow;
use crate::analysis::JobRecord;
use crate::publish::rounding::{at_place, last_place};
use crate::publish::value::{MISSING, significant};

/// The last decimal of μ\* that is shown at all.
const FINEST: i32 = -4;
/// The last decimal of μ\* if the error of mesh and step is not measured.
const UNMEASURED: i32 = -3;
/// Digits of a frequency if its error is not measured.
const UNMEASURED_DIGITS: i32 = 4;

/// The statistical error of μ\*, and that of mesh and step if it is measured.
fn mu_star_errors(row: &JobRow, record: &JobRecord) -> (f64, Option<f64>) {
    let se = if record.mu_star_se.is_finite() { record.mu_star_se.abs() } else { 0.0 };
    (se, row.discretisation.error().map(|error| error.mu_star_relative * record.mu_star.abs()))
}

/// The last decimal place of μ\*.
fn mu_star_place(row: &JobRow, record: &JobRecord) -> i32 {
    let (se, mesh) = mu_star_errors(row, record);
    let finest = if mesh.is_some() { FINEST } else { UNMEASURED };
    last_place(se.max(mesh.unwrap_or(0.0))).unwrap_or(finest).clamp(finest, -1)
}

/// μ\* of a job.
pub(super) fn mu_star(row: &JobRow, record: &JobRecord) -> String {
    at_place(record.mu_star, mu_star_place(row, record))
}

/// μ\* of a job with the larger of its errors: `0.263 ± 0.014`.
pub(super) fn mu_star_with_error(row: &JobRow, record: &JobRecord) -> String {
    let (se, mesh) = mu_star_errors(row, record);
    let place = mu_star_place(row, record);
    let error = se.max(mesh.unwrap_or(0.0));
    let error = match last_place(error) {
        // An error below the last digit has its own digits.
        Some(own) if own < place => significant(error, 1),
        _ => at_place(error, place),
    };
    format!("{} ± {error}", at_place(record.mu_star, place))
}

/// μ\*/μ of a job, with three decimals at most.
pub(super) fn ratio(row: &JobRow, record: &JobRecord) -> String {
    let (se, mesh) = mu_star_errors(row, record);
    let place = last_place(se.max(mesh.unwrap_or(0.0)) / row.mu).unwrap_or(UNMEASURED).clamp(UNMEASURED, -1);
    at_place(record.mu_star / row.mu, place)
}

/// Frequency \[Hz\] of a job; none if it has none.
pub(super) fn frequency_hz(row: &JobRow, record: &JobRecord) -> Option<String> {
    let frequency = record.frequency_hz?;
    if !frequency.is_finite() {
        return Some(MISSING.to_owned());
    }
    let place = match row.discretisation.error() {
        Some(error) => last_place(error.frequency_relative * frequency).unwrap_or(0),
        None => frequency.abs().max(1.0).log10().floor() as i32 + 1 - UNMEASURED_DIGITS,
    };
    Some(at_place(frequency, place.max(0)))
}

//! Results with the digits that the larger of their two errors leaves: the statistical one, and that of the mesh.
//!
//! Where the second is not known, a fixed number of digits is shown, because the statistical error alone would promise
//! too many.

use super::row::JobRow;
use super::scalar::{MU_STAR, Scalar};
use crate::publish::rounding::{at_place, last_place};
use crate::publish::value::{MISSING, significant};

/// The larger of the errors of a value `x`, and the power of ten of its last digit if it is divided by `divisor`.
fn error_and_place(scalar: &Scalar, row: &JobRow, x: f64, divisor: f64) -> (f64, i32) {
    let digits = scalar.digits();
    let mesh = scalar.mesh_error(row);
    let error = scalar.error(row).unwrap_or(0.0).max(mesh.unwrap_or(0.0));
    let finest = digits.last.place(x);
    let finest = if mesh.is_some() { finest } else { digits.unmeasured.place(x).max(finest) };
    let place = last_place(error / divisor).unwrap_or(finest);
    (error, place.max(finest).min(digits.coarsest))
}

/// The value of a job.
pub(super) fn by_error(scalar: &Scalar, row: &JobRow) -> String {
    let Some(x) = scalar.value(row) else { return MISSING.to_owned() };
    at_place(x, error_and_place(scalar, row, x, 1.0).1)
}

/// The value of a job with the larger of its errors, `0.263 ± 0.014`; without one if that of the mesh is unknown, because the other alone
/// would claim more than is known.
pub(super) fn with_error(scalar: &Scalar, row: &JobRow) -> String {
    let Some(x) = scalar.value(row) else { return MISSING.to_owned() };
    if scalar.mesh_error(row).is_none() {
        return by_error(scalar, row);
    }
    let (error, place) = error_and_place(scalar, row, x, 1.0);
    let error = match last_place(error) {
        // An error below the last digit has its own digits.
        Some(own) if own < place => significant(error, 1),
        _ => at_place(error, place),
    };
    format!("{} ± {error}", at_place(x, place))
}

/// μ\*/μ of a job, with three decimals at most.
pub(super) fn ratio(row: &JobRow) -> String {
    let Some(mu_star) = MU_STAR.value(row) else { return MISSING.to_owned() };
    let mu = row.parameters.mu();
    let (_, place) = error_and_place(MU_STAR, row, mu_star, mu);
    at_place(mu_star / mu, place.max(MU_STAR.digits().unmeasured.place(mu_star)))
}

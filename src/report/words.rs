//! Jobs in words.

use super::parameters::{MU, OMEGA, assignments};
use super::row::JobRow;

/// All parameters of a job in words, ω and μ first. Parameters of a measured point that are not known are left out.
pub(super) fn parameters_in_words(row: &JobRow) -> String {
    let further = row.further().map(|(name, value)| (name, value.clone()));
    let all = [OMEGA, MU].map(|name| (name, row.parameter(name))).into_iter().chain(further);
    assignments(all.filter(|(_, value)| !row.is_measured() || !value.is_null()))
}

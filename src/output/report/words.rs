//! Jobs in words.

use super::parameters::assignments;
use super::row::JobRow;

/// All parameters of a job in words, ω and μ first. Parameters of a measured point that are not known are left out.
pub(super) fn parameters_in_words(row: &JobRow) -> String {
    assignments(row.parameters.iter().filter(|(_, value)| !row.is_measured() || !value.is_null()))
}

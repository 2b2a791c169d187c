//! The data of a step that a contact solve needs.

use crate::solver::drive::Drive;
use crate::solver::number::Number;
use crate::solver::scheme::StepFactors;

/// The data of a step that a contact solve needs.
pub struct StepData<'a, const L: usize, R: Number = f64> {
    pub factors: &'a StepFactors<R>,
    pub drives: &'a [Drive; L],
    /// Number n of steps that each lane has done before this one.
    pub steps_done: &'a [u64; L],
}

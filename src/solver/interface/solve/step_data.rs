//! The data of a step that a contact solve needs.

use crate::solver::drive::Drive;
use crate::solver::scheme::StepFactors;

/// The data of a step that a contact solve needs.
pub(in crate::solver) struct StepData<'a, const L: usize> {
    pub factors: &'a StepFactors,
    pub drives: &'a [Drive; L],
    /// Number n of steps that each lane has done before this one.
    pub steps_done: &'a [u64; L],
}

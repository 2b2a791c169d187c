//! What a contact solve is given of a step.

use crate::solver::drive::Drive;
use crate::solver::scheme::StepFactors;

/// What a contact solve is given of a step.
pub(in crate::solver) struct Given<'a, const L: usize> {
    pub factors: &'a StepFactors,
    pub drives: &'a [Drive; L],
    /// Number n of steps that the lanes have done before this one.
    pub steps_done: &'a [u64; L],
}

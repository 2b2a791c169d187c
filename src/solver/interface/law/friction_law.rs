//! What a friction law gives, and what it may use.

use crate::solver::real::Real;

/// A slave node in contact, before its friction is known: one node (`R` = `f64`), or the nodes of a vector.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct AtNode<R> {
    /// Normal force \[N\] of this step, ≥ 0.
    pub normal_n: R,
    /// The force \[N\] in x and y that would stop the node relative to the target.
    pub trial_n: [R; 2],
    /// The force \[N/m\] that changes the node's slip of this step by one metre.
    pub stiffness_n_m: R,
    /// Increment \[m\] relative to the target over the step before, in x and y.
    pub last_increment_m: [R; 2],
    /// Whether the node slipped in the step before (1) or not (0).
    pub last_slipped: R,
    /// The friction limit \[N\] of the step before; 0 without contact.
    pub last_limit_n: R,
}

/// A friction law for one node (`R` = `f64`), or for the nodes of a vector.
pub(in crate::solver) trait FrictionLaw<R: Real>: Copy {
    /// False if the limit is always zero. Then no trial force is computed.
    const TRANSMITS: bool = true;

    /// The friction limit \[N\].
    fn limit_n(&self, node: &AtNode<R>) -> R;
}

/// The length of a vector in the contact plane.
#[inline(always)]
pub(super) fn length<R: Real>([x, y]: [R; 2]) -> R {
    (x * x + y * y).root()
}

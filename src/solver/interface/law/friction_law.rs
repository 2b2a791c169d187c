//! What a friction law gives.

use crate::solver::real::Real;

/// A friction law for one node (`R` = `f64`), or for the nodes of a vector.
pub(in crate::solver) trait FrictionLaw<R: Real>: Copy {
    /// False if the limit is always zero. Then no trial force is computed.
    const TRANSMITS: bool = true;

    /// The friction limit \[N\] under the normal force `normal_n` ≥ 0 \[N\].
    ///
    /// A law may use two results of the step before: the increment \[m\] of the node relative to the target in x
    /// and y, and whether the node slipped (1) or not (0).
    fn limit_n(&self, normal_n: R, increment_m: [R; 2], slipped: R) -> R;
}

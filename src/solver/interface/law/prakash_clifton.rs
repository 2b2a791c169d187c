//! Friction that follows the normal force after some slip, as Prakash and Clifton measured it (simplified form, Rubin and
//! Ampuero, *Journal of Geophysical Research* 112, 2007, eq. 18):
//!
//! ```text
//! d(limit)/dt = −(v/L) (limit − μ N)
//! ```
//!
//! The limit is the state of a node. It is zero without contact. The step solves the equation exactly for the slip of the step
//! before and the normal force of this one.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::friction_law::{AtNode, FrictionLaw, length};
use crate::solver::real::{Real, decay};

/// The law with the coefficients of one node, or of the nodes of a vector.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct PrakashClifton<R> {
    pub mu: R,
    /// 1/L \[1/m\].
    pub per_m: R,
}

impl<R: Real> FrictionLaw<R> for PrakashClifton<R> {
    #[inline(always)]
    fn limit_n(&self, node: &AtNode<R>) -> R {
        let aim = self.mu * node.normal_n;
        aim + (node.last_limit_n - aim) * decay(length(node.last_increment_m) * self.per_m)
    }
}

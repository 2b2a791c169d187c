//! Two coefficients: a node that sticks, or has just touched, needs μ_s N to begin to slip. A node that slips has μ N.
//!
//! ```text
//! limit = μ_s N   if the node did not slip in the step before,   otherwise μ N
//! ```
//!
//! This is Coulomb's own observation, and the law of the classic stick–slip oscillator on a belt (Den Hartog, *Mechanical
//! Vibrations*, section 7.7).

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::friction_law::{AtNode, FrictionLaw};
use crate::solver::real::Real;

/// The law with the coefficients of one node, or of the nodes of a vector.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct StaticKinetic<R> {
    pub mu: R,
    pub mu_static: R,
}

impl<R: Real> FrictionLaw<R> for StaticKinetic<R> {
    #[inline(always)]
    fn limit_n(&self, node: &AtNode<R>) -> R {
        let slipped = node.last_slipped.at_least(node.last_slipped.constant(0.5));
        R::choose(slipped, self.mu, self.mu_static) * node.normal_n
    }
}

//! Coulomb's law without regularisation: the friction limit is μN.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::friction_law::{AtNode, FrictionLaw};
use crate::solver::real::Real;

/// Coulomb's law with the friction coefficient μ of one node, or of the nodes of a vector.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct Coulomb<R> {
    pub mu: R,
}

impl<R: Real> FrictionLaw<R> for Coulomb<R> {
    #[inline(always)]
    fn limit_n(&self, node: &AtNode<R>) -> R {
        self.mu * node.normal_n
    }
}

/// Coulomb's law with μ = 0 in all lanes.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct Frictionless;

impl<R: Real> FrictionLaw<R> for Frictionless {
    const TRANSMITS: bool = false;

    #[inline(always)]
    fn limit_n(&self, node: &AtNode<R>) -> R {
        node.normal_n.constant(0.0)
    }
}

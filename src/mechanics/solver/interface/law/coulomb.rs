//! Coulomb's law without regularisation: the friction limit is μN.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::traits::{AtNode, FrictionLimit, LawFormula};
use crate::solver::real::Real;
use crate::spec::{Contact, FrictionLaw};

/// Coulomb's law with a constant coefficient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coulomb {
    /// Friction coefficient μ ≥ 0.
    pub mu: f64,
}

impl FrictionLimit<1> for Coulomb {
    #[inline(always)]
    fn limit_n<R: Real>([mu]: [R; 1], node: &AtNode<R>) -> R {
        mu * node.normal_n
    }
}

impl LawFormula<1> for Coulomb {
    const NAME: FrictionLaw = FrictionLaw::Coulomb;

    fn of(contact: &Contact) -> Self {
        Self { mu: contact.mu }
    }

    fn numbers(&self, _time_step_s: f64) -> [f64; 1] {
        [self.mu]
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn set_mu(&mut self, mu: f64) {
        self.mu = mu;
    }
}

/// Coulomb's law with μ = 0 in all lanes.
#[derive(Debug)]
pub(in crate::solver) struct Frictionless;

impl FrictionLimit<0> for Frictionless {
    const TRANSMITS: bool = false;

    #[inline(always)]
    fn limit_n<R: Real>([]: [R; 0], node: &AtNode<R>) -> R {
        node.normal_n.constant(0.0)
    }
}

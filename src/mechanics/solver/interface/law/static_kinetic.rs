//! Two coefficients: a node that sticks, or has just touched, needs μ_s N to begin to slip. A node that slips has μ N.
//!
//! ```text
//! limit = μ_s N   if the node did not slip in the step before,   otherwise μ N
//! ```
//!
//! This is Coulomb's own observation, and the law of the classic stick–slip oscillator on a belt (Den Hartog, *Mechanical
//! Vibrations*, section 7.7).

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::traits::{AtNode, FrictionLimit, LawFormula, given, in_proportion};
use crate::solver::real::Real;
use crate::spec::{Contact, FrictionLaw};

/// One coefficient for nodes that begin to slip, and one for nodes that slip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticKinetic {
    /// Coefficient ≥ 0 of a slipping node.
    pub mu: f64,
    /// Coefficient ≥ 0 of a node that begins to slip.
    pub mu_static: f64,
}

impl FrictionLimit<2> for StaticKinetic {
    #[inline(always)]
    fn limit_n<R: Real>([mu, mu_static]: [R; 2], node: &AtNode<R>) -> R {
        let slipped = node.last_slipped.at_least(node.last_slipped.constant(0.5));
        R::choose(slipped, mu, mu_static) * node.normal_n
    }
}

impl LawFormula<2> for StaticKinetic {
    const NAME: FrictionLaw = FrictionLaw::StaticKinetic;

    fn of(contact: &Contact) -> Self {
        Self { mu: contact.mu, mu_static: given(contact.mu_static) }
    }

    fn numbers(&self, _time_step_s: f64) -> [f64; 2] {
        [self.mu, self.mu_static]
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn set_mu(&mut self, mu: f64) {
        self.mu_static = in_proportion(self.mu_static, self.mu, mu);
        self.mu = mu;
    }
}

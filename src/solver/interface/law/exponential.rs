//! A coefficient that depends on the slip speed v:
//!
//! ```text
//! limit = μ(v) N,   μ(v) = μ + (μ_s − μ) exp(−v/v₀) + s v
//! ```
//!
//! With μ_s > μ friction falls with the speed, with μ_s < μ it rises. The last term is the viscous part of a Stribeck curve
//! (Armstrong-Hélouvry, Dupont and Canudas de Wit, *Automatica* 30, 1994, eq. 5 with exponent 1).
//!
//! v is the slip speed of the step before. So the law is explicit, with an error of first order in the time step.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::friction_law::{AtNode, FrictionLaw, length};
use crate::solver::real::{Real, decay};

/// The law with the coefficients of one node, or of the nodes of a vector. Speeds are increments over a time step.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct Exponential<R> {
    pub mu: R,
    /// μ_s − μ.
    pub drop: R,
    /// 1/(v₀ Δt) \[1/m\].
    pub per_increment: R,
    /// s/Δt \[1/m\].
    pub slope_per_m: R,
}

impl<R: Real> FrictionLaw<R> for Exponential<R> {
    #[inline(always)]
    fn limit_n(&self, node: &AtNode<R>) -> R {
        let increment = length(node.last_increment_m);
        let mu = self.mu + self.drop * decay(increment * self.per_increment) + self.slope_per_m * increment;
        mu * node.normal_n
    }
}

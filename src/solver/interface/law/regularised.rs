//! Coulomb's law with friction that rises with the slip speed v, to compare with codes that have no sticking nodes:
//!
//! ```text
//! |t| = μ N v/(v + v₀)
//! ```
//!
//! There is no stick: a node under any force creeps. v is the speed over this step, so the law holds at the end of the step
//! and is stable with any v₀. The slip δ of the step follows from that without friction, δ* = |t_trial|/k, by
//! δ + (μN/k) δ/(δ + δ₀) = δ* with δ₀ = v₀Δt, which is a quadratic equation.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::friction_law::{AtNode, FrictionLaw, length};
use crate::solver::real::Real;

/// The law with the coefficients of one node, or of the nodes of a vector.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct Regularised<R> {
    pub mu: R,
    /// v₀Δt \[m\].
    pub increment_m: R,
}

impl<R: Real> FrictionLaw<R> for Regularised<R> {
    #[inline(always)]
    fn limit_n(&self, node: &AtNode<R>) -> R {
        let half = self.mu.constant(0.5);
        let four = self.mu.constant(4.0);
        let zero = self.mu.constant(0.0);
        let full_n = self.mu * node.normal_n;
        let free_m = length(node.trial_n) / node.stiffness_n_m;
        let reach_m = full_n / node.stiffness_n_m;
        // δ² + bδ − δ*δ₀ = 0. Of the two forms of its root, each cancels for one sign of b.
        let b = (self.increment_m + reach_m) - free_m;
        let product = free_m * self.increment_m;
        let root = (b * b + four * product).root();
        let b_is_negative = b.at_most(zero);
        let sum = R::choose(b_is_negative, root - b, root + b);
        let safe = R::choose(sum.at_most(zero), self.mu.constant(1.0), sum);
        let slip_m = R::choose(b_is_negative, half * sum, (half * four) * product / safe);
        full_n * (slip_m / (slip_m + self.increment_m))
    }
}

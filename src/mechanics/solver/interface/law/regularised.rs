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

use super::traits::{AtNode, FrictionLimit, LawFormula, given, length};
use crate::solver::real::Real;
use crate::spec::{Contact, FrictionLaw};

/// |t| = μ N v/(v + v₀).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Regularised {
    /// Coefficient μ ≥ 0 of fast slip.
    pub mu: f64,
    /// Slip speed v₀ > 0 \[m/s\] at which friction is half of that.
    pub speed_m_s: f64,
}

/// The numbers are μ and δ₀ = v₀Δt \[m\].
impl FrictionLimit<2> for Regularised {
    #[inline(always)]
    fn limit_n<R: Real>([mu, increment_m]: [R; 2], node: &AtNode<R>) -> R {
        let half = mu.constant(0.5);
        let four = mu.constant(4.0);
        let zero = mu.constant(0.0);
        let full_n = mu * node.normal_n;
        let free_m = length(node.trial_n) / node.stiffness_n_m;
        let reach_m = full_n / node.stiffness_n_m;
        // δ² + bδ − δ*δ₀ = 0. Of the two forms of its root, each cancels for one sign of b.
        let b = (increment_m + reach_m) - free_m;
        let product = free_m * increment_m;
        let root = (b * b + four * product).root();
        let b_is_negative = b.at_most(zero);
        let sum = R::choose(b_is_negative, root - b, root + b);
        let safe = R::choose(sum.at_most(zero), mu.constant(1.0), sum);
        let slip_m = R::choose(b_is_negative, half * sum, (half * four) * product / safe);
        full_n * (slip_m / (slip_m + increment_m))
    }
}

impl LawFormula<2> for Regularised {
    const NAME: FrictionLaw = FrictionLaw::Regularised;

    fn of(contact: &Contact) -> Self {
        Self { mu: contact.mu, speed_m_s: given(contact.speed_m_s) }
    }

    fn numbers(&self, time_step_s: f64) -> [f64; 2] {
        [self.mu, self.speed_m_s * time_step_s]
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn set_mu(&mut self, mu: f64) {
        self.mu = mu;
    }

    fn steady(&self, speed_m_s: f64) -> Option<[f64; 2]> {
        let sum = speed_m_s + self.speed_m_s;
        Some([self.mu * speed_m_s / sum, self.mu * self.speed_m_s / (sum * sum)])
    }
}

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

use super::traits::{AtNode, FrictionLimit, LawFormula, given, in_proportion, length};
use crate::solver::real::{Real, decay};
use crate::spec::{Contact, FrictionLaw};

/// μ(v) = μ + (μ_s − μ) exp(−v/v₀) + s v.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponential {
    /// Coefficient μ ≥ 0 of fast slip, without the viscous part.
    pub mu: f64,
    /// Coefficient μ_s ≥ 0 of slow slip.
    pub mu_static: f64,
    /// Slip speed v₀ > 0 \[m/s\].
    pub speed_m_s: f64,
    /// Viscous part s ≥ 0 \[s/m\].
    pub slope_s_m: f64,
}

/// The numbers are μ, μ_s − μ, 1/(v₀ Δt) and s/Δt, because speeds are increments over a time step.
impl FrictionLimit<4> for Exponential {
    #[inline(always)]
    fn limit_n<R: Real>([mu, drop, per_increment, slope_per_m]: [R; 4], node: &AtNode<R>) -> R {
        let increment = length(node.last_increment_m);
        let mu = mu + drop * decay(increment * per_increment) + slope_per_m * increment;
        mu * node.normal_n
    }
}

impl LawFormula<4> for Exponential {
    const NAME: FrictionLaw = FrictionLaw::Exponential;

    fn of(contact: &Contact) -> Self {
        Self {
            mu: contact.mu,
            mu_static: given(contact.mu_static),
            speed_m_s: given(contact.speed_m_s),
            slope_s_m: contact.slope_s_m.unwrap_or(0.0),
        }
    }

    fn numbers(&self, time_step_s: f64) -> [f64; 4] {
        let Self { mu, mu_static, speed_m_s, slope_s_m } = self;
        [*mu, mu_static - mu, 1.0 / (speed_m_s * time_step_s), slope_s_m / time_step_s]
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn set_mu(&mut self, mu: f64) {
        self.mu_static = in_proportion(self.mu_static, self.mu, mu);
        self.mu = mu;
    }

    fn steady(&self, speed_m_s: f64) -> Option<[f64; 2]> {
        let drop = (self.mu_static - self.mu) * libm::exp(-speed_m_s / self.speed_m_s);
        Some([self.mu + drop + self.slope_s_m * speed_m_s, self.slope_s_m - drop / self.speed_m_s])
    }
}

//! A coefficient that follows a table over the slip speed v:
//!
//! ```text
//! limit = μ(v) N,   μ(v) = μ(0) + Σ over parts of t (a + t (b + t c)),   t = (v − v₁)/(v₂ − v₁), at least 0 and at most 1
//! ```
//!
//! v is the slip speed of the step before, as in the [exponential](super::Exponential) law.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::traits::{AtNode, FrictionLimit, LawFormula, length};
use crate::solver::real::Real;
use crate::spec::{Contact, FrictionLaw, MOST_PAIRS, Segment};

/// Parts between the pairs of a table.
const PARTS: usize = MOST_PAIRS - 1;

/// Numbers of a part: 1/((v₂ − v₁) Δt), v₁/(v₂ − v₁), a, b and c.
const OF_PART: usize = 5;

/// The numbers of a step: μ(0), and those of the parts.
const NUMBERS: usize = 1 + OF_PART * PARTS;

/// A coefficient that follows a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Table {
    /// Coefficient ≥ 0 of fast slip.
    mu: f64,
    /// The coefficient at rest.
    at_rest: f64,
    /// The parts. Those that the table does not have add nothing.
    parts: [Segment; PARTS],
}

/// A part that adds nothing at any speed.
const NO_PART: Segment = Segment { from_m_s: 0.0, width_m_s: f64::INFINITY, powers: [0.0; 3] };

impl FrictionLimit<NUMBERS> for Table {
    #[inline(always)]
    fn limit_n<R: Real>(numbers: [R; NUMBERS], node: &AtNode<R>) -> R {
        let increment = length(node.last_increment_m);
        let (zero, one) = (increment.constant(0.0), increment.constant(1.0));
        let mut mu = numbers[0];
        for part in 0..PARTS {
            let [per_increment, begin, a, b, c] = std::array::from_fn(|at| numbers[1 + OF_PART * part + at]);
            let t = increment * per_increment - begin;
            let t = R::choose(t.at_most(zero), zero, R::choose(t.at_most(one), t, one));
            mu = mu + t * (a + t * (b + t * c));
        }
        mu * node.normal_n
    }
}

impl LawFormula<NUMBERS> for Table {
    const NAME: FrictionLaw = FrictionLaw::Table;

    fn of(contact: &Contact) -> Self {
        let scale = contact.mu / contact.mu_of_speed.fast().unwrap_or(f64::NAN);
        let mut parts = [NO_PART; PARTS];
        for (part, own) in parts.iter_mut().zip(contact.mu_of_speed.segments()) {
            *part = Segment { powers: own.powers.map(|factor| factor * scale), ..own };
        }
        Self { mu: contact.mu, at_rest: contact.mu_of_speed.at(0.0)[0] * scale, parts }
    }

    fn numbers(&self, time_step_s: f64) -> [f64; NUMBERS] {
        let mut numbers = [self.at_rest; NUMBERS];
        for (own, Segment { from_m_s, width_m_s, powers: [a, b, c] }) in
            numbers[1..].chunks_exact_mut(OF_PART).zip(self.parts)
        {
            own.copy_from_slice(&[1.0 / (width_m_s * time_step_s), from_m_s / width_m_s, a, b, c]);
        }
        numbers
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn set_mu(&mut self, mu: f64) {
        // Without friction of fast slip there is no proportion, and the table stays, as a static coefficient does.
        if self.mu != 0.0 && mu != self.mu {
            let scale = mu / self.mu;
            self.at_rest *= scale;
            for part in &mut self.parts {
                part.powers = part.powers.map(|factor| factor * scale);
            }
        }
        self.mu = mu;
    }

    fn steady(&self, speed_m_s: f64) -> Option<[f64; 2]> {
        let at_rest = [self.at_rest, 0.0];
        Some(self.parts.iter().filter(|part| part.width_m_s.is_finite()).fold(
            at_rest,
            |[mu, slope], part| {
                let [more, steeper] = part.at(speed_m_s);
                [mu + more, slope + steeper]
            },
        ))
    }
}

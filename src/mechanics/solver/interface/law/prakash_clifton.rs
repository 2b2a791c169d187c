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

use super::traits::{AtNode, FrictionLimit, LawFormula, given, length};
use crate::solver::real::{Real, decay};
use crate::spec::{Contact, FrictionLaw};

/// A limit that approaches μ N within a slip L.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrakashClifton {
    /// Coefficient μ ≥ 0 of long slip under a constant load.
    pub mu: f64,
    /// Slip L > 0 \[m\].
    pub length_m: f64,
}

/// The numbers are μ and 1/L \[1/m\].
impl FrictionLimit<2> for PrakashClifton {
    #[inline(always)]
    fn limit_n<R: Real>([mu, per_m]: [R; 2], node: &AtNode<R>) -> R {
        let aim = mu * node.normal_n;
        aim + (node.last_limit_n - aim) * decay(length(node.last_increment_m) * per_m)
    }
}

impl LawFormula<2> for PrakashClifton {
    const NAME: FrictionLaw = FrictionLaw::PrakashClifton;

    fn of(contact: &Contact) -> Self {
        Self { mu: contact.mu, length_m: given(contact.length_m) }
    }

    fn numbers(&self, _time_step_s: f64) -> [f64; 2] {
        [self.mu, 1.0 / self.length_m]
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn set_mu(&mut self, mu: f64) {
        self.mu = mu;
    }
}

//! Friction laws.
//!
//! A law gives the friction limit of a slave node, which is its largest friction force. The projection (`project`)
//! is the same for every law. A node whose trial force is within the limit sticks. Any other node slips, and a
//! force of the size of the limit opposes its slip.
//!
//! To add a law, write a file that implements `FrictionLaw` for it, add a variant to [`Law`], and an arm to each
//! `match` on it. `LawOfLanes` must serve lanes with different laws, because a lane without a job has
//! Coulomb's law with μ = 0.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

mod cone;
mod coulomb;
mod friction_law;

pub(in crate::solver) use cone::project;
pub(in crate::solver) use coulomb::{Coulomb, Frictionless};
pub(in crate::solver) use friction_law::FrictionLaw;

use crate::solver::field::in_slots_of;
use crate::solver::number::Number;

/// A friction law with the coefficients of one lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// Coulomb's law with a constant coefficient.
    Coulomb {
        /// Friction coefficient μ ≥ 0.
        mu: f64,
    },
}

impl Law {
    /// The friction limit \[N\] of one node; see [`FrictionLaw::limit_n`].
    #[inline(always)]
    pub(in crate::solver) fn limit_n(self, normal_n: f64, increment_m: [f64; 2], slipped: f64) -> f64 {
        match self {
            Self::Coulomb { mu } => Coulomb { mu }.limit_n(normal_n, increment_m, slipped),
        }
    }
}

/// The laws of all lanes, in the slots of a vector.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) enum LawOfLanes<R: Number> {
    /// Coulomb's law with μ = 0 in all lanes.
    Frictionless,
    /// Coulomb's law with these coefficients.
    Coulomb(R::Row),
}

impl<R: Number> LawOfLanes<R> {
    pub fn new<const L: usize>(laws: [Law; L]) -> Self {
        let coefficients = laws.map(|Law::Coulomb { mu }| mu);
        if coefficients.iter().all(|mu| *mu == 0.0) {
            Self::Frictionless
        } else {
            Self::Coulomb(in_slots_of::<R>(&coefficients))
        }
    }
}

/// Calls SIMD code with the law of all lanes. The code is compiled for each law and for each SIMD level.
macro_rules! with_law_of_lanes {
    ($laws:expr, $simd:ident, $law:ident => $call:expr) => {
        match $laws {
            $crate::solver::interface::law::LawOfLanes::Frictionless => {
                let $law = $crate::solver::interface::law::Frictionless;
                $crate::solver::simd::dispatch!($simd => $call)
            }
            $crate::solver::interface::law::LawOfLanes::Coulomb(mu) => {
                $crate::solver::simd::dispatch!($simd => {
                    let mu = $crate::solver::simd::load::<R, _>($simd, &mu);
                    let $law = $crate::solver::interface::law::Coulomb { mu };
                    $call
                })
            }
        }
    };
}
pub(in crate::solver) use with_law_of_lanes;

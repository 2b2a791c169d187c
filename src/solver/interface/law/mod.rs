//! Friction laws.
//!
//! A law gives the friction limit of a slave node, which is its largest friction force. The projection (`project`)
//! is the same for every law. A node whose trial force is within the limit sticks. Any other node slips, and a
//! force of the size of the limit opposes its slip.
//!
//! To add a law, write a file that implements `FrictionLaw` for it, add a variant to [`Law`] and to `LawOfLanes`, and an
//! arm to each `match` on them. The lanes of a batch have one law with coefficients of their own.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

mod cone;
mod coulomb;
mod exponential;
mod friction_law;
mod prakash_clifton;
mod regularised;
mod static_kinetic;

pub(in crate::solver) use cone::project;
pub(in crate::solver) use coulomb::{Coulomb, Frictionless};
pub(in crate::solver) use exponential::Exponential;
pub(in crate::solver) use friction_law::{AtNode, FrictionLaw};
pub(in crate::solver) use prakash_clifton::PrakashClifton;
pub(in crate::solver) use regularised::Regularised;
pub(in crate::solver) use static_kinetic::StaticKinetic;

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
    /// One coefficient for nodes that begin to slip, and one for nodes that slip.
    StaticKinetic {
        /// Coefficient ≥ 0 of a slipping node.
        mu: f64,
        /// Coefficient ≥ 0 of a node that begins to slip.
        mu_static: f64,
    },
    /// μ(v) = μ + (μ_s − μ) exp(−v/v₀) + s v.
    Exponential {
        /// Coefficient μ ≥ 0 of fast slip, without the viscous part.
        mu: f64,
        /// Coefficient μ_s ≥ 0 of slow slip.
        mu_static: f64,
        /// Slip speed v₀ > 0 \[m/s\].
        speed_m_s: f64,
        /// Viscous part s ≥ 0 \[s/m\].
        slope_s_m: f64,
    },
    /// |t| = μ N v/(v + v₀).
    Regularised {
        /// Coefficient μ ≥ 0 of fast slip.
        mu: f64,
        /// Slip speed v₀ > 0 \[m/s\] at which friction is half of that.
        speed_m_s: f64,
    },
    /// A limit that approaches μ N within a slip L.
    PrakashClifton {
        /// Coefficient μ ≥ 0 of long slip under a constant load.
        mu: f64,
        /// Slip L > 0 \[m\].
        length_m: f64,
    },
}

impl Law {
    /// The coefficient μ that every law has.
    pub fn mu(self) -> f64 {
        match self {
            Self::Coulomb { mu }
            | Self::StaticKinetic { mu, .. }
            | Self::Exponential { mu, .. }
            | Self::Regularised { mu, .. }
            | Self::PrakashClifton { mu, .. } => mu,
        }
    }

    /// The friction limit \[N\] of one node; see [`FrictionLaw::limit_n`].
    #[inline(always)]
    pub(in crate::solver) fn limit_n(self, node: &AtNode<f64>, time_step_s: f64) -> f64 {
        let [a, b, c, d] = self.coefficients(time_step_s);
        match self {
            Self::Coulomb { .. } => Coulomb { mu: a }.limit_n(node),
            Self::StaticKinetic { .. } => StaticKinetic { mu: a, mu_static: b }.limit_n(node),
            Self::Exponential { .. } => {
                Exponential { mu: a, drop: b, per_increment: c, slope_per_m: d }.limit_n(node)
            }
            Self::Regularised { .. } => Regularised { mu: a, increment_m: b }.limit_n(node),
            Self::PrakashClifton { .. } => PrakashClifton { mu: a, per_m: b }.limit_n(node),
        }
    }

    /// The numbers from which the law is made, for a time step, in the order of the fields of its type.
    fn coefficients(self, time_step_s: f64) -> [f64; 4] {
        match self {
            Self::Coulomb { mu } => [mu, 0.0, 0.0, 0.0],
            Self::StaticKinetic { mu, mu_static } => [mu, mu_static, 0.0, 0.0],
            Self::Exponential { mu, mu_static, speed_m_s, slope_s_m } => {
                [mu, mu_static - mu, 1.0 / (speed_m_s * time_step_s), slope_s_m / time_step_s]
            }
            Self::Regularised { mu, speed_m_s } => [mu, speed_m_s * time_step_s, 0.0, 0.0],
            Self::PrakashClifton { mu, length_m } => [mu, 1.0 / length_m, 0.0, 0.0],
        }
    }
}

/// The law of all lanes, with the coefficients of each in the slots of a vector.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) enum LawOfLanes<R: Number> {
    /// Coulomb's law with μ = 0 in all lanes.
    Frictionless,
    Coulomb(R::Row),
    StaticKinetic([R::Row; 2]),
    Exponential([R::Row; 4]),
    Regularised([R::Row; 2]),
    PrakashClifton([R::Row; 2]),
}

impl<R: Number> LawOfLanes<R> {
    /// Lanes of one law. A lane without a job may have Coulomb's law with μ = 0 beside any other: its load is zero, so that
    /// any coefficients serve.
    pub fn new<const L: usize>(laws: [Law; L], time_step_s: f64) -> Self {
        let is_idle = |law: &Law| *law == Law::Coulomb { mu: 0.0 };
        let Some(law) = laws.iter().find(|law| !is_idle(law)) else { return Self::Frictionless };
        let kind = std::mem::discriminant(law);
        debug_assert!(
            laws.iter().all(|law| is_idle(law) || std::mem::discriminant(law) == kind),
            "lanes of one law: {laws:?}"
        );
        let coefficients = laws.map(|law| law.coefficients(time_step_s));
        let row = |place: usize| in_slots_of::<R>(&coefficients.map(|of_lane| of_lane[place]));
        match law {
            Law::Coulomb { .. } => Self::Coulomb(row(0)),
            Law::StaticKinetic { .. } => Self::StaticKinetic([row(0), row(1)]),
            Law::Exponential { .. } => Self::Exponential([row(0), row(1), row(2), row(3)]),
            Law::Regularised { .. } => Self::Regularised([row(0), row(1)]),
            Law::PrakashClifton { .. } => Self::PrakashClifton([row(0), row(1)]),
        }
    }
}

/// Calls SIMD code with the law of all lanes. The code is compiled for each law and for each SIMD level.
macro_rules! with_law_of_lanes {
    ($laws:expr, $simd:ident, $law:ident => $call:expr) => {{
        use $crate::solver::interface::law::{
            Coulomb, Exponential, Frictionless, LawOfLanes, PrakashClifton, Regularised, StaticKinetic,
        };
        use $crate::solver::simd::{dispatch, load};
        match $laws {
            LawOfLanes::Frictionless => {
                let $law = Frictionless;
                dispatch!($simd => $call)
            }
            LawOfLanes::Coulomb(mu) => {
                dispatch!($simd => {
                    let $law = Coulomb { mu: load::<R, _>($simd, &mu) };
                    $call
                })
            }
            LawOfLanes::StaticKinetic(rows) => {
                dispatch!($simd => {
                    let [mu, mu_static] = rows.map(|row| load::<R, _>($simd, &row));
                    let $law = StaticKinetic { mu, mu_static };
                    $call
                })
            }
            LawOfLanes::Exponential(rows) => {
                dispatch!($simd => {
                    let [mu, drop, per_increment, slope_per_m] = rows.map(|row| load::<R, _>($simd, &row));
                    let $law = Exponential { mu, drop, per_increment, slope_per_m };
                    $call
                })
            }
            LawOfLanes::Regularised(rows) => {
                dispatch!($simd => {
                    let [mu, increment_m] = rows.map(|row| load::<R, _>($simd, &row));
                    let $law = Regularised { mu, increment_m };
                    $call
                })
            }
            LawOfLanes::PrakashClifton(rows) => {
                dispatch!($simd => {
                    let [mu, per_m] = rows.map(|row| load::<R, _>($simd, &row));
                    let $law = PrakashClifton { mu, per_m };
                    $call
                })
            }
        }
    }};
}
pub(in crate::solver) use with_law_of_lanes;

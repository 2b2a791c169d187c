//! Friction of steady sliding, linear in small vibrations.
//!
//! Friction of a slipping node is t = μ(|v|) N v/|v|, with the velocity v of the disk relative to the node. About steady sliding,
//! with the disk's velocity V d, its normal force N₀ and a small velocity q̇ of the node,
//!
//! ```text
//! δt = μ(V) δN d − μ′(V) N₀ (d·q̇) d − μ(V) N₀/V (q̇ − (d·q̇) d)
//! ```
//!
//! So the slope μ′ of the law is a damper along the disk's velocity, which feeds vibrations if friction falls with the speed. A
//! law with a kinetic coefficient is Coulomb's here, because no node sticks.

use super::error::StabilityError;
use super::pencil::Sampling;
use crate::solver::Drive;
use crate::solver::interface::law::Law;

/// Friction of steady sliding at every slave node.
#[derive(Debug, Clone)]
pub struct SlidingFriction {
    /// The scale of the friction coefficients.
    pub mu: f64,
    /// Friction coefficient of each slave node over the scale.
    pub share: Vec<f64>,
    /// μ′ \[s/m\] at each slave node, and when the law takes the slip; none if the coefficient does not depend on the speed.
    pub slope: Option<(Vec<f64>, Sampling)>,
}

impl SlidingFriction {
    /// Friction under slave nodes with these speeds of the disk per unit of the drive's rate.
    ///
    /// # Errors
    /// If the law has a state.
    pub fn new(speeds_per_rate: &[f64], drive: &Drive) -> Result<Self, StabilityError> {
        let speeds_m_s = speeds_per_rate.iter().map(|speed| speed * drive.rate.abs());
        let constant = |mu| Self { mu, share: vec![1.0; speeds_per_rate.len()], slope: None };
        let varying = |of: &dyn Fn(f64) -> [f64; 2], sampling| {
            let (share, slope_s_m) = speeds_m_s.map(|speed| of(speed).into()).unzip();
            Self { mu: 1.0, share, slope: Some((slope_s_m, sampling)) }
        };
        match drive.law {
            Law::Coulomb { mu } | Law::StaticKinetic { mu, .. } => Ok(constant(mu)),
            Law::Exponential { mu, mu_static, speed_m_s, slope_s_m } => {
                let at = |speed: f64| {
                    let drop = (mu_static - mu) * libm::exp(-speed / speed_m_s);
                    [mu + drop + slope_s_m * speed, slope_s_m - drop / speed_m_s]
                };
                Ok(varying(&at, Sampling::StepBefore))
            }
            Law::Regularised { mu, speed_m_s } => {
                let at = |speed: f64| {
                    let sum = speed + speed_m_s;
                    [mu * speed / sum, mu * speed_m_s / (sum * sum)]
                };
                Ok(varying(&at, Sampling::Step))
            }
            Law::PrakashClifton { .. } => Err(StabilityError::FrictionLaw),
        }
    }

    /// Whether friction falls with the speed somewhere, so that it feeds vibrations.
    pub fn falls(&self) -> bool {
        self.slope.iter().any(|(slope_s_m, _)| slope_s_m.iter().any(|slope| *slope < 0.0))
    }

    /// The friction coefficient of a slave node.
    pub fn mu_of(&self, slave: usize) -> f64 {
        self.mu * self.share[slave]
    }
}

/// The same law with another coefficient μ. The static coefficient changes in proportion; without kinetic friction there is no
/// proportion, and it stays.
pub fn with_mu(law: Law, mu: f64) -> Law {
    let scaled =
        |mu_static: f64, before: f64| if before == 0.0 { mu_static } else { mu_static * mu / before };
    match law {
        Law::Coulomb { .. } => Law::Coulomb { mu },
        Law::StaticKinetic { mu: before, mu_static } => {
            Law::StaticKinetic { mu, mu_static: scaled(mu_static, before) }
        }
        Law::Exponential { mu: before, mu_static, speed_m_s, slope_s_m } => {
            Law::Exponential { mu, mu_static: scaled(mu_static, before), speed_m_s, slope_s_m }
        }
        Law::Regularised { speed_m_s, .. } => Law::Regularised { mu, speed_m_s },
        Law::PrakashClifton { length_m, .. } => Law::PrakashClifton { mu, length_m },
    }
}

/// What points share whose equilibria are the same: the law without what steady sliding does not use, the speed if the law
/// depends on it, and the load if the base has gaps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    law: Law,
    rate: f64,
    force_n: f64,
}

impl Conditions {
    pub fn new(drive: &Drive, has_gaps: bool) -> Self {
        let law = match drive.law {
            Law::StaticKinetic { mu, .. } => Law::Coulomb { mu },
            law => law,
        };
        let depends_on_speed = !matches!(law, Law::Coulomb { .. });
        Self {
            law,
            rate: if depends_on_speed { drive.rate } else { 0.0 },
            force_n: if has_gaps { drive.force_n } else { 0.0 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a law without kinetic friction has finite coefficients at another μ: the static one stays, and elsewhere it
    /// changes in proportion.
    #[test]
    fn a_law_without_kinetic_friction_has_another_mu() {
        let exponential = |mu, mu_static| Law::Exponential { mu, mu_static, speed_m_s: 0.1, slope_s_m: 0.0 };
        let static_kinetic = |mu, mu_static| Law::StaticKinetic { mu, mu_static };
        assert_eq!(with_mu(exponential(0.0, 0.3), 0.0), exponential(0.0, 0.3));
        assert_eq!(with_mu(static_kinetic(0.0, 0.3), 0.01), static_kinetic(0.01, 0.3));
        assert_eq!(with_mu(static_kinetic(0.2, 0.3), 0.4), static_kinetic(0.4, 0.6));
    }

    /// Protects: friction counts as falling only where its slope at the speed of sliding is negative.
    #[test]
    fn only_a_negative_slope_falls() {
        let falls = |law| {
            let drive = Drive { law, rate: 1.0, force_n: 30.0, ramp_s: 0.0 };
            SlidingFriction::new(&[0.1, 0.2], &drive).unwrap().falls()
        };
        let exponential = |mu, mu_static| Law::Exponential { mu, mu_static, speed_m_s: 0.1, slope_s_m: 0.0 };
        assert!(falls(exponential(0.2, 0.3)) && !falls(exponential(0.3, 0.3)));
        assert!(!falls(Law::Regularised { mu: 0.3, speed_m_s: 0.1 }) && !falls(Law::Coulomb { mu: 0.3 }));
    }
}

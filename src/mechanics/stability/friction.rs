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
use crate::spec::Memory;

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
        let sampling = match drive.law.memory() {
            Memory::None => Sampling::Step,
            Memory::Slip => Sampling::StepBefore,
            Memory::Limit => return Err(StabilityError::FrictionLaw { law: drive.law.name().name() }),
        };
        let at = |speed: &f64| drive.law.steady(speed * drive.rate.abs());
        Ok(match speeds_per_rate.iter().map(at).collect::<Option<Vec<_>>>() {
            None => Self { mu: drive.law.mu(), share: vec![1.0; speeds_per_rate.len()], slope: None },
            Some(varying) => {
                let (share, slope_s_m) = varying.into_iter().map(<(f64, f64)>::from).unzip();
                Self { mu: 1.0, share, slope: Some((slope_s_m, sampling)) }
            }
        })
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
        let depends_on_speed = drive.law.steady(drive.rate).is_some();
        let uses_mu_alone = !depends_on_speed && drive.law.memory() != Memory::Limit;
        Self {
            law: if uses_mu_alone { Law::coulomb(drive.law.mu()) } else { drive.law },
            rate: if depends_on_speed { drive.rate } else { 0.0 },
            force_n: if has_gaps { drive.force_n } else { 0.0 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::interface::law::{Exponential, Regularised};

    /// Protects: friction counts as falling only where its slope at the speed of sliding is negative.
    #[test]
    fn only_a_negative_slope_falls() {
        let falls = |law| {
            let drive = Drive { law, rate: 1.0, force_n: 30.0, ramp_s: 0.0 };
            SlidingFriction::new(&[0.1, 0.2], &drive).unwrap().falls()
        };
        let exponential =
            |mu, mu_static| Law::Exponential(Exponential { mu, mu_static, speed_m_s: 0.1, slope_s_m: 0.0 });
        assert!(falls(exponential(0.2, 0.3)) && !falls(exponential(0.3, 0.3)));
        assert!(
            !falls(Law::Regularised(Regularised { mu: 0.3, speed_m_s: 0.1 })) && !falls(Law::coulomb(0.3))
        );
    }
}

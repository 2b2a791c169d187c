//! The linear stability of steady sliding: equilibrium, complex modes, thresholds.

mod basis;
mod coarse;
mod decision;
mod equilibrium;
mod error;
mod extension;
mod pencil;
mod point;
mod separable;
mod sliding;
mod solve;
mod space;
mod vibration;

pub use error::StabilityError;

use crate::solver::interface::law::Law;
use crate::solver::support::Support;
use crate::solver::{Drive, Model};
use basis::Basis;
pub use decision::Decision;
use decision::{further_mu, verdict};
use equilibrium::UnitEquilibrium;
use pencil::Clock;
pub use point::{Accuracy, Aim};
use point::{Friction, Point};
use separable::Separable;
pub use sliding::{Equilibrium, Mode, SlidingPoint};
use solve::Bilateral;
use space::{Elasticity, Space};
use std::sync::{Arc, Mutex, PoisonError};

/// What all points of a model share: everything that does not depend on friction, speed and load.
#[derive(Debug)]
pub struct Structure {
    space: Space,
    separable: Separable,
    basis: Basis,
    /// What the points of one μ share, for the μ used last.
    frictions: Mutex<Vec<Arc<Friction>>>,
}

/// Number of friction coefficients that are remembered.
const REMEMBERED: usize = 16;

impl Structure {
    /// What all points of `model` share.
    ///
    /// # Errors
    /// If the disk is elastic.
    pub fn new(model: &Model) -> Result<Self, StabilityError> {
        if model.ring().is_some() {
            return Err(StabilityError::ElasticDisk);
        }
        if model.mesh().block().is_none() {
            return Err(StabilityError::Shape);
        }
        let space = Space::new(model);
        let separable = Separable::new(model);
        let basis = Basis::new(model, &space, &separable);
        Ok(Self { space, separable, basis, frictions: Mutex::default() })
    }

    /// Equilibrium and the leading `modes` modes of steady sliding.
    ///
    /// # Errors
    /// If there is no equilibrium, or if an iteration does not converge.
    pub fn point(&self, model: &Model, drive: &Drive, modes: usize) -> Result<SlidingPoint, StabilityError> {
        self.point_with(model, drive, modes, Accuracy::default())
    }

    /// As [`Structure::point`], with other limits for the corrections in the full space.
    ///
    /// # Errors
    /// As [`Structure::point`].
    pub fn point_with(
        &self,
        model: &Model,
        drive: &Drive,
        modes: usize,
        accuracy: Accuracy,
    ) -> Result<SlidingPoint, StabilityError> {
        let mu = coulomb_on_a_plane(model, drive)?;
        let friction = self.friction(model, mu)?;
        let scheme = model.scheme();
        let point = Point {
            space: &self.space,
            basis: &self.basis,
            friction: &friction,
            bilateral: Bilateral {
                space: &self.space,
                separable: &self.separable,
                contact: point::contact(&friction.equilibrium),
            },
            load_over_rate: drive.force_n / drive.rate,
            // β₂ > ½ damps like a stiffness-proportional damping of (β₂ − ½)Δt, to first order.
            steps: Clock::Steps {
                time_step_s: scheme.time_step_s,
                beta2: scheme.beta2,
                beta_r_s: scheme.beta_r_s,
            },
            damping_s: scheme.beta_r_s + (scheme.beta2 - 0.5) * scheme.time_step_s,
        };
        let found = point.modes(&mut Elasticity::new(model), modes, accuracy);
        let unit = &friction.equilibrium;
        let modes: Vec<Mode> = found
            .into_iter()
            .map(|mode| Mode {
                eigenvalue_per_s: mode.value,
                eigenvalue_in_steps_per_s: mode.value_in_steps,
                residual: mode.residual,
                growth_error_per_s: mode.error_per_s,
                is_converged: mode.residual <= accuracy.residual,
                shape: mode.shape,
            })
            .collect();
        Ok(SlidingPoint {
            equilibrium: Equilibrium {
                u_m: unit.u.iter().map(|u| u * drive.force_n).collect(),
                normal_n: unit.normal.iter().map(|normal| normal * drive.force_n).collect(),
                in_contact: unit.in_contact.clone(),
                mu_star: unit.mu_star(&self.space, mu),
            },
            modes,
            band_hz: self.basis.band_hz,
            has_all_modes: self.basis.is_complete,
            basis: self.basis.len(),
        })
    }

    /// The modes of a point, what they say, and whether they show that a run decays: sliding is stable at such a distance from the
    /// threshold that no limit cycle was found beside it. The modes are exact only as far as this question needs it.
    ///
    /// # Errors
    /// As [`Structure::point`].
    pub fn decide(
        &self,
        model: &Model,
        drive: &Drive,
        modes: usize,
    ) -> Result<(SlidingPoint, Decision, bool), StabilityError> {
        let mu = coulomb_on_a_plane(model, drive)?;
        let mu = further_mu(mu, natural_speed_ratio(model, drive, mu));
        let further = Drive { law: Law::Coulomb { mu }, ..*drive };
        let (point, verdict) = self.resolve(model, drive, modes)?;
        let is_stable = |resolved: Result<(SlidingPoint, Decision), _>| {
            resolved.is_ok_and(|(_, verdict)| verdict == Decision::Stable)
        };
        let is_safe = verdict == Decision::Stable && is_stable(self.resolve(model, &further, modes));
        Ok((point, verdict, is_safe))
    }

    /// A point with as few corrections as its verdict needs.
    fn resolve(
        &self,
        model: &Model,
        drive: &Drive,
        modes: usize,
    ) -> Result<(SlidingPoint, Decision), StabilityError> {
        let signs = Accuracy { aim: Aim::Signs, rounds: 3, ..Accuracy::default() };
        let point = self.point_with(model, drive, modes, signs)?;
        let verdict = verdict(&point, damping_s(model));
        Ok((point, verdict))
    }

    /// What the points of one μ share. It is computed once for as many μ as are remembered.
    fn friction(&self, model: &Model, mu: f64) -> Result<Arc<Friction>, StabilityError> {
        let known = |all: &[Arc<Friction>]| all.iter().find(|friction| friction.mu == mu).cloned();
        let lock = || self.frictions.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(friction) = known(&lock()) {
            return Ok(friction);
        }
        let equilibrium = UnitEquilibrium::new(model, &self.space, &self.separable, mu)?;
        let friction = Arc::new(Friction::new(&self.space, &self.basis, mu, equilibrium));
        let mut all = lock();
        if all.len() == REMEMBERED {
            all.remove(0);
        }
        all.push(Arc::clone(&friction));
        Ok(friction)
    }
}

/// The stiffness-proportional damping \[s\]. β₂ > ½ damps like (β₂ − ½)Δt, to first order.
fn damping_s(model: &Model) -> f64 {
    let scheme = model.scheme();
    scheme.beta_r_s + (scheme.beta2 - 0.5) * scheme.time_step_s
}

/// The disk's mean speed over the pin's natural speed μp/(ρc_s), with the mean pressure p on the contact face. It is infinite
/// without friction.
fn natural_speed_ratio(model: &Model, drive: &Drive, mu: f64) -> f64 {
    let slaves = model.slaves();
    let speeds = slaves.iter().map(|slave| libm::hypot(slave.surface_motion[0], slave.surface_motion[1]));
    let speed_m_s = drive.rate * speeds.sum::<f64>() / slaves.len() as f64;
    let area_m2: f64 = slaves.iter().map(|slave| slave.area_m2).sum();
    let material = model.pin().material();
    let impedance = material.density_kg_m3 * material.shear_wave_speed_m_s();
    speed_m_s * impedance * area_m2 / (mu * drive.force_n)
}

/// The friction coefficient, if the equations of steady sliding hold: Coulomb's law, an ideal clamp, and a base without gaps,
/// so that everything is proportional to the load.
fn coulomb_on_a_plane(model: &Model, drive: &Drive) -> Result<f64, StabilityError> {
    let Law::Coulomb { mu } = drive.law else { return Err(StabilityError::FrictionLaw) };
    if model.slaves().iter().any(|slave| slave.initial_gap_m > 0.0) {
        return Err(StabilityError::Base);
    }
    if model.supports().iter().any(|support| matches!(support, Support::Held(_))) {
        return Err(StabilityError::Holder);
    }
    Ok(mu)
}

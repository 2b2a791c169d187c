//! The linear stability of steady sliding: equilibrium, complex modes, thresholds.

#![warn(clippy::disallowed_methods)]

mod basis;
mod bound;
mod coarse;
mod dashpots;
mod decision;
mod equilibrium;
mod error;
mod extension;
mod friction;
mod pencil;
mod point;
mod separable;
mod sliding;
mod solve;
mod space;
mod sparse;
mod stop;
mod vibration;

pub use error::StabilityError;
pub use friction::SlidingFriction;

use crate::solver::scheme::Scheme;
use crate::solver::support::Support;
use crate::solver::{Drive, Model};
use basis::Basis;
use dashpots::{Dashpot, Dashpots};
pub use decision::Decision;
use decision::{further_mu, verdict};
use equilibrium::UnitEquilibrium;
use friction::Conditions;
use pencil::{Clock, Sampling};
pub use point::{Accuracy, Aim};
use point::{Friction, Point};
use separable::Separable;
use sliding::JUDGED;
pub use sliding::{Equilibrium, Mode, SlidingPoint};
use solve::Bilateral;
use space::{Elasticity, Space};
pub use sparse::{ModesNear, SparseStructure};
use std::sync::{Arc, Mutex, PoisonError};
pub use stop::Stop;

/// What all points of a model share: everything that does not depend on friction, speed and load.
#[derive(Debug)]
pub enum Structure {
    /// On a rigid disk.
    Reduced(Box<ReducedStructure>),
    /// On an elastic disk.
    Sparse(Box<SparseStructure>),
}

/// What all points of a pin on a rigid disk share.
#[derive(Debug)]
pub struct ReducedStructure {
    space: Space,
    separable: Separable,
    basis: Basis,
    /// Dampers of the holders of the pin.
    holders: Option<Dashpots>,
    has_gaps: bool,
    /// What the points of one equilibrium share, for those used last.
    frictions: Mutex<Vec<(Conditions, Arc<Friction>)>>,
}

/// Number of equilibria that are remembered.
const REMEMBERED: usize = 16;

impl Structure {
    /// What all points of `model` share.
    ///
    /// # Errors
    /// If a holder in x or y has no spring, or if pin and elastic disk have too many unknowns.
    pub fn new(model: &Model) -> Result<Self, StabilityError> {
        if space::holders(model).any(|held| held.tied.component < 2 && held.stiffness_n_m <= 0.0) {
            return Err(StabilityError::Holder);
        }
        Ok(if is_plain(model) {
            Self::Reduced(Box::new(ReducedStructure::new(model)))
        } else {
            Self::Sparse(Box::new(SparseStructure::new(model)?))
        })
    }

    /// The structure whose search by sparse factors, which may take minutes, ends when `stop` asks it to.
    #[must_use]
    pub fn stopped_by(mut self, stop: Stop) -> Self {
        if let Self::Sparse(structure) = &mut self {
            structure.stop = stop;
        }
        self
    }

    /// Checks whether [`Structure::new`] takes as many unknowns as the model has, without making anything.
    ///
    /// # Errors
    /// If there are too many.
    pub fn check_size(model: &Model) -> Result<(), StabilityError> {
        if is_plain(model) { Ok(()) } else { sparse::check_size(model) }
    }

    /// Equilibrium and the leading `modes` modes of steady sliding.
    ///
    /// # Errors
    /// If there is no equilibrium, or if an iteration does not converge.
    pub fn point(&self, model: &Model, drive: &Drive, modes: usize) -> Result<SlidingPoint, StabilityError> {
        self.point_with(model, drive, modes, Accuracy::default())
    }

    /// As [`Structure::point`], with the shapes of the modes.
    ///
    /// # Errors
    /// As [`Structure::point`].
    pub fn point_with_shapes(
        &self,
        model: &Model,
        drive: &Drive,
        modes: usize,
    ) -> Result<SlidingPoint, StabilityError> {
        self.point_with(model, drive, modes, Accuracy { with_shapes: true, ..Accuracy::default() })
    }

    /// As [`Structure::point`], with other limits for the corrections in the full space. On an elastic disk there are none.
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
        match self {
            Self::Reduced(structure) => structure.point_with(model, drive, modes, accuracy),
            Self::Sparse(structure) => structure.point(model, drive, modes),
        }
    }

    /// The modes of a point, what they say, and whether they show that a run decays: sliding is stable at such a distance from the
    /// threshold that no limit cycle was found beside it. The modes are exact only as far as this question needs it. On an elastic
    /// disk they show nothing, because no distance was measured there. `coarser_decayed`: a run of the job on a coarser mesh
    /// decayed, which is what is known beyond the band of the modes if nothing else is.
    ///
    /// # Errors
    /// As [`Structure::point`].
    pub fn decide(
        &self,
        model: &Model,
        drive: &Drive,
        modes: usize,
        coarser_decayed: bool,
    ) -> Result<(SlidingPoint, Decision, bool), StabilityError> {
        match self {
            Self::Reduced(structure) => structure.decide(model, drive, modes, coarser_decayed),
            Self::Sparse(structure) => Ok((structure.point(model, drive, modes)?, Decision::Open, false)),
        }
    }
}

impl ReducedStructure {
    fn new(model: &Model) -> Self {
        let space = Space::new(model);
        let separable = Separable::new(model);
        let basis = Basis::new(model, &space, &separable);
        let has_gaps = model.slaves().iter().any(|slave| slave.initial_gap_m != 0.0);
        Self {
            holders: holder_dampers(model),
            has_gaps,
            space,
            separable,
            basis,
            frictions: Mutex::default(),
        }
    }

    fn point_with(
        &self,
        model: &Model,
        drive: &Drive,
        modes: usize,
        accuracy: Accuracy,
    ) -> Result<SlidingPoint, StabilityError> {
        let friction = self.friction(model, drive)?;
        let slope = friction.slope(&self.space, drive.force_n);
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
            viscous: self.holders.iter().cloned().chain(slope).collect(),
            // β₂ > ½ damps like a stiffness-proportional damping of (β₂ − ½)Δt, to first order.
            steps: Clock::Steps {
                time_step_s: scheme.time_step_s,
                beta2: scheme.beta2,
                beta_r_s: scheme.beta_r_s,
            },
            damping_s: scheme.beta_r_s + (scheme.beta2 - 0.5) * scheme.time_step_s,
            alpha_r_per_s: scheme.alpha_r_per_s,
        };
        let found = point.modes(&mut Elasticity::new(model, &self.space), modes, accuracy);
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
                disk_z_m: vec![0.0; unit.in_contact.len()],
                mu: friction.coefficients.mu,
                mu_share: friction.coefficients.share.clone(),
                mu_star: unit.mu_star(&self.space, &friction.coefficients),
            },
            modes,
            band_hz: self.basis.band_hz,
            has_all_modes: friction.is_complete,
            damped_above_hz: self.damped_above_hz(model, &friction),
            basis: friction.basis_len(),
            is_reduced: !friction.is_complete,
        })
    }

    fn decide(
        &self,
        model: &Model,
        drive: &Drive,
        modes: usize,
        coarser_decayed: bool,
    ) -> Result<(SlidingPoint, Decision, bool), StabilityError> {
        let mu = drive.law.mu();
        let further = further_mu(mu, natural_speed_ratio(model, drive, mu));
        let further = Drive { law: drive.law.with_mu(further), ..*drive };
        let resolve = |drive| self.resolve(model, drive, modes, coarser_decayed);
        let (point, verdict) = resolve(drive)?;
        let is_stable = |resolved: Result<(SlidingPoint, Decision), _>| {
            resolved.is_ok_and(|(_, verdict)| verdict == Decision::Stable)
        };
        let is_safe = verdict == Decision::Stable && is_stable(resolve(&further));
        Ok((point, verdict, is_safe))
    }

    /// A point with as few corrections as its verdict needs.
    fn resolve(
        &self,
        model: &Model,
        drive: &Drive,
        modes: usize,
        coarser_decayed: bool,
    ) -> Result<(SlidingPoint, Decision), StabilityError> {
        let signs = Accuracy { aim: Aim::Signs, rounds: 3, ..Accuracy::default() };
        let point = self.point_with(model, drive, modes, signs)?;
        let verdict = verdict(&point, [model.scheme().alpha_r_per_s, damping_s(model)], coarser_decayed);
        Ok((point, verdict))
    }

    /// The frequency above which no mode grows. It is not looked for where it cannot lie in the band.
    fn damped_above_hz(&self, model: &Model, friction: &Friction) -> Option<f64> {
        let damping_s = damping_s(model);
        let coefficients = &friction.coefficients;
        let largest = coefficients.share.iter().fold(0.0, |largest: f64, share| largest.max(share.abs()));
        let least_hz = bound::least_hz(coefficients.mu * largest, model.pin().material(), damping_s);
        // NaN, of no friction and no damping, gives no frequency either.
        let is_hopeless = least_hz.is_nan() || least_hz > JUDGED * self.basis.band_hz;
        if friction.is_complete || self.holders.is_some() || coefficients.falls() || is_hopeless {
            return None;
        }
        let bilateral = Bilateral {
            space: &self.space,
            separable: &self.separable,
            contact: point::contact(&friction.equilibrium),
        };
        let sector = friction.sector.get_or_init(|| vibration::sector(model, &bilateral, coefficients));
        bound::damped_above_hz((*sector)?, damping_s)
    }

    /// What the points of one equilibrium share. It is computed once for as many of them as are remembered.
    fn friction(&self, model: &Model, drive: &Drive) -> Result<Arc<Friction>, StabilityError> {
        let conditions = Conditions::new(drive, self.has_gaps);
        let known = |all: &[(Conditions, Arc<Friction>)]| {
            all.iter().find(|(known, _)| *known == conditions).map(|(_, friction)| Arc::clone(friction))
        };
        let lock = || self.frictions.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(friction) = known(&lock()) {
            return Ok(friction);
        }
        let friction = SlidingFriction::new(&self.space.speeds_per_rate(), drive)?;
        let equilibrium =
            UnitEquilibrium::new(model, &self.space, &self.separable, &friction, drive.force_n)?;
        let mut elasticity = Elasticity::new(model, &self.space);
        let friction =
            Friction::new(&mut elasticity, &self.space, &self.separable, &self.basis, friction, equilibrium);
        let friction = Arc::new(friction);
        let mut all = lock();
        if all.len() == REMEMBERED {
            all.remove(0);
        }
        all.push((conditions, Arc::clone(&friction)));
        Ok(friction)
    }
}

/// The dampers of holders. Their springs are in K and their masses in M, whose damping they do not have.
fn holder_dampers(model: &Model) -> Option<Dashpots> {
    let Scheme { beta_r_s, alpha_r_per_s, .. } = *model.scheme();
    let all: Vec<Dashpot> = space::holders(model)
        .map(|held| {
            let share = 1.0 / held.tied.nodes.len() as f64;
            Dashpot {
                coefficient_n_s_m: held.damping_n_s_m
                    - beta_r_s * held.stiffness_n_m
                    - alpha_r_per_s * held.mass_kg,
                direction: held.tied.dofs().map(|dof| (dof, share)).collect(),
            }
        })
        .collect();
    (!all.is_empty()).then_some(Dashpots { sampling: Sampling::Beginning, all })
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

/// Whether the pin is an upright block of one material on a rigid disk.
fn is_plain(model: &Model) -> bool {
    let rocks = model.supports().iter().any(|support| matches!(support, Support::Rocking(_)));
    model.ring().is_none() && model.mesh().block().is_some() && !rocks
}

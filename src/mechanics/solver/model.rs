//! The immutable part of a run, shared by all lanes: the pin, its supports and load, and its target.

use super::body::pin::{History, PinBody, PinMesh, Stiffness};
use super::body::ring::{RingBody, RingDefinition, UnsteppedRing};
use super::error::SolverError;
use super::field::Field;
use super::interface::target::{SurfaceMotion, Target, TargetDefinition, UnsteppedTarget, rotating_disk};
use super::interface::{Interface, Layer, Relief, SlaveNode};
use super::material::Material;
use super::scheme::{Bound, Scheme, TimeStep};
use super::support::load::LoadShare;
use super::support::{self, Support};

/// The parts from which a model is made.
#[derive(Debug, Clone)]
pub struct ModelDefinition {
    /// The mesh of the pin.
    pub mesh: PinMesh,
    /// The materials of the pin. Elements have their numbers, and a block consists of the first one.
    pub materials: Vec<Material>,
    /// The stiffness of the pin: elastic, or springs.
    pub stiffness: Stiffness,
    /// The supports of the pin.
    pub supports: Vec<Support>,
    /// Nodal forces per unit of the total load (dimensionless).
    pub load: Vec<LoadShare>,
    /// The target, on which the pin slides.
    pub target: TargetDefinition,
    /// β₂ of the scheme.
    pub beta2: f64,
    /// Stiffness-proportional damping `β_R` \[s\].
    pub beta_r_s: f64,
    /// Mass-proportional damping `α_R` \[1/s\] of the pin.
    pub alpha_r_per_s: f64,
    /// The time step.
    pub time_step: TimeStep,
}

/// The immutable part of a run.
#[derive(Debug, Clone)]
pub struct Model {
    pin: PinBody,
    supports: Vec<Support>,
    load: Vec<LoadShare>,
    interface: Interface,
    target: Target,
    scheme: Scheme,
    time_step_limit_s: f64,
    clamp_width_m: f64,
}

impl Model {
    /// Builds a model from its parts.
    ///
    /// # Errors
    /// If the supports are inconsistent, the springs do not fit the mesh, or the time step is above the limit. On
    /// an elastic disk also if a node of the contact face is fixed or tied, or if β₂ is not ½: only the contact
    /// solve on a rigid target supports these.
    ///
    /// # Panics
    /// If a rigid target does not have one surface velocity per node of the contact face.
    pub fn new(definition: ModelDefinition) -> Result<Self, SolverError> {
        let ModelDefinition {
            mesh,
            materials,
            stiffness,
            supports,
            load,
            target,
            beta2,
            beta_r_s,
            alpha_r_per_s,
            time_step,
        } = definition;
        let (target, surface_motion) = unstepped(target, &mesh, &supports, beta2)?;
        let freedoms = support::freedoms(&supports, &mesh)?;
        let supported = supports.iter().flat_map(Support::dofs);
        let acted_on = supported.chain(load.iter().map(|share| share.dof));
        let pin = PinBody::new(mesh, materials, stiffness, freedoms, acted_on)?;
        let interface = Interface::new(&pin, &surface_motion);

        let bound = bound_of(&pin, &supports, pin.omega_max_rad_s(), alpha_r_per_s);
        let pin_limit = bound.time_step_limit_s(beta2, beta_r_s);
        let (target_limit, target_omega_max) =
            target.longest_step_s(beta_r_s).unwrap_or((f64::INFINITY, 0.0));
        let limit = pin_limit.min(target_limit);
        let omega_max = if target_limit < pin_limit { target_omega_max } else { bound.omega_max_rad_s };
        let too_large = |time_step_s| SolverError::TimeStepTooLarge {
            time_step_s,
            limit_s: limit,
            omega_max_rad_s: omega_max,
        };
        let time_step_s = match time_step {
            // The limit of an elastic target already contains a margin.
            TimeStep::FractionOfLimit(fraction) => (fraction * pin_limit).min(target_limit),
            // The limit itself is allowed; the factor covers the rounding of its computation.
            TimeStep::Given(dt) if dt <= limit * (1.0 + 1e-12) => dt,
            TimeStep::Given(dt) => return Err(too_large(dt)),
            TimeStep::Unchecked(dt) => dt,
        };
        let target = target.with_step(time_step_s, beta_r_s).ok_or_else(|| too_large(time_step_s))?;
        Ok(Self {
            pin,
            supports,
            load,
            interface,
            target,
            scheme: Scheme { beta2, beta_r_s, alpha_r_per_s, time_step_s },
            time_step_limit_s: limit,
            clamp_width_m: 0.0,
        })
    }

    pub(super) fn with_clamp_width(self, clamp_width_m: f64) -> Self {
        Self { clamp_width_m, ..self }
    }

    /// The same model with other initial gaps \[m\]. A negative gap presses a node of a held pin on the target.
    #[must_use]
    pub fn with_initial_gaps(self, gap_m: impl Fn(&SlaveNode) -> f64) -> Self {
        Self { interface: self.interface.with_initial_gaps(gap_m), ..self }
    }

    /// The same model with a layer between the pin and a rigid target.
    #[must_use]
    pub fn with_layer(self, layer: Layer) -> Self {
        Self { interface: self.interface.with_layer(layer), ..self }
    }

    /// The same model on a rigid target with these heights.
    #[must_use]
    pub fn with_relief(self, relief: Relief) -> Self {
        Self { interface: self.interface.with_relief(relief), ..self }
    }

    /// The pin.
    pub fn pin(&self) -> &PinBody {
        &self.pin
    }

    /// The mesh of the pin.
    pub fn mesh(&self) -> &PinMesh {
        self.pin.mesh()
    }

    /// The supports of the pin.
    pub fn supports(&self) -> &[Support] {
        &self.supports
    }

    /// Nodal forces per unit of the total load (dimensionless).
    pub fn load(&self) -> &[LoadShare] {
        &self.load
    }

    /// The contact face of the pin: its slave nodes.
    pub fn interface(&self) -> &Interface {
        &self.interface
    }

    /// The nodes of the contact face.
    pub fn slaves(&self) -> &[SlaveNode] {
        self.interface.slaves()
    }

    /// The target, on which the pin slides.
    pub fn target(&self) -> &Target {
        &self.target
    }

    /// The elastic disk, if the pin slides on one.
    pub fn ring(&self) -> Option<&RingBody> {
        self.target.ring()
    }

    /// The parameters of the time integration.
    pub fn scheme(&self) -> &Scheme {
        &self.scheme
    }

    /// The time step \[s\].
    pub fn time_step_s(&self) -> f64 {
        self.scheme.time_step_s
    }

    /// The stability limit \[s\] of the time step.
    pub fn time_step_limit_s(&self) -> f64 {
        self.time_step_limit_s
    }

    /// The stability limit \[s\] of the pin with these displacements, at most 2.5 % too high and never too low; returns `None` if the
    /// displacements do not change it.
    pub fn deformed_limit_s(&self, u: &Field<1>, history: &History<1, f64>) -> Option<f64> {
        let omega_max_rad_s = self.pin.deformed_omega_max_rad_s(u, history)?;
        let Scheme { beta2, beta_r_s, alpha_r_per_s, .. } = self.scheme;
        let bound = bound_of(&self.pin, &self.supports, omega_max_rad_s, alpha_r_per_s);
        Some(bound.time_step_limit_s(beta2, beta_r_s))
    }

    /// Width \[m\] of the scene's clamp on the mesh; 0 for a model that was not built from a scene.
    pub fn clamp_width_m(&self) -> f64 {
        self.clamp_width_m
    }
}

/// The bound of a pin with its supports.
fn bound_of(pin: &PinBody, supports: &[Support], omega_max_rad_s: f64, alpha_r_per_s: f64) -> Bound {
    let of_pin = Bound { omega_max_rad_s, damping_per_s: alpha_r_per_s };
    supports.iter().fold(of_pin, |bound, support| bound.and(support.bound(pin.masses_kg())))
}

/// The target before the time step is known, and the velocity of its surface under the slave nodes.
fn unstepped(
    target: TargetDefinition,
    mesh: &PinMesh,
    supports: &[Support],
    beta2: f64,
) -> Result<(UnsteppedTarget, SurfaceMotion), SolverError> {
    let ring: RingDefinition = match target {
        TargetDefinition::Rigid(motion) => return Ok((UnsteppedTarget::Rigid, motion)),
        TargetDefinition::Ring(ring) => ring,
    };
    let is_on_face = |dof: usize| mesh.bottom_nodes().contains(&(dof / 3));
    if supports.iter().flat_map(Support::dofs).any(is_on_face) {
        return Err(SolverError::Constraints(
            "on an elastic disk no node of the contact face may be held or tied".to_owned(),
        ));
    }
    if beta2 != 0.5 {
        return Err(SolverError::Constraints("an elastic disk is for β₂ = ½ only".to_owned()));
    }
    let motion = rotating_disk(mesh, ring.track_radius_m);
    Ok((UnsteppedTarget::Ring(Box::new(UnsteppedRing::new(ring))), motion))
}

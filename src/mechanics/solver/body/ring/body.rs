//! The immutable part of an elastic disk.

use super::bound;
use super::mesh::RingMesh;
use super::operator::{Elements, RingOperator};
use super::response::Response;
use super::stages::{MAX_STAGES, Stages};
use crate::solver::material::Material;
use crate::spec::{DiskTimeStep, Element, Scene, TargetSurface};

/// The definition of an elastic disk.
#[derive(Debug, Clone)]
pub struct RingDefinition {
    /// The mesh.
    pub mesh: RingMesh,
    /// The material.
    pub material: Material,
    /// The element.
    pub element: Element,
    /// Nodes that do not move in the rotating frame.
    pub held: Vec<usize>,
    /// How the top face is interpolated.
    pub target: TargetSurface,
    /// Whether the disk may make several stages in a time step.
    pub clock: DiskTimeStep,
    /// Distance \[m\] of the pin's axis from the axis of rotation.
    pub track_radius_m: f64,
}

impl RingDefinition {
    /// The disk of a scene. The nodes at the inner radius are fixed in the rotating frame.
    pub fn of_scene(scene: &Scene) -> Self {
        let ring = &scene.disk.ring;
        let mesh = RingMesh::under_track(ring, &scene.pin, scene.disk.track_radius_m);
        let held = (0..mesh.node_count()).filter(|&node| mesh.grid_position(node)[1] == 0).collect();
        let material = Material {
            young_modulus_pa: ring.young_modulus_pa,
            poisson_ratio: ring.poisson_ratio,
            density_kg_m3: ring.density_kg_m3,
        };
        let track_radius_m = scene.disk.track_radius_m;
        Self {
            element: ring.element,
            mesh,
            material,
            held,
            target: ring.target,
            clock: ring.clock,
            track_radius_m,
        }
    }
}

/// A ring that has no time step yet.
#[derive(Debug, Clone)]
pub(in crate::solver) struct UnsteppedRing {
    definition: RingDefinition,
    operator: RingOperator,
    masses_kg: Vec<f64>,
    omega_max_squared: f64,
    most_stages: usize,
}

/// The immutable part of an elastic disk.
#[derive(Debug, Clone)]
pub struct RingBody {
    definition: RingDefinition,
    operator: RingOperator,
    masses_kg: Vec<f64>,
    /// 1/m \[1/kg\] of every node, 0 where it is held.
    inverse_mass: Vec<f64>,
    stages: Stages,
    response: Response,
}

impl UnsteppedRing {
    pub fn new(definition: RingDefinition) -> Self {
        let elements = Elements::new(&definition.mesh, &definition.material, definition.element);
        let (operator, masses_kg) = RingOperator::new(&definition.mesh, &elements);
        let most_stages = match definition.clock {
            DiskTimeStep::Own => MAX_STAGES,
            DiskTimeStep::Common => 1,
        };
        let omega_max_squared = bound::omega_max_squared(&definition.mesh, &elements);
        Self { definition, operator, masses_kg, omega_max_squared, most_stages }
    }

    /// Upper bound of the largest angular frequency \[rad/s\].
    pub fn omega_max(&self) -> f64 {
        self.omega_max_squared.sqrt()
    }

    /// The longest step \[s\] for which the stages are stable.
    pub fn longest_step_s(&self, beta_r_s: f64) -> f64 {
        Stages::longest_step_s(self.omega_max_squared, self.most_stages, beta_r_s)
    }

    /// The disk with the fewest stages that are stable; `None` if the step is too long.
    pub fn with_step(self, time_step_s: f64, beta_r_s: f64) -> Option<RingBody> {
        let stages = Stages::fewest(self.omega_max_squared, self.most_stages, time_step_s, beta_r_s)?;
        let mut inverse_mass: Vec<f64> = self.masses_kg.iter().map(|mass| 1.0 / mass).collect();
        for &node in &self.definition.held {
            inverse_mass[node] = 0.0;
        }
        let mesh = &self.definition.mesh;
        let response = Response::new(mesh, &self.operator, &inverse_mass, &stages, time_step_s);
        Some(RingBody {
            operator: self.operator,
            masses_kg: self.masses_kg,
            inverse_mass,
            stages,
            response,
            definition: self.definition,
        })
    }
}

impl RingBody {
    /// The mesh.
    pub fn mesh(&self) -> &RingMesh {
        &self.definition.mesh
    }

    /// How the top face is interpolated.
    pub fn target(&self) -> TargetSurface {
        self.definition.target
    }

    /// The stiffness operator.
    pub fn operator(&self) -> &RingOperator {
        &self.operator
    }

    /// Lumped nodal masses \[kg\].
    pub fn masses_kg(&self) -> &[f64] {
        &self.masses_kg
    }

    /// 1/m \[1/kg\] of every node, 0 where it is held.
    pub fn inverse_mass(&self) -> &[f64] {
        &self.inverse_mass
    }

    /// The stages of a step.
    pub fn stages(&self) -> &Stages {
        &self.stages
    }

    pub(in crate::solver) fn response(&self) -> &Response {
        &self.response
    }
}

//! Builds the model of a scene.

use super::body::block::{BlockMesh, Stiffness};
use super::body::ring::RingDefinition;
use super::error::SolverError;
use super::interface::target::{TargetDefinition, rotating_disk};
use super::material::Material;
use super::model::{Model, ModelDefinition};
use super::scheme::TimeStep;
use super::support::{clamp, load};
use crate::spec::{DiskKind, Numerics, Scene};

impl Model {
    /// Builds the model of a scene.
    ///
    /// # Errors
    /// If the mesh has no node row near the clamp's width, or the time step is above the limit.
    pub fn from_scene(scene: &Scene, numerics: &Numerics) -> Result<Self, SolverError> {
        let mesh = BlockMesh::new(scene.pin.size_m, scene.pin.elements);
        let strip = clamp::clamped_strip(&mesh, &scene.clamp)?;
        let definition = ModelDefinition {
            material: Material::of_pin(&scene.pin),
            stiffness: Stiffness::Elastic,
            supports: clamp::supports(&mesh, &strip, scene.top),
            load: load::normal_load(&mesh),
            target: match scene.disk.kind {
                DiskKind::Rigid => TargetDefinition::Rigid(rotating_disk(&mesh, scene.disk.track_radius_m)),
                DiskKind::Elastic => TargetDefinition::Ring(RingDefinition::of_scene(scene)),
            },
            beta2: numerics.beta2,
            beta_r_s: numerics.beta_r_s,
            time_step: numerics
                .time_step_s
                .map_or(TimeStep::FractionOfLimit(numerics.safety_factor), TimeStep::Given),
            mesh,
        };
        Ok(Self::new(definition)?.with_clamp_width(strip.width_m))
    }

    /// Checks whether the mesh of the scene's pin has a node row near the clamp's width, without building the model.
    ///
    /// # Errors
    /// If it has none.
    pub fn check_clamp(scene: &Scene) -> Result<(), SolverError> {
        let mesh = BlockMesh::new(scene.pin.size_m, scene.pin.elements);
        clamp::clamped_strip(&mesh, &scene.clamp).map(drop)
    }
}

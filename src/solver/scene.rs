//! Builds the model of a scene.

use super::body::block::{BlockMesh, Stiffness};
use super::body::ring::RingDefinition;
use super::error::SolverError;
use super::interface::initial_gap_m;
use super::interface::target::{TargetDefinition, rotating_disk};
use super::material::Material;
use super::model::{Model, ModelDefinition};
use super::scheme::TimeStep;
use super::support::{clamp, load};
use crate::spec::{DiskKind, Numerics, Precision, Scene};
use std::ops::RangeInclusive;

/// Numbers with which a step in single precision multiplies. Its range is 10⁻³⁸ to 3·10³⁸.
const SINGLE_RANGE: RangeInclusive<f64> = 1.0e-28..=1.0e28;

impl Model {
    /// Builds the model of a scene.
    ///
    /// # Errors
    /// If the mesh has no node row near the clamp's width, the time step is above the limit, or the numbers of a step do not
    /// fit into the precision.
    pub fn from_scene(scene: &Scene, numerics: &Numerics) -> Result<Self, SolverError> {
        let mesh = BlockMesh::new(scene.pin.size_m, scene.pin.elements);
        let strip = clamp::clamped_strip(&mesh, &scene.clamp)?;
        let definition = ModelDefinition {
            material: Material::of_pin(&scene.pin),
            stiffness: Stiffness::Elastic,
            supports: clamp::supports(&mesh, &strip, scene.top, &scene.holder),
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
        let model = Self::new(definition)?.with_clamp_width(strip.width_m);
        if numerics.precision == Precision::Single {
            model.check_single_precision()?;
        }
        if scene.pin.base.is_flat() {
            return Ok(model);
        }
        let positions_m: Vec<_> = model.slaves().iter().map(|slave| slave.position_m).collect();
        let gap_m = initial_gap_m(&scene.pin, &positions_m);
        Ok(model.with_initial_gaps(|slave| gap_m(slave.position_m)))
    }

    /// Checks the numbers that a step multiplies with. Between them and the ends of the range, products keep their digits.
    fn check_single_precision(&self) -> Result<(), SolverError> {
        let dt = self.time_step_s();
        let masses = self.pin().masses_kg().iter().copied();
        let [lightest_kg, heaviest_kg] =
            [masses.clone().fold(f64::INFINITY, f64::min), masses.fold(0.0, f64::max)];
        let numbers = [
            ("the time step squared [s²]", dt * dt),
            ("the lightest node [kg]", lightest_kg),
            ("the heaviest node [kg]", heaviest_kg),
            ("the lightest node over the time step squared [N/m]", lightest_kg / (dt * dt)),
            ("the heaviest node over the time step squared [N/m]", heaviest_kg / (dt * dt)),
        ];
        match numbers.into_iter().find(|(_, value)| !SINGLE_RANGE.contains(value)) {
            None => Ok(()),
            Some((what, value)) => Err(SolverError::BeyondSinglePrecision { what, value }),
        }
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

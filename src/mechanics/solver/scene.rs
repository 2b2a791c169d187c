//! Builds the model of a scene.

use super::body::pin::{BlockMesh, GeneralMesh, Hexahedron, MeshParts, PinMesh, Stiffness, Tilt, cylinder};
use super::body::ring::RingDefinition;
use super::error::SolverError;
use super::interface::target::{TargetDefinition, rotating_disk};
use super::interface::{BaseHeights, Layer, Relief};
use super::material::Material;
use super::model::{Model, ModelDefinition};
use super::scheme::TimeStep;
use super::support::{clamp, load};
use crate::spec::{DiskKind, Numerics, Pin, Precision, Scene, Shape, Strains};
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
        let mesh = pin_mesh(&scene.pin)?;
        let strip = clamp::clamped_strip(&mesh, &scene.clamp)?;
        let regions = scene.pin.regions.iter().map(Material::of_region);
        let definition = ModelDefinition {
            materials: std::iter::once(Material::of_pin(&scene.pin)).chain(regions).collect(),
            stiffness: match scene.pin.strains {
                Strains::Small => Stiffness::Elastic,
                Strains::Finite => Stiffness::Hyperelastic {
                    law: scene.pin.material,
                    plasticity: scene.pin.plasticity_of_materials(),
                },
            },
            supports: clamp::supports(&mesh, &strip, scene.top, &scene.holder),
            load: load::normal_load(&mesh),
            target: match scene.disk.kind {
                DiskKind::Rigid => TargetDefinition::Rigid(rotating_disk(&mesh, scene.disk.track_radius_m)),
                DiskKind::Elastic => TargetDefinition::Ring(RingDefinition::of_scene(scene)),
            },
            beta2: numerics.beta2,
            beta_r_s: numerics.beta_r_s,
            alpha_r_per_s: numerics.alpha_r_per_s.unwrap_or(0.0),
            time_step: numerics
                .time_step_s
                .map_or(TimeStep::FractionOfLimit(numerics.safety_factor), TimeStep::Given),
            mesh,
        };
        let model = Self::new(definition)?.with_clamp_width(strip.width_m);
        if numerics.precision == Precision::Single {
            model.check_single_precision()?;
        }
        let model = model.with_base(&scene.pin);
        let model = match scene.contact.layer() {
            None => model,
            Some([stiffness_pa_m, exponent, pressure_pa]) => {
                model.with_layer(Layer { stiffness_pa_m, exponent, pressure_pa })
            }
        };
        if scene.disk.is_plane() {
            return Ok(model);
        }
        let relief = Relief::of_disk(&scene.disk.waves(), scene.disk.track_radius_m, model.slaves());
        Ok(model.with_relief(relief))
    }

    /// The same model with the initial gaps of the pin's base and tilt.
    fn with_base(self, pin: &Pin) -> Self {
        let tilt = tilt(pin);
        if pin.has_plane_base() {
            return self;
        }
        let mesh = self.mesh().clone();
        let base = BaseHeights::new(pin);
        let height_m = |node: usize| {
            let [x, y, z] = mesh.own_coordinates_m(node);
            let [_, _, z] = tilt.turned([x, y, z + base.height_m([x, y])]);
            z
        };
        let lowest_m = mesh.bottom_nodes().map(height_m).fold(f64::INFINITY, f64::min);
        self.with_initial_gaps(|slave| height_m(slave.node) - lowest_m)
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

    /// The mesh of the scene's pin.
    ///
    /// # Errors
    /// If it cannot be used.
    pub fn mesh_of(scene: &Scene) -> Result<PinMesh, SolverError> {
        pin_mesh(&scene.pin)
    }

    /// Width \[m\] of the clamp on the mesh of the scene's pin, without building the model.
    ///
    /// # Errors
    /// If the mesh has no row of nodes near the clamp's width.
    pub fn clamp_width_on_mesh_m(scene: &Scene) -> Result<f64, SolverError> {
        clamp::clamped_strip(&pin_mesh(&scene.pin)?, &scene.clamp).map(|strip| strip.width_m)
    }
}

/// The mesh of a pin. An upright block of one material is a [`PinMesh::Block`].
fn pin_mesh(pin: &Pin) -> Result<PinMesh, SolverError> {
    let tilt = tilt(pin);
    let [across, _, along] = pin.elements;
    let mut parts = match pin.shape {
        Shape::Block => {
            let block = BlockMesh::new(pin.extent_m(), pin.elements);
            if pin.is_plain_block() {
                return Ok(block.into());
            }
            MeshParts::of_block(&block)
        }
        Shape::Cylinder => cylinder(pin.extent_m(), across, along),
        Shape::Mesh => from_file(pin)?,
    };
    parts.element = pin.element;
    Ok(GeneralMesh::new(&with_regions(parts, pin), tilt)?.into())
}

/// Numbers the materials of the elements: 0 is that of the pin, region i has i + 1. Of several regions the last one holds.
fn with_regions(mut parts: MeshParts, pin: &Pin) -> MeshParts {
    for element in &mut parts.elements {
        let centre_m = element.nodes.iter().map(|&node| parts.coordinates_m[node][2]).sum::<f64>() / 8.0;
        let region =
            pin.regions.iter().rposition(|region| region.above_m.is_some_and(|above_m| centre_m > above_m));
        element.material = region.map_or(element.material, |region| region + 1);
    }
    parts
}

/// The mesh of a file.
fn from_file(pin: &Pin) -> Result<MeshParts, SolverError> {
    let file = pin.mesh.as_ref();
    let (Some(file), Some(content)) = (file, file.and_then(|file| file.decoded())) else {
        return Err(SolverError::Mesh("scene.pin.mesh.content is not a mesh".to_owned()));
    };
    let material = |body: u32| {
        let body = file.bodies.get(body as usize);
        let region =
            pin.regions.iter().rposition(|region| region.group.is_some() && region.group.as_ref() == body);
        region.map_or(0, |region| region + 1)
    };
    let face = |corners: &[u32; 4]| corners.map(|node| node as usize);
    let elements = content.hexahedra.iter().zip(&content.body_of);
    Ok(MeshParts {
        elements: elements
            .map(|(nodes, &body)| Hexahedron {
                nodes: nodes.map(|node| node as usize),
                material: material(body),
            })
            .collect(),
        names: content.ids.iter().map(|&id| u64::from(id)).collect(),
        contact: content.contact.iter().map(face).collect(),
        top: content.load.iter().map(face).collect(),
        clamped: Some(content.clamp.iter().map(|&node| node as usize).collect()),
        coordinates_m: content.nodes_m,
        ..MeshParts::default()
    })
}

fn tilt(pin: &Pin) -> Tilt {
    Tilt {
        x_rad: pin.tilt_x_deg.unwrap_or(0.0).to_radians(),
        y_rad: pin.tilt_y_deg.unwrap_or(0.0).to_radians(),
    }
}

//! A block on an elastic block; a tool for the other files.
//!
//! The lower block is a sector of a ring. The radius is so large that the block is straight to 10⁻⁷ of its
//! width.

use std::f64::consts::TAU;
use tribosweep_mechanics::solver::body::pin::BlockMesh;
use tribosweep_mechanics::solver::body::ring::{RingDefinition, RingMesh};
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::interface::target::TargetDefinition;
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::solver::{Drive, Model, ModelDefinition, State};
use tribosweep_mechanics::spec::{DiskTimeStep, Element, TargetSurface};

/// Radius of the ring over the block's width.
const STRAIGHT: f64 = 1.0e7;

/// The lower block, with `elements` in x, y and z. Its size in x and y is that of the pin.
pub struct Below {
    pub material: Material,
    pub thickness_m: f64,
    pub elements: [usize; 3],
    pub target: TargetSurface,
    pub clock: DiskTimeStep,
    /// Whether its bottom is held.
    pub held: bool,
}

/// The model of the upper block `base` on the lower one. The drive is that of a straight plane.
pub fn on_block(base: ModelDefinition, below: &Below) -> Model {
    let [lx, ly, _] = base.mesh.size_m();
    let radius = STRAIGHT * lx.max(ly);
    let [nx, ny, nz] = below.elements;
    let radii = [radius - lx / 2.0, radius + lx / 2.0];
    let mesh = RingMesh::uniform(ly / radius, radii, below.thickness_m, [ny, nx, nz]);
    let held = if below.held {
        (0..mesh.node_count()).filter(|&node| mesh.grid_position(node)[2] == nz).collect()
    } else {
        Vec::new()
    };
    let disk = RingDefinition {
        element: Element::Full,
        mesh,
        material: below.material,
        held,
        target: below.target,
        clock: below.clock,
        track_radius_m: radius,
    };
    Model::new(ModelDefinition { target: TargetDefinition::Ring(disk), ..base }).unwrap()
}

/// Σ m v of both bodies in z [kg m/s], with the velocities half a step before t_n.
pub fn momentum(model: &Model, state: &State<1>) -> [f64; 2] {
    let body = model.ring().expect("an elastic disk");
    let disk = state.target.ring().expect("an elastic disk").1.momentum_velocity();
    let pin = model.pin().masses_kg().iter().enumerate().map(|(node, mass)| mass * state.p[3 * node + 2]);
    let below = body.masses_kg().iter().enumerate().map(|(node, mass)| mass * disk[3 * node + 2]);
    [pin.sum(), below.sum()]
}

/// A pin of 6 × 8 × 5 elements on a ring with elements of 6 mm under the track, for runs that must be quick.
pub fn coarse_scene() -> tribosweep_mechanics::spec::JobSpec {
    let mut spec = tribosweep_mechanics::spec::JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.scene.disk.kind = tribosweep_mechanics::spec::DiskKind::Elastic;
    spec.scene.disk.ring.element_size_m = 0.006;
    spec.scene.disk.ring.coarse_element_size_m = 0.03;
    spec
}

/// A block without supports. Only the contact acts on it.
pub fn free_block(size_m: [f64; 3], elements: [usize; 3], material: Material) -> ModelDefinition {
    crate::verification::common::definition(BlockMesh::new(size_m, elements), material, Vec::new())
}

/// The drive of a job with this μ and this speed of the disk.
pub fn drive(mu: f64, omega_rpm: f64) -> Drive {
    Drive { law: Law::coulomb(mu), rate: omega_rpm * TAU / 60.0, force_n: 30.0, ramp_s: 5.0e-4 }
}

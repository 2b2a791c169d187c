//! A block on an elastic block; a tool of the topics.
//!
//! The lower block is a sector of a ring of so large a radius that it is straight but for 10⁻⁷ of its width.

use std::f64::consts::TAU;
use tribosweep::solver::body::block::BlockMesh;
use tribosweep::solver::body::ring::{RingDefinition, RingMesh};
use tribosweep::solver::interface::law::Law;
use tribosweep::solver::interface::target::TargetDefinition;
use tribosweep::solver::material::Material;
use tribosweep::solver::{Drive, Model, ModelDefinition, State};
use tribosweep::spec::{DiskTimeStep, TargetSurface};

/// Radius of the ring over the block's width.
const STRAIGHT: f64 = 1.0e7;

/// A block of `elements` (x, y, z) of this material under a pin of `size_m` in x and y, `thickness_m` thick.
pub struct Below {
    pub material: Material,
    pub thickness_m: f64,
    pub elements: [usize; 3],
    pub target: TargetSurface,
    pub clock: DiskTimeStep,
    /// Whether its bottom is held.
    pub held: bool,
}

/// The upper block of `base` on it; the drive is a straight plane's.
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

/// A pin on a coarse ring of its own size class, for runs that have to be quick: pin 6 × 8 × 5, elements of 8 mm.
pub fn coarse_scene() -> tribosweep::spec::JobSpec {
    let mut spec = tribosweep::spec::JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.scene.disk.kind = tribosweep::spec::DiskKind::Elastic;
    spec.scene.disk.ring.element_size_m = 0.006;
    spec.scene.disk.ring.coarse_element_size_m = 0.03;
    spec
}

/// A block that is free but for its contact.
pub fn free_block(size_m: [f64; 3], elements: [usize; 3], material: Material) -> ModelDefinition {
    crate::common::definition(BlockMesh::new(size_m, elements), material, Vec::new())
}

/// ω of a job's disk and the rest of what drives it.
pub fn drive(mu: f64, omega_rpm: f64) -> Drive {
    Drive { law: Law::Coulomb { mu }, rate: omega_rpm * TAU / 60.0, force_n: 30.0, ramp_s: 5.0e-4 }
}

//! An elastic bar on dry friction as a chain of contact nodes along y, for the bar's statics and dynamics.
//!
//! ```text
//!        | | | | | | |      each node pressed by a compressed spring from a fixed node above
//! F(t) ->o-o-o-o-o-o-o      springs EA/h, masses ρAh (half at the ends), friction capacity qh (half)
//! -------------------- plane at rest ------------------------------------------------> y
//! ```
//!
//! The pressure comes from springs, so that the drive's force is free to vary in time. A node carries at most
//! μN = qh. The bar slips over 2F/q under a sudden load and over F/q under a slow one.

use crate::verification::particles::{Particles, Y, Z};
use tribosweep_mechanics::solver::body::pin::BlockMesh;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::{Drive, Model, State, TimeStep};

pub const YOUNG_MODULUS_PA: f64 = 1.0e9;
pub const DENSITY_KG_M3: f64 = 2500.0;
pub const AREA_M2: f64 = 1.0e-4;
pub const MU: f64 = 0.4;
/// Friction capacity q per length [N/m].
pub const CAPACITY_N_M: f64 = 2000.0;

/// A chain and the compression of the springs that press its nodes.
pub struct Chain {
    pub model: Model,
    pub spacing_m: f64,
    nodes: usize,
    compression_m: f64,
}

impl Chain {
    /// `nodes` nodes `spacing_m` apart.
    pub fn new(nodes: usize, spacing_m: f64, beta_r_s: f64, time_step: TimeStep) -> Self {
        // Four corners share an element's mass, so a cross section of 4A gives every line of nodes A.
        let width_m = 2.0 * AREA_M2.sqrt();
        let mesh = BlockMesh::new([width_m, (nodes - 1) as f64 * spacing_m, width_m], [1, nodes - 1, 1]);
        let stiffness_n_m = YOUNG_MODULUS_PA * AREA_M2 / spacing_m;
        let mut chain = Particles::new(mesh.clone(), DENSITY_KG_M3);
        for j in 0..nodes {
            let (node, above) = (mesh.node(0, j, 0), mesh.node(0, j, 1));
            let share = if j == 0 || j + 1 == nodes { 0.5 } else { 1.0 };
            chain.release(node, Y).release(node, Z);
            chain.spring(node, above, [0.0, 0.0, 1.0], share * stiffness_n_m);
            if j > 0 {
                chain.spring(mesh.node(0, j - 1, 0), node, [0.0, 1.0, 0.0], stiffness_n_m);
            }
        }
        chain.load(0, Y, 1.0);
        let compression_m = CAPACITY_N_M * spacing_m / MU / stiffness_n_m;
        Self { model: chain.model(beta_r_s, time_step), spacing_m, nodes, compression_m }
    }

    /// The state of a chain that is at rest and pressed.
    pub fn pressed(&self) -> State<1> {
        let mut state = State::at_rest(&self.model);
        for j in 0..self.nodes {
            state.u[3 * self.model.mesh().block().unwrap().node(0, j, 1) + Z] = -self.compression_m;
        }
        state
    }

    /// The drive of a plane at rest and a push [N] on the first node.
    pub fn push(force_n: f64) -> Drive {
        Drive { law: Law::coulomb(MU), rate: 0.0, force_n, ramp_s: 0.0 }
    }

    /// Displacement [m] of a node along the bar.
    pub fn u_m(&self, state: &State<1>, j: usize) -> f64 {
        state.u[3 * self.model.mesh().block().unwrap().node(0, j, 0) + Y]
    }

    /// Strain energy [J] of the bar itself.
    pub fn strain_energy_j(&self, state: &State<1>) -> f64 {
        let stiffness_n_m = YOUNG_MODULUS_PA * AREA_M2 / self.spacing_m;
        let squares = (1..self.nodes).map(|j| (self.u_m(state, j) - self.u_m(state, j - 1)).powi(2));
        0.5 * stiffness_n_m * squares.sum::<f64>()
    }

    /// Largest velocity [m/s] of the bar, half a step before the displacements.
    pub fn fastest_m_s(&self, state: &State<1>) -> f64 {
        let speed = |j| state.p[3 * self.model.mesh().block().unwrap().node(0, j, 0) + Y].abs();
        (0..self.nodes).map(speed).fold(0.0, f64::max)
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes
    }
}

//! B13 The constant-stress contact patch.
//!
//! A block under uniform pressure p on a frictionless rigid plane: σ_zz = −p everywhere, the top goes
//! down by p h/E with free sides or p h/(λ+2G) confined, and every slave node carries p times its
//! tributary area (a quarter at corners, a half at edges). Exact for trilinear elements.
//! Pin, p = 30/180 MPa: 1.6667 µm free, 1.2381 µm confined.

use crate::common::{advance, all_of, definition, pin_material};
use tribosweep::solver::boundary;
use tribosweep::solver::constraints::Constraints;
use tribosweep::solver::mesh::BlockMesh;
use tribosweep::solver::{Drive, Model, ModelDefinition, State, TimeStep};

const SIZE_M: [f64; 3] = [0.012, 0.015, 0.010];
const LOAD_N: f64 = 30.0;
const DRIVE: Drive = Drive { mu: 0.0, rate: 0.0, force_n: LOAD_N, ramp_s: 0.0 };

fn model(confined: bool, beta_r_s: f64) -> Model {
    let mesh = BlockMesh::new(SIZE_M, [4, 5, 3]);
    let fixed = if confined { [all_of(&mesh, 0), all_of(&mesh, 1)].concat() } else { Vec::new() };
    let base = definition(mesh, pin_material(0.3), Constraints { fixed, ties: Vec::new() });
    let load = boundary::normal_load(&base.mesh);
    let time_step = TimeStep::FractionOfLimit(0.7);
    Model::new(ModelDefinition { load, beta_r_s, time_step, ..base }).unwrap()
}

/// Exact static displacement of a node.
fn exact(model: &Model, node: usize, confined: bool) -> [f64; 3] {
    let material = model.material();
    let pressure = LOAD_N / (SIZE_M[0] * SIZE_M[1]);
    let [x, y, z] = model.mesh().coordinates_m(node);
    if confined {
        let modulus = material.lame_lambda_pa() + 2.0 * material.shear_modulus_pa();
        [0.0, 0.0, -pressure / modulus * z]
    } else {
        let strain = pressure / material.young_modulus_pa;
        [material.poisson_ratio * strain * x, material.poisson_ratio * strain * y, -strain * z]
    }
}

fn largest_error(model: &Model, state: &State<1>, confined: bool) -> f64 {
    let mut worst: f64 = 0.0;
    for node in 0..model.mesh().node_count() {
        for (c, u) in exact(model, node, confined).into_iter().enumerate() {
            worst = worst.max((state.u[3 * node + c] - u).abs());
        }
    }
    worst / exact(model, model.mesh().node_count() - 1, confined)[2].abs()
}

fn assert_nodal_forces(model: &Model, state: &State<1>, tolerance: f64) {
    let pressure = LOAD_N / (SIZE_M[0] * SIZE_M[1]);
    for (slave, force) in model.slaves().iter().zip(&state.contacts.force_n) {
        let error = force[2][0] / (pressure * slave.area_m2) - 1.0;
        assert!(error.abs() < tolerance, "node {}: force off by {error:e}", slave.node);
    }
}

/// Protects: the exact static field is an equilibrium of step and contact together.
#[test]
fn uniform_pressure_stays_uniform() {
    for confined in [false, true] {
        let model = model(confined, 0.0);
        let mut state = State::at_rest(&model);
        for node in 0..model.mesh().node_count() {
            for (c, value) in exact(&model, node, confined).into_iter().enumerate() {
                state.u[3 * node + c] = value;
            }
        }
        for n in 1..=200 {
            advance(&model, &DRIVE, &mut state, 1);
            // Rounding of K u (stiffness over net force is about 10³ here) enters once a step.
            let tolerance = 1e-12 * f64::from(n);
            assert_nodal_forces(&model, &state, tolerance);
            assert!(largest_error(&model, &state, confined) < tolerance);
        }
    }
}

/// Protects: the equilibrium is also found from rest: a strongly damped block settles into it.
#[test]
fn a_damped_block_settles_into_the_patch() {
    let shortening_um = [(false, 1.666_666_7), (true, 1.238_095_2)];
    for (confined, published_um) in shortening_um {
        // A quarter of critical at 16 kHz: the slowest mode decays by e^-40 in 2 ms.
        let model = model(confined, 5.0e-6);
        let mut state = State::at_rest(&model);
        let steps = (4.0e-3 / model.time_step_s()).ceil() as usize;
        advance(&model, &DRIVE, &mut state, steps);
        assert!(largest_error(&model, &state, confined) < 1e-9);
        assert_nodal_forces(&model, &state, 1e-9);
        let top = model.mesh().top_nodes().start;
        assert!((state.u[3 * top + 2] * 1e6 + published_um).abs() < 1e-6, "published shortening");
    }
}

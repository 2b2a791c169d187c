//! B13 The constant-stress contact patch.
//!
//! Problem: a block under uniform pressure p on a frictionless rigid plane. σ_zz = −p everywhere. The top
//! moves down by p h/E with free sides, or by p h/(λ+2G) if confined. Every slave node carries p times its
//! tributary area: a quarter of an element's face at corners, a half at edges. This is exact for trilinear
//! elements. Source: uniform stress (Hooke); the contact patch test of R. L. Taylor, P. Papadopoulos, *On a
//! patch test for contact problems in two dimensions* (1991). For the pin with p = 30/180 MPa the top moves
//! by 1.6667 µm free, 1.2381 µm confined.
//!
//! Two stacked blocks, the other half of the contact patch test, are in `on_elastic_disk`.
//!
//! Rounding: a step rounds a nodal force by ROUNDINGS_PER_FORCE·ε·Σ|K||u|. The error stays in the
//! displacements and causes forces of (ω_maxΔt)² ≤ 2 times its size (at 0.7 of the limit) at every later
//! step, so a force is off by 2n of it after n steps. Displacements along the plane are free to drift, by
//! n²/2 Δt²/m times the error.

use crate::verification::common::{
    ROUNDINGS_PER_FORCE, advance, all_of, definition, pin_material, stiffness_rows,
};
use crate::verification::evidence::Evidence;
use tribosweep_mechanics::solver::body::pin::BlockMesh;
use tribosweep_mechanics::solver::field::Field;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::support::Support;
use tribosweep_mechanics::solver::support::load;
use tribosweep_mechanics::solver::{Drive, Model, ModelDefinition, State, TimeStep};

const SIZE_M: [f64; 3] = [0.012, 0.015, 0.010];
const LOAD_N: f64 = 30.0;
const PRESSURE_PA: f64 = LOAD_N / (SIZE_M[0] * SIZE_M[1]);
const DRIVE: Drive = Drive { law: Law::coulomb(0.0), rate: 0.0, force_n: LOAD_N, ramp_s: 0.0 };
const SOURCE: &str = "uniform stress (Hooke)";

fn model(elements: [usize; 3], confined: bool, beta_r_s: f64) -> Model {
    let mesh = BlockMesh::new(SIZE_M, elements);
    let fixed = if confined { [all_of(&mesh, 0), all_of(&mesh, 1)].concat() } else { Vec::new() };
    let base = definition(mesh, pin_material(0.3), vec![Support::fixed(fixed)]);
    let load = load::normal_load(&base.mesh);
    let time_step = TimeStep::FractionOfLimit(0.7);
    Model::new(ModelDefinition { load, beta_r_s, time_step, ..base }).unwrap()
}

/// Shortening of the block [m].
fn shortening_m(model: &Model, confined: bool) -> f64 {
    let material = model.pin().material();
    let confined_modulus = material.lame_lambda_pa() + 2.0 * material.shear_modulus_pa();
    PRESSURE_PA * SIZE_M[2] / if confined { confined_modulus } else { material.young_modulus_pa }
}

/// Exact static displacement of all degrees of freedom.
fn exact_m(model: &Model, confined: bool) -> Vec<f64> {
    let strain = shortening_m(model, confined) / SIZE_M[2];
    let sideways = if confined { 0.0 } else { model.pin().material().poisson_ratio * strain };
    (0..model.mesh().block().unwrap().node_count())
        .flat_map(|node| {
            let [x, y, z] = model.mesh().block().unwrap().coordinates_m(node);
            [sideways * x, sideways * y, -strain * z]
        })
        .collect()
}

/// Bounds of the errors after `steps`: of nodal contact forces over p·area, of displacements over the shortening.
fn rounding(model: &Model, confined: bool, steps: usize) -> [f64; 2] {
    let u = exact_m(model, confined);
    let rows = stiffness_rows(model);
    let size = |dof: usize| rows[dof].iter().map(|(c, k)| (k * u[*c]).abs()).sum::<f64>();
    let relative = |slave: &tribosweep_mechanics::solver::interface::SlaveNode| {
        size(3 * slave.node + 2) / (PRESSURE_PA * slave.area_m2)
    };
    let force = model.slaves().iter().map(relative).fold(0.0, f64::max);
    let acceleration =
        (0..u.len()).map(|dof| size(dof) / model.pin().masses_kg()[dof / 3]).fold(0.0, f64::max);
    let (n, dt, unit) = (steps as f64, model.time_step_s(), ROUNDINGS_PER_FORCE * f64::EPSILON);
    let drift = n * n / 2.0 * dt * dt * acceleration / shortening_m(model, confined);
    [2.0 * n * unit * force, unit * drift]
}

/// Records the worst nodal forces at corners, edges and inside, the worst displacement and the shortening.
fn record(evidence: &mut [Evidence; 3], name: &str, model: &Model, state: &State<1>, confined: bool) {
    let [force_bound, displacement_bound] = rounding(model, confined, state.step as usize);
    let whole = model.slaves().iter().map(|slave| slave.area_m2).fold(0.0, f64::max);
    let [forces, displacements, shortening] = evidence;
    for (place, share) in [("corner", 0.25), ("edge", 0.5), ("inside", 1.0)] {
        let exact = share * whole * PRESSURE_PA;
        let worst = model
            .slaves()
            .iter()
            .zip(state.contacts.forces(0))
            .filter(|(slave, _)| (slave.area_m2 / whole - share).abs() < 1e-9)
            .map(|(_, force)| force[2])
            .max_by(|a, b| (a - exact).abs().total_cmp(&(b - exact).abs()))
            .expect("nodes of every kind");
        forces.bounded(format!("{name}, {place}"), worst, exact, exact, force_bound);
    }
    let exact = shortening_m(model, confined);
    let worst =
        exact_m(model, confined).iter().zip(state.u.values()).fold(0.0_f64, |w, (e, u)| w.max((u - e).abs()));
    displacements.bounded(name, worst / exact, 0.0, 1.0, displacement_bound);
    let top = model.mesh().block().unwrap().top_nodes().start;
    shortening.bounded(name, -state.u[3 * top + 2] * 1e6, exact * 1e6, exact * 1e6, displacement_bound);
}

fn cases(what: &str) -> [Evidence; 3] {
    [
        "worst nodal contact force [N]",
        "worst nodal displacement error over the shortening",
        "shortening at a top corner [µm]",
    ]
    .map(|quantity| Evidence::new("B13", format!("{what}, {quantity}"), SOURCE))
}

const MESHES: [[usize; 3]; 2] = [[4, 5, 3], [6, 8, 5]];

fn name(elements: [usize; 3], confined: bool) -> String {
    let [nx, ny, nz] = elements;
    format!("{nx} × {ny} × {nz} elements, {}", if confined { "confined" } else { "free sides" })
}

/// Protects: the exact static field is an equilibrium of step and contact together.
#[test]
fn uniform_pressure_stays_uniform() {
    let mut evidence = cases("patch, 200 steps from equilibrium");
    for elements in MESHES {
        for confined in [false, true] {
            let model = model(elements, confined, 0.0);
            let mut state = State::at_rest(&model);
            state.u = Field::from_values(model.mesh().block().unwrap().layout(), &exact_m(&model, confined));
            advance(&model, &DRIVE, &mut state, 200);
            record(&mut evidence, &name(elements, confined), &model, &state, confined);
        }
    }
    for case in evidence {
        case.judge_bounded("rounding, see the topic's head");
    }
}

/// Protects: the equilibrium is also found from rest: a strongly damped block settles into it.
#[test]
fn a_damped_block_settles_into_the_patch() {
    let mut evidence = cases("patch, settled from rest");
    for elements in MESHES {
        for (confined, stated_um) in [(false, 1.666_7), (true, 1.238_1)] {
            // The load excites only modes that are symmetric in x and y. The lowest is longitudinal, near
            // c_0/4h = 15.8 kHz less a tenth for lateral inertia. It decays at β_Rω²/2 = 2·10⁴/s, by e^-80 in
            // 4 ms.
            let model = model(elements, confined, 5.0e-6);
            let mut state = State::at_rest(&model);
            let steps = (4.0e-3 / model.time_step_s()).ceil() as usize;
            advance(&model, &DRIVE, &mut state, steps);
            record(&mut evidence, &name(elements, confined), &model, &state, confined);
            let stated = (shortening_m(&model, confined) * 1e6 - stated_um).abs();
            assert!(stated < 5e-5, "the head comment's shortening is {stated} µm off");
        }
    }
    for case in evidence {
        case.judge_bounded("rounding, see the topic's head");
    }
}

//! B7 A rigid block: stopping distance, and stick on an incline.
//!
//! A block of mass m pressed with F slides at v0 and stops after v0² m/(2μF); on an incline (a
//! tangential pull F tan α) it sticks iff tan α ≤ μ and otherwise accelerates by F(tan α − μ)/m.
//! Source: rigid-body mechanics. The solver's block is elastic: two levels of mass m/2 joined by a
//! shear spring k = GA/h. While all of it slides its centre of mass obeys the rigid law exactly; when
//! the base sticks, the rest is still moving by at most the shear vibration, so the final position
//! differs by no more than a few static deflections μF/k, which vanishes as the stiffness grows.

use crate::common::{COLUMN_AREA_M2, COLUMN_HEIGHT_M, advance, all_of, column_mesh, definition, level_ties};
use tribosweep::solver::boundary::LoadShare;
use tribosweep::solver::constraints::Constraints;
use tribosweep::solver::contact::ContactState;
use tribosweep::solver::field::Field;
use tribosweep::solver::material::Material;
use tribosweep::solver::{Drive, Model, ModelDefinition, State, TimeStep};

const MU: f64 = 0.3;
const LOAD_N: f64 = 1000.0;
const DENSITY: f64 = 2500.0;

fn mass_kg() -> f64 {
    DENSITY * COLUMN_AREA_M2 * COLUMN_HEIGHT_M
}

/// One element, its two levels tied in y and z, pressed with a load and pulled by `pull` times it in y.
fn block(young_modulus_pa: f64, pull: f64, beta_r_s: f64) -> Model {
    let mesh = column_mesh(1);
    let constraints =
        Constraints { fixed: all_of(&mesh, 0), ties: [level_ties(&mesh, 1), level_ties(&mesh, 2)].concat() };
    let load = mesh
        .top_nodes()
        .flat_map(|node| {
            [
                LoadShare { dof: 3 * node + 1, share: pull / 4.0 },
                LoadShare { dof: 3 * node + 2, share: -0.25 },
            ]
        })
        .collect();
    let material = Material { young_modulus_pa, poisson_ratio: 0.0, density_kg_m3: DENSITY };
    let time_step = TimeStep::FractionOfLimit(0.5);
    Model::new(ModelDefinition { load, beta_r_s, time_step, ..definition(mesh, material, constraints) })
        .unwrap()
}

/// In normal equilibrium under the load, moving at `speed` in y.
fn pressed(model: &Model, speed: f64) -> State<1> {
    let mut state = State::at_rest(model);
    let compression = LOAD_N * COLUMN_HEIGHT_M / (model.material().young_modulus_pa * COLUMN_AREA_M2);
    for node in 0..model.mesh().node_count() {
        state.p[3 * node + 1] = speed;
    }
    for node in model.mesh().top_nodes() {
        state.u[3 * node + 2] = -compression;
    }
    state
}

/// Position [m] and velocity [m/s] of the centre of mass in y.
fn centre(model: &Model, state: &State<1>) -> (f64, f64) {
    let mean = |field: &Field<1>| {
        let sum: f64 = (0..model.mesh().node_count()).map(|n| model.masses_kg()[n] * field[3 * n + 1]).sum();
        sum / mass_kg()
    };
    (mean(&state.u), mean(&state.p))
}

const ON_A_TABLE: Drive = Drive { mu: MU, rate: 0.0, force_n: LOAD_N, ramp_s: 0.0 };

/// Protects: sliding friction decelerates by exactly μF/m, and the block stops where a rigid one does.
#[test]
fn stops_where_a_rigid_block_stops() {
    let speed = 0.2;
    let deceleration = MU * LOAD_N / mass_kg();
    let distance = speed * speed / (2.0 * deceleration);
    let mut errors = Vec::new();
    for young_modulus_pa in [1.0e8, 1.0e9, 1.0e10] {
        let shear_stiffness = young_modulus_pa / 2.0 * COLUMN_AREA_M2 / COLUMN_HEIGHT_M;
        // Half of critical for the shear mode, so that the rest state is reached soon after the stop.
        let shear_omega = (4.0 * shear_stiffness / mass_kg()).sqrt();
        let model = block(young_modulus_pa, 0.0, 1.0 / shear_omega);
        let mut state = pressed(&model, speed);
        let stop_s = speed / deceleration;
        let steps = (0.5 * stop_s / model.time_step_s()) as usize;
        advance(&model, &ON_A_TABLE, &mut state, steps);
        let slid_s = (state.step as f64 - 0.5) * model.time_step_s();
        let (_, velocity) = centre(&model, &state);
        assert!(
            (velocity - (speed - deceleration * slid_s)).abs() < 1e-10 * speed,
            "while it slides, friction is exactly μF"
        );
        // The rest of the way, and 100 radians of the shear mode, which is then damped by e^-25 or more.
        let rest = ((stop_s + 100.0 / shear_omega) / model.time_step_s()) as usize;
        advance(&model, &ON_A_TABLE, &mut state, rest);
        assert!(state.contacts.state.iter().all(|s| s[0] == ContactState::Stick), "at rest it sticks");
        let (position, velocity) = centre(&model, &state);
        assert!(velocity.abs() < 1e-6 * speed, "it has come to rest");
        let error = (position - distance).abs();
        let deflection = MU * LOAD_N / shear_stiffness;
        assert!(
            error < 3.0 * deflection,
            "E = {young_modulus_pa:e}: {error:e} m off, deflection {deflection:e} m"
        );
        errors.push(error / distance);
    }
    assert!(errors[2] < errors[0] / 30.0, "the error vanishes with the compliance: {errors:?}");
}

/// Protects: the friction cone's limit: below it not the slightest slip, above it the rigid acceleration.
#[test]
fn sticks_on_an_incline_up_to_the_friction_angle() {
    for (fraction, sticks) in [(0.5, true), (0.99, true), (1.01, false), (2.0, false)] {
        let pull = fraction * MU;
        let young_modulus_pa = 1.0e9;
        let shear_omega = (2.0 * young_modulus_pa * COLUMN_AREA_M2 / COLUMN_HEIGHT_M / mass_kg()).sqrt();
        // Critically damped, and pulled slowly over many periods, so that nothing overshoots.
        let model = block(young_modulus_pa, pull, 2.0 / shear_omega);
        let ramp_s = 200.0 / shear_omega;
        let drive = Drive { ramp_s, ..ON_A_TABLE };
        let mut state = State::at_rest(&model);
        let ramp_steps = (1.5 * ramp_s / model.time_step_s()).ceil() as usize;
        let mut slipped = false;
        for _ in 0..ramp_steps {
            advance(&model, &drive, &mut state, 1);
            slipped |= state.contacts.state.iter().any(|s| s[0] == ContactState::Slip);
        }
        assert_eq!(slipped, !sticks, "tan α = {fraction} μ");
        let base_y = state.u[1];
        if sticks {
            assert_eq!(base_y, 0.0, "a sticking base does not creep");
            continue;
        }
        let (_, before) = centre(&model, &state);
        let from = state.step;
        advance(&model, &drive, &mut state, ramp_steps);
        let elapsed_s = (state.step - from) as f64 * model.time_step_s();
        let (_, after) = centre(&model, &state);
        let acceleration = (after - before) / elapsed_s;
        let exact = (pull - MU) * LOAD_N / mass_kg();
        // What is left of the start-up vibration, e^-100, is below rounding.
        assert!((acceleration / exact - 1.0).abs() < 1e-6, "{acceleration} instead of {exact} m/s²");
    }
}

//! B7 A rigid block: stopping distance, and stick on an incline.
//!
//! A block of mass m is pressed with F and slides at v0. Friction decelerates it by d = μF/m, so it stops
//! after t = v0/d and v0²/(2d). On an incline of angle α, the tangential pull is F tan α and F is the normal
//! force. The block sticks if and only if tan α ≤ μ. Otherwise it accelerates by F(tan α − μ)/m. Source:
//! Coulomb's and Newton's laws; any textbook of mechanics.
//!
//! **The discrete solution.** Under a constant force the β₂ method is exact for any β₂: at t_n = nΔt, u_n =
//! v0 t_n − d t_n²/2 and p_n = v0 − d(t_n − β₂Δt). The block sticks in the first step in which friction can
//! stop it, p_n ≤ (½ + β₂)dΔt, that is t_n ≥ t − Δt/2. So it stops at the t_n nearest to the exact t, at most
//! Δt/2 off. Its place is exactly u_n = v0²/(2d) − d(t_n − t)²/2, at most dΔt²/8 short. (With β₂ above ½ the
//! share (β₂ − ½)/(β₂ + ½) of p remains after a step of stick. Less friction than before then holds the
//! block.) So the stopping time is of first order and the distance of second order. With t/Δt = N + 1/3, and
//! N such that the next resolution is 4(N + 1/3), the offset is Δt/3 every time, and single orders are
//! regular.
//!
//! **On an elastic block** (two levels of m/2, shear spring k) in steady deceleration, the top is ahead by
//! μF/(2k) and both levels have the rigid block's velocity. The base sticks by the same criterion, because
//! its m/2 and the spring's μF/2 add up to those of the rigid block. Afterwards at most μF/2 and the rest of
//! the last step's momentum pull at it, so it keeps the rigid block's position.

use crate::verification::common::{
    COLUMN_AREA_M2, COLUMN_HEIGHT_M, advance, all_of, column_mesh, definition, level_ties,
};
use crate::verification::evidence::Evidence;
use crate::verification::particles::{Particles, Y, Z};
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::material::Material;
use tribosweep_mechanics::solver::support::Support;
use tribosweep_mechanics::solver::support::load::LoadShare;
use tribosweep_mechanics::solver::{Drive, Model, ModelDefinition, State, TimeStep};

const MU: f64 = 0.3;
const LOAD_N: f64 = 1000.0;
const MASS_KG: f64 = 0.25;
const SPEED_M_S: f64 = 0.2;
const DECELERATION_M_S2: f64 = MU * LOAD_N / MASS_KG;
const STOP_TIME_S: f64 = SPEED_M_S / DECELERATION_M_S2;
const STOP_DISTANCE_M: f64 = 0.5 * SPEED_M_S * STOP_TIME_S;
const DRIVE: Drive = Drive { law: Law::coulomb(MU), rate: 0.0, force_n: LOAD_N, ramp_s: 0.0 };
const NEWTON: &str = "uniform deceleration μF/m (Newton, Coulomb)";

/// A point mass pressed with the load and pulled in y by `pull` times it.
fn rigid_block(pull: f64, beta2: f64, time_step_s: f64) -> Model {
    let mut block = Particles::corners(MASS_KG);
    block.release(0, Y).release(0, Z).load(0, Y, pull).load(0, Z, -1.0);
    let definition = block.definition(0.0, TimeStep::Given(time_step_s));
    Model::new(ModelDefinition { beta2, ..definition }).unwrap()
}

fn is_stuck(state: &State<1>, slave: usize) -> bool {
    state.contacts.state_of(slave, 0) == ContactState::Stick
}

/// Slides until the block sticks, and continues for as long again. Returns the time [s] and the place [m] of
/// the stop.
fn slide_to_rest(model: &Model, mut state: State<1>) -> (f64, f64) {
    let mut stopped_at = None;
    let steps = (2.0 * STOP_TIME_S / model.time_step_s()) as u64;
    for n in 0..steps {
        advance(model, &DRIVE, &mut state, 1);
        let sticks = is_stuck(&state, 0);
        // Step n starts at t_n. The block stops there if this is the first step in which it sticks.
        stopped_at = stopped_at.or(sticks.then_some(n as f64 * model.time_step_s()));
        assert_eq!(sticks, stopped_at.is_some(), "what has stopped does not move again");
    }
    (stopped_at.expect("it stops"), state.u[Y])
}

fn sliding(model: &Model) -> State<1> {
    let mut state = State::at_rest(model);
    state.p[Y] = SPEED_M_S;
    state
}

/// Protects: sliding friction and the transition to rest within a step are right for a point mass.
#[test]
fn stops_where_and_when_a_rigid_block_stops() {
    let mut time = Evidence::new("B7", "stopping time of a rigid block [s]", NEWTON);
    let mut distance = Evidence::new("B7", "stopping distance of a rigid block [m]", NEWTON);
    let mut discrete = Evidence::new(
        "B7",
        "stopping distance less what the last step leaves [m]",
        "exact discrete solution: central difference under a constant force",
    );
    let mut most_steps: f64 = 0.0;
    for steps in [10.0 + 1.0 / 3.0, 41.0 + 1.0 / 3.0, 165.0 + 1.0 / 3.0] {
        for beta2 in [0.5, 0.6, 0.8, 1.0] {
            let model = rigid_block(0.0, beta2, STOP_TIME_S / steps);
            let (stopped_s, place_m) = slide_to_rest(&model, sliding(&model));
            let offset_s = stopped_s - STOP_TIME_S;
            let exact = STOP_DISTANCE_M - 0.5 * DECELERATION_M_S2 * offset_s * offset_s;
            discrete.found(format!("t/Δt = {steps:.2}, β₂ = {beta2}"), place_m, exact, STOP_DISTANCE_M);
            if beta2 == 0.5 {
                let resolution = format!("t/Δt = {steps:.2}");
                time.found(&resolution, stopped_s, STOP_TIME_S, STOP_TIME_S);
                distance.found(&resolution, place_m, STOP_DISTANCE_M, STOP_DISTANCE_M);
            }
        }
        most_steps = most_steps.max(steps);
    }
    // Each step rounds p and u a few times. An error of p acts over the rest of the distance.
    let roundings = 10.0 * most_steps;
    time.judge_order(1.0, 4.0, roundings * f64::EPSILON);
    distance.judge_order(2.0, 4.0, roundings * f64::EPSILON);
    discrete.judge_exact(roundings);
}

/// Protects: the bounds of the last step hold for any phase of the exact stop within a step.
#[test]
fn the_last_step_costs_at_most_half_a_step() {
    let mut time = Evidence::new("B7", "stopping time at any phase of the step [s]", NEWTON);
    let mut distance = Evidence::new("B7", "stopping distance at any phase of the step [m]", NEWTON);
    for tenths in 0..10 {
        let steps = 20.0 + (f64::from(tenths) + 0.05) / 10.0;
        let model = rigid_block(0.0, 0.5, STOP_TIME_S / steps);
        let (stopped_s, place_m) = slide_to_rest(&model, sliding(&model));
        let resolution = format!("t/Δt = {steps:.3}");
        time.bounded(&resolution, stopped_s, STOP_TIME_S, STOP_TIME_S, 0.5 / steps);
        // dΔt²/8 over v0²/(2d) = dt²/2.
        distance.bounded(&resolution, place_m, STOP_DISTANCE_M, STOP_DISTANCE_M, 0.25 / (steps * steps));
    }
    time.judge_bounded("it stops at the step nearest to the exact time, Δt/2 off at most");
    distance.judge_bounded("v0²/(2d) − u = d(t_n − t)²/2 ≤ dΔt²/8");
}

/// Protects: the friction cone's limit is exact to rounding, and so is the acceleration beyond it.
#[test]
fn sticks_on_an_incline_up_to_the_friction_angle() {
    const STEPS: usize = 1000;
    let time_step_s = 1.0e-6;
    let mut travel =
        Evidence::new("B7", "travel on an incline of tan α = r μ [m]", "a = F(tan α − μ)/m; 0 for r ≤ 1");
    // Trial force and limit are rounded a few times each. 1 ∓ 16 ε is beyond these roundings.
    let edge = 16.0 * f64::EPSILON;
    for ratio in [0.0, 0.5, 1.0 - edge, 1.0 + edge, 1.01, 2.0] {
        let model = rigid_block(ratio * MU, 0.5, time_step_s);
        let mut state = State::at_rest(&model);
        for _ in 0..STEPS {
            advance(&model, &DRIVE, &mut state, 1);
            assert_eq!(is_stuck(&state, 0), ratio <= 1.0, "tan α = {ratio} μ");
        }
        assert!(ratio > 1.0 || state.u[Y] == 0.0, "a sticking block does not creep");
        let elapsed_s = STEPS as f64 * time_step_s;
        let exact = 0.5 * DECELERATION_M_S2 * (ratio - 1.0).max(0.0) * elapsed_s * elapsed_s;
        let scale = 0.5 * DECELERATION_M_S2 * elapsed_s * elapsed_s;
        travel.found(format!("r = {ratio}"), state.u[Y], exact, scale);
    }
    travel.judge_exact(10.0 * STEPS as f64);
}

/// One elastic element, its two levels tied in y and z.
fn elastic_block(young_modulus_pa: f64, pull: f64, beta_r_s: f64, time_step: TimeStep) -> Model {
    let mesh = column_mesh(1);
    let ties = [level_ties(&mesh, 1), level_ties(&mesh, 2)].concat();
    let supports = [vec![Support::fixed(all_of(&mesh, 0))], ties].concat();
    let load = mesh
        .top_nodes()
        .flat_map(|node| {
            [
                LoadShare { dof: 3 * node + Y, share: pull / 4.0 },
                LoadShare { dof: 3 * node + Z, share: -0.25 },
            ]
        })
        .collect();
    let density_kg_m3 = MASS_KG / (COLUMN_AREA_M2 * COLUMN_HEIGHT_M);
    let material = Material { young_modulus_pa, poisson_ratio: 0.0, density_kg_m3 };
    Model::new(ModelDefinition { load, beta_r_s, time_step, ..definition(mesh, material, supports) }).unwrap()
}

fn shear_stiffness_n_m(young_modulus_pa: f64) -> f64 {
    young_modulus_pa / 2.0 * COLUMN_AREA_M2 / COLUMN_HEIGHT_M
}

/// Protects: the base of a deforming block stops where a rigid block stops. It does not move again while the
/// rest of the block comes to rest.
#[test]
fn an_elastic_blocks_base_stops_like_a_rigid_block() {
    let mut place = Evidence::new(
        "B7",
        "stopping distance of an elastic block's base less what the last step leaves [m]",
        "exact discrete solution: steady deceleration with the top ahead by μF/(2k)",
    );
    for young_modulus_pa in [1.0e8, 1.0e9, 1.0e10] {
        let stiffness = shear_stiffness_n_m(young_modulus_pa);
        let shear_omega = (4.0 * stiffness / MASS_KG).sqrt();
        let model = elastic_block(young_modulus_pa, 0.0, 1.0 / shear_omega, TimeStep::FractionOfLimit(0.5));
        let mut state = State::at_rest(&model);
        for node in 0..model.mesh().block().unwrap().node_count() {
            state.p[3 * node + Y] = SPEED_M_S;
        }
        for node in model.mesh().block().unwrap().top_nodes() {
            state.u[3 * node + Y] = MU * LOAD_N / (2.0 * stiffness);
            state.u[3 * node + Z] = -LOAD_N * COLUMN_HEIGHT_M / (young_modulus_pa * COLUMN_AREA_M2);
        }
        let steps = STOP_TIME_S / model.time_step_s();
        let (stopped_s, place_m) = slide_to_rest(&model, state);
        let offset_s = stopped_s - STOP_TIME_S;
        assert!(offset_s.abs() <= 0.5 * model.time_step_s() * (1.0 + 1e-9), "{offset_s:e} s off");
        let exact = STOP_DISTANCE_M - 0.5 * DECELERATION_M_S2 * offset_s * offset_s;
        // Rounding of the spring's force: a displacement D has the rounding error εD. The spring turns it
        // into a force kεD. In the time Δt < 1/ω this force causes a displacement of at most εD again. This
        // happens once per step.
        let bound = 20.0 * steps * f64::EPSILON;
        place.bounded(format!("E = {young_modulus_pa:.0e} Pa"), place_m, exact, STOP_DISTANCE_M, bound);
    }
    place.judge_bounded("20 roundings a step");
}

/// Protects: a deforming block that is pulled up to its limit does not slip at all below the limit, and slips
/// above it.
///
/// The shear mode ω is critically damped and pulled with a ramp over T = 200/ω. The base's traction exceeds
/// that of a slow ramp by at most 1/(eωT) = 0.2 % of the pull (the response to a ramp is R/f = (1 + 2s)/(1 +
/// s)², s in units of ω). So 0.99 of the limit stays below the limit.
#[test]
fn an_elastic_block_sticks_up_to_the_friction_angle() {
    for (fraction, sticks) in [(0.5, true), (0.99, true), (1.01, false), (2.0, false)] {
        let young_modulus_pa = 1.0e9;
        let shear_omega = (2.0 * shear_stiffness_n_m(young_modulus_pa) / MASS_KG).sqrt();
        let model =
            elastic_block(young_modulus_pa, fraction * MU, 2.0 / shear_omega, TimeStep::FractionOfLimit(0.5));
        let drive = Drive { ramp_s: 200.0 / shear_omega, ..DRIVE };
        let mut state = State::at_rest(&model);
        let mut slipped = false;
        for _ in 0..(1.5 * drive.ramp_s / model.time_step_s()).ceil() as usize {
            advance(&model, &drive, &mut state, 1);
            slipped |= state.contacts.states(0).any(|s| s == ContactState::Slip);
        }
        assert_eq!(slipped, !sticks, "tan α = {fraction} μ");
        assert!(slipped || state.u[Y] == 0.0, "a sticking base does not creep");
    }
}

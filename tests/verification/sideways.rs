//! B7 A block thrown sideways onto a moving plane: friction opposes the slip, not the velocity.
//!
//! A block of mass m, pressed with F, is put on a plane that moves with V towards +y. The block has the
//! velocity v_x across. In the plane's frame its velocity is w = (v_x, −V), and Coulomb's friction, μF
//! against w, only makes it slower. So it moves straight and stops after |w|/d and |w|²/(2d), d = μF/m. From
//! then on the plane carries it. At any later time T it is at x = v_x|w|/(2d), y = VT − V|w|/(2d). Its path
//! is a parabola while it slips. Source: Galileo's relativity and B7.
//!
//! **The discrete solution** is that of the rigid block of B7 in the plane's frame. The block stops at the
//! step nearest to the exact time, and d(t_n − t)²/2 is missing along w.

use crate::verification::common::advance;
use crate::verification::evidence::Evidence;
use crate::verification::particles::{Particles, X, Y, Z};
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::{Drive, State, TimeStep};

const DECELERATION_M_S2: f64 = 3.0;
const ACROSS_M_S: f64 = 0.4;
const PLANE_M_S: f64 = 0.3;
const RELATIVE_M_S: f64 = 0.5;
const STOP_S: f64 = RELATIVE_M_S / DECELERATION_M_S2;
const WAY_M: f64 = 0.5 * RELATIVE_M_S * STOP_S;

/// Protects: the direction of friction in the plane is right, with x and y coupled by the cone and a moving
/// target.
#[test]
fn is_carried_from_where_its_slip_ends() {
    const SOURCE: &str = "straight uniform deceleration μF/m in the plane's frame";
    let mut across =
        Evidence::new("B7", "way across of a block thrown sideways onto a moving plane [m]", SOURCE);
    let mut along =
        Evidence::new("B7", "lag along the plane's motion of a block thrown sideways onto it [m]", SOURCE);
    let mut discrete = Evidence::new(
        "B7",
        "way and lag of a block thrown sideways less what the last step leaves [m]",
        "exact discrete solution: central difference under a constant force",
    );
    let mut most_steps: f64 = 0.0;
    for steps in [10.0 + 1.0 / 3.0, 41.0 + 1.0 / 3.0, 165.0 + 1.0 / 3.0] {
        let mut block = Particles::corners(2.0);
        block.release(0, X).release(0, Y).release(0, Z).load(0, Z, -1.0);
        let model = block.model(0.0, TimeStep::Given(STOP_S / steps));
        let mu = 0.25;
        let drive = Drive {
            law: Law::coulomb(mu),
            rate: PLANE_M_S,
            force_n: 2.0 * DECELERATION_M_S2 / mu,
            ramp_s: 0.0,
        };
        let mut state = State::at_rest(&model);
        state.p[X] = ACROSS_M_S;
        let mut stopped_s = None;
        for n in 0..(2.0 * steps) as u64 {
            advance(&model, &drive, &mut state, 1);
            let sticks = state.contacts.state_of(0, 0) == ContactState::Stick;
            stopped_s = stopped_s.or(sticks.then_some(n as f64 * model.time_step_s()));
            assert_eq!(sticks, stopped_s.is_some(), "what is carried does not slip again");
        }
        let offset_s = stopped_s.expect("it is carried") - STOP_S;
        assert!(offset_s.abs() <= 0.5 * model.time_step_s());
        let lag_m = PLANE_M_S * state.step as f64 * model.time_step_s() - state.u[Y];
        let resolution = format!("t/Δt = {steps:.2}");
        let short_m = 0.5 * DECELERATION_M_S2 * offset_s * offset_s;
        let (x_part, y_part) = (ACROSS_M_S / RELATIVE_M_S, PLANE_M_S / RELATIVE_M_S);
        across.found(&resolution, state.u[X], WAY_M * x_part, WAY_M);
        along.found(&resolution, lag_m, WAY_M * y_part, WAY_M);
        discrete.found(format!("{resolution}, x"), state.u[X], (WAY_M - short_m) * x_part, WAY_M);
        discrete.found(format!("{resolution}, y"), lag_m, (WAY_M - short_m) * y_part, WAY_M);
        most_steps = most_steps.max(2.0 * steps);
    }
    // Each step rounds p and u a few times. An error of p acts over the rest of the distance. An error of the
    // direction, ε|w|/|p|, has the less effect the shorter this rest is.
    let roundings = 10.0 * most_steps;
    across.judge_order(2.0, 4.0, roundings * f64::EPSILON);
    along.judge_order(2.0, 4.0, roundings * f64::EPSILON);
    discrete.judge_exact(roundings);
}

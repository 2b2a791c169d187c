//! B3 The β₂ integrator on single modes of a real mesh.
//!
//! For a mode of frequency ω, W = ωΔt and b = β_R/Δt, successive displacements obey
//! q_{n+1} = trace·q_n − det·q_{n−1} with det = 1 − (β₂ − ½ + b)W² and trace = 2 − (½ + β₂ + b)W²;
//! the limit is W²(β₂ + b) = 2, i.e. W = √(2/β₂) undamped. Source: the amplification matrix of the
//! scheme (Newmark, β = 0, γ = β₂); exact.

use crate::common::{IDLE, advance, bar};
use std::f64::consts::PI;
use tribosweep::solver::{Model, ModelDefinition, SolverError, State, TimeStep};

const LAYERS: usize = 12;

/// A bar in its mode `mode`, one unit above the plane.
fn in_mode(model: &Model, mode: usize) -> State<1> {
    let mut state = State::at_rest(model);
    for node in 0..model.mesh().node_count() {
        let k = model.mesh().grid_position(node)[2] as f64;
        state.u[3 * node + 2] = 2.0 + (mode as f64 * PI / LAYERS as f64 * k).cos();
    }
    state
}

fn omega(model: &Model, mode: usize) -> f64 {
    let h = model.mesh().element_size_m()[2];
    2.0 * model.material().pressure_wave_speed_m_s() / h * (mode as f64 * PI / (2 * LAYERS) as f64).sin()
}

/// Protects: numerical and physical damping and the phase per step are exactly those of the scheme.
#[test]
fn modes_follow_the_amplification_matrix() {
    for beta2 in [0.5, 0.6, 0.8, 1.0] {
        for beta_r_s in [0.0, 5.0e-8, 1.0e-6] {
            let time_step = TimeStep::FractionOfLimit(0.8);
            let model = Model::new(ModelDefinition { beta2, beta_r_s, time_step, ..bar(LAYERS) }).unwrap();
            let dt = model.time_step_s();
            for mode in [1, 5, 12] {
                let w2 = (omega(&model, mode) * dt).powi(2);
                let b = beta_r_s / dt;
                let determinant = 1.0 - (beta2 - 0.5 + b) * w2;
                let trace = 2.0 - (0.5 + beta2 + b) * w2;
                let mut state = in_mode(&model, mode);
                let mut q = vec![state.u[2] - 2.0];
                for _ in 0..60 {
                    advance(&model, &IDLE, &mut state, 1);
                    q.push(state.u[2] - 2.0);
                }
                // From rest the half-force first step gives q_1 = (1 − W²/2) q_0.
                assert!((q[1] - (1.0 - w2 / 2.0)).abs() < 1e-13, "first step of β₂ = {beta2}");
                // From q_1 on all steps are alike, so the recursion holds for three successive values.
                for n in 3..q.len() {
                    let error = (q[n] - (trace * q[n - 1] - determinant * q[n - 2])).abs();
                    // u = 2 + q: each step rounds K u, whose terms are (ω_maxΔt)²·2 ≈ 10 times q, and
                    // the rounding of all steps before is integrated twice.
                    assert!(
                        error < 10.0 * f64::EPSILON * (n * n) as f64,
                        "β₂ = {beta2}, β_R = {beta_r_s}, mode {mode}, step {n}: {error:e}"
                    );
                }
            }
        }
    }
}

/// Largest displacement of the highest mode after many steps at a fraction of the limit.
fn growth(beta2: f64, beta_r_s: f64, fraction: f64) -> f64 {
    let limit = Model::new(ModelDefinition { beta2, beta_r_s, ..bar(LAYERS) }).unwrap().time_step_limit_s();
    let time_step = TimeStep::Unchecked(fraction * limit);
    let model = Model::new(ModelDefinition { beta2, beta_r_s, time_step, ..bar(LAYERS) }).unwrap();
    let mut state = in_mode(&model, LAYERS);
    advance(&model, &IDLE, &mut state, 3000);
    state.u.values().skip(2).step_by(3).map(|u| (u - 2.0).abs()).fold(0.0, f64::max)
}

/// Protects: the limit that the program states is the limit of the program's own step.
#[test]
fn stated_limit_is_the_limit() {
    for beta2 in [0.5, 0.7, 1.0] {
        for beta_r_s in [0.0, 1.0e-7] {
            let below = growth(beta2, beta_r_s, 0.999);
            assert!(below < 100.0, "β₂ = {beta2}, β_R = {beta_r_s}: {below} below the limit");
            let above = growth(beta2, beta_r_s, 1.002);
            assert!(above.is_nan() || above > 1e6, "β₂ = {beta2}, β_R = {beta_r_s}: {above} above the limit");
        }
    }
}

/// Protects: a given step above the limit is refused with both numbers; at the limit it is taken.
#[test]
fn a_step_above_the_limit_is_refused() {
    let limit_s = Model::new(bar(LAYERS)).unwrap().time_step_limit_s();
    let given = |dt| Model::new(ModelDefinition { time_step: TimeStep::Given(dt), ..bar(LAYERS) });
    assert_eq!(given(limit_s).unwrap().time_step_s(), limit_s);
    let error = given(1.001 * limit_s).unwrap_err();
    let SolverError::TimeStepTooLarge { time_step_s, limit_s: stated, .. } = error else { panic!("{error}") };
    assert_eq!((time_step_s, stated), (1.001 * limit_s, limit_s));
    let message = error.to_string();
    assert!(
        message.contains(&format!("{time_step_s:e}")) && message.contains(&format!("{stated:e}")),
        "{message}"
    );
}

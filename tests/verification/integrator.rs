//! B3 The β₂ integrator on single modes of a real mesh.
//!
//! Problem: one oscillator of frequency ω. With W = ωΔt and d = (β_R ω² + α_R)Δt, successive displacements obey q_{n+1}
//! = trace·q_n − det·q_{n−1}, det = 1 − (β₂ − ½)W² − d, trace = 2 − (½ + β₂)W² − d = 2√det cos θ. The
//! stability limit is β₂W² + d = 2, i.e. W = √(2/β₂) without damping. Source: the amplification matrix of
//! Newmark's method with β = 0, γ = β₂ (N. M. Newmark 1959; T. J. R. Hughes, *The finite element method*,
//! 1987, ch. 9). The answer is exact.
//!
//! det is found as the ratio of successive Casoratians q_{n+1}q_{n−1} − q_n², which the recursion multiplies
//! by det at every step (Abel's identity). The trace is found from (q_{n+1} + det q_{n−1})/q_n.

use crate::verification::common::{IDLE, ROUNDINGS_PER_FORCE, advance, bar};
use crate::verification::evidence::Evidence;
use std::f64::consts::PI;
use tribosweep_mechanics::solver::{Model, ModelDefinition, SolverError, State, TimeStep};

const LAYERS: usize = 12;
const SOURCE: &str = "amplification matrix of Newmark's method, β = 0, γ = β₂";

/// A bar in its mode `mode`, 2 m above the plane.
fn in_mode(model: &Model, mode: usize) -> State<1> {
    let mut state = State::at_rest(model);
    for node in 0..model.mesh().block().unwrap().node_count() {
        let k = model.mesh().block().unwrap().grid_position(node)[2] as f64;
        state.u[3 * node + 2] = 2.0 + (mode as f64 * PI / LAYERS as f64 * k).cos();
    }
    state
}

fn omega(model: &Model, mode: usize) -> f64 {
    let h = model.mesh().block().unwrap().element_size_m()[2];
    2.0 * model.pin().material().pressure_wave_speed_m_s() / h
        * (mode as f64 * PI / (2 * LAYERS) as f64).sin()
}

/// Rounding of a displacement after n steps. Each step rounds Δt²M⁻¹K(u + β_R p), of size (ω_maxΔt)²(1 + b)·3
/// times a scheme's factor of at most 3/2. The error of a step grows at most linearly.
fn rounding(model: &Model, n: usize) -> f64 {
    let dt = model.time_step_s();
    let w2 = (omega(model, LAYERS) * dt).powi(2);
    let size = 1.5 * (w2 * (1.0 + model.scheme().beta_r_s / dt) * 3.0 + model.scheme().alpha_r_per_s * dt);
    ROUNDINGS_PER_FORCE * size * f64::EPSILON * (n * n) as f64 / 2.0
}

/// Protects: numerical damping, physical damping and the phase per step are exactly those of the scheme.
#[test]
fn modes_follow_the_amplification_matrix() {
    let steps = 8;
    for beta2 in [0.5, 0.6, 0.8, 1.0] {
        let case = |what: &str| Evidence::new("B3", format!("β₂ = {beta2}, {what}"), SOURCE);
        let (mut dets, mut traces, mut first) =
            (case("det"), case("trace = 2√det cos θ"), case("half-force first step"));
        for (beta_r_s, alpha_r_per_s) in
            [(0.0, 0.0), (5.0e-8, 0.0), (1.0e-6, 0.0), (0.0, 2.0e5), (5.0e-8, 2.0e5)]
        {
            let time_step = TimeStep::FractionOfLimit(0.8);
            let definition = ModelDefinition { beta2, beta_r_s, alpha_r_per_s, time_step, ..bar(LAYERS) };
            let model = Model::new(definition).unwrap();
            let dt = model.time_step_s();
            for mode in [1, 5, 12] {
                let w2 = (omega(&model, mode) * dt).powi(2);
                let damping = beta_r_s / dt * w2 + alpha_r_per_s * dt;
                let determinant = 1.0 - (beta2 - 0.5) * w2 - damping;
                let trace = 2.0 - (0.5 + beta2) * w2 - damping;
                let mut state = in_mode(&model, mode);
                let mut q = vec![state.u[2] - 2.0];
                for _ in 0..steps {
                    advance(&model, &IDLE, &mut state, 1);
                    q.push(state.u[2] - 2.0);
                }
                let alpha =
                    if alpha_r_per_s > 0.0 { format!("α_R = {alpha_r_per_s} 1/s, ") } else { String::new() };
                let name = format!("{alpha}β_R = {beta_r_s} s, mode {mode}, W = {:.3}", w2.sqrt());
                // From rest, the first step with half the force gives q_1 = (1 − W²/2) q_0.
                first.bounded(&name, q[1], 1.0 - w2 / 2.0, 1.0, rounding(&model, 1));
                // From q_1 on all steps are alike. Three successive values give a Casoratian.
                let casoratian = |n: usize| q[n + 1] * q[n - 1] - q[n] * q[n];
                let n = (2..steps - 1).max_by(|&a, &b| {
                    casoratian(a).abs().min(q[a].abs()).total_cmp(&casoratian(b).abs().min(q[b].abs()))
                });
                let n = n.expect("steps");
                let det = casoratian(n + 1) / casoratian(n);
                let trace_found = (q[n + 1] + det * q[n - 1]) / q[n];
                // A Casoratian has three products of values up to |q|, and each of them carries two
                // roundings.
                let size = q[n - 1..=n + 2].iter().fold(0.0_f64, |a, q| a.max(q.abs()));
                let bound = 2.0 * 4.0 * size * rounding(&model, steps) / casoratian(n).abs();
                dets.bounded(&name, det, determinant, 1.0, bound);
                // Two displacements enter the trace, and det enters with its own error.
                let bound = (4.0 * rounding(&model, steps) + size * bound) / q[n].abs();
                traces.bounded(&name, trace_found, trace, 1.0, bound);
            }
        }
        dets.judge_bounded("rounding of the displacements, carried through the Casoratians");
        traces.judge_bounded("rounding of the displacements, carried through the Casoratians");
        first.judge_bounded("rounding of one step");
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

/// Protects: the limit that the program states is that of the scheme, W²(β₂ + b) = 2, and that of its own
/// step. At 0.999 of it the highest mode, undamped, stays below 1/sin θ = 11. At 1.002 the root near −1
/// exceeds 1 in size by (W²(β₂+b) − 2)·2/(1 − det) ≥ 0.016/(1 − det), with 1 − det ≤ 2, so that 3000 steps
/// give 10¹⁰ at least.
#[test]
fn stated_limit_is_the_limit() {
    let mut evidence = Evidence::new("B3", "limit, W²(β₂ + β_R/Δt)", SOURCE);
    for beta2 in [0.5, 0.7, 1.0] {
        for beta_r_s in [0.0, 1.0e-7] {
            let model = Model::new(ModelDefinition { beta2, beta_r_s, ..bar(LAYERS) }).unwrap();
            let limit_s = model.time_step_limit_s();
            let found = (omega(&model, LAYERS) * limit_s).powi(2) * (beta2 + beta_r_s / limit_s);
            evidence.found(format!("β₂ = {beta2}, β_R = {beta_r_s} s"), found, 2.0, 2.0);
            let below = growth(beta2, beta_r_s, 0.999);
            assert!(below < 100.0, "β₂ = {beta2}, β_R = {beta_r_s}: {below} below the limit");
            let above = growth(beta2, beta_r_s, 1.002);
            assert!(above.is_nan() || above > 1e6, "β₂ = {beta2}, β_R = {beta_r_s}: {above} above the limit");
        }
    }
    // The roundings are those of the element's stiffness and of the eigenvalues of its reduced 24 × 24
    // matrix. ω is the root of an eigenvalue.
    evidence.judge_exact(ROUNDINGS_PER_FORCE + 24.0);
}

/// Protects: a given step above the limit is refused with both numbers. A step at the limit is accepted.
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

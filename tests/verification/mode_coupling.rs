//! B9 Mode-coupling flutter of a sliding contact with a constant friction coefficient.
//!
//! ```text
//!            B  (mass m, moves in z only)          spring k between C and B along (cos θ, sin θ)
//!           /                                      spring k_g = k (s² − c²) from C to the ground in y
//!          / k                                     dead load N0 on C, belt towards +y at V
//!   k_g   /
//! |-/\/-- C  (mass m, y free, z ≥ 0)               c = cos θ, s = sin θ
//! ------------------- belt, μ  --> V
//! ```
//!
//! While C slides (N > 0, ẏ < V), the spring's elongation is e = s z_B − c y, the normal force is N = N0 − k
//! s e, and friction is μN. With m = k = 1 and offsets removed:
//!
//! ```text
//! ÿ + [c (c − μs) + s² − c²] y − s (c − μs) z = 0       trace T = 2s² − μsc
//! z̈ − s c y + s² z = 0                                  determinant D = s² (s² − c²), whatever μ
//! ```
//!
//! So λ² = −T/2 ± √(T²/4 − D). There are two frequencies while T² > 4D, and a growing oscillation beyond
//! **μ_c = 2 tan θ (1 − √(1 − cot² θ))**. (Im λ²)² = D − T²/4 is a quadratic function of μ. For θ = 80°, μ_c
//! = 0.17772. At μ = 0.1 the frequencies are 1.036404 and 0.921118 rad/s. At μ = 0.2, λ = 0.0308635 ±
//! 0.9765746 i. At μ = 0.4, λ = 0.0974837 ± 0.9721869 i. Source: the two equations above. The mechanism is
//! that of Hoffmann, Fischer, Allgaier and Gaul, *A minimal model for studying properties of the
//! mode-coupling type instability in friction induced oscillations*, Mechanics Research Communications 29
//! (2002) 197–205.
//!
//! **The discrete solution.** The central difference turns e^{λt} into r^n with r − 2 + 1/r = (λΔt)², that is
//! sinh(ln r / 2) = λΔt/2. So neutral motion stays neutral, the onset does not depend on Δt, and ln r/Δt
//! differs from λ by −λ³Δt²/24: second order in growth rate and in frequency. r is measured from the
//! histories y_n and z_n. A 2 × 2 matrix times (y, z) plus a constant is fitted to their second differences
//! by least squares. The eigenvalues of the matrix are r − 2 + 1/r.

use crate::verification::evidence::Evidence;
use crate::verification::particles::{Particles, Y, Z};
use std::f64::consts::PI;
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::{Drive, Model, State, TimeStep, step};

const TIME_STEPS_S: [f64; 3] = [0.1, 0.05, 0.025];
pub const NORMAL_N: f64 = 1.0;
const SOURCE: &str = "eigenvalues of the sliding oscillator, λ² = −T/2 ± √(T²/4 − D)";

fn direction() -> (f64, f64) {
    (80.0 * PI / 180.0_f64).sin_cos()
}

/// C is node 0, B node 4 above it. Node 1 is the ground: its reactions are the clamp's.
pub fn oscillator(time_step_s: f64) -> Model {
    let (s, c) = direction();
    let mut system = Particles::corners(1.0);
    system
        .release(0, Y)
        .release(0, Z)
        .release(4, Z)
        .spring(0, 4, [0.0, c, s], 1.0)
        .spring(0, 1, [0.0, 1.0, 0.0], s * s - c * c)
        .load(0, Z, -1.0);
    system.model(0.0, TimeStep::Given(time_step_s))
}

pub const BODY_Z: usize = 3 * 4 + Z;

/// Steady sliding: N = N0, e = 0, k_g y = μN0.
pub fn steady(model: &Model, mu: f64) -> State<1> {
    let (s, c) = direction();
    let mut state = State::at_rest(model);
    state.u[Y] = mu * NORMAL_N / (s * s - c * c);
    state.u[BODY_Z] = state.u[Y] * c / s;
    state
}

/// A complex number as (real, imaginary).
type Complex = (f64, f64);

fn sqrt((re, im): Complex) -> Complex {
    let size = re.hypot(im);
    (((size + re) / 2.0).max(0.0).sqrt(), ((size - re) / 2.0).max(0.0).sqrt().copysign(im))
}

fn ln((re, im): Complex) -> Complex {
    (re.hypot(im).ln(), im.atan2(re))
}

/// Exact λ of the two modes with Im λ > 0; the growing one first.
fn exact_modes(mu: f64) -> [Complex; 2] {
    let (s, c) = direction();
    let half_trace = s * s - mu * s * c / 2.0;
    let discriminant = half_trace * half_trace - s * s * (s * s - c * c);
    if discriminant >= 0.0 {
        let root = discriminant.sqrt();
        return [(0.0, (half_trace + root).sqrt()), (0.0, (half_trace - root).sqrt())];
    }
    let (re, im) = sqrt((-half_trace, (-discriminant).sqrt()));
    [(re, im), (-re, im)]
}

/// ln r/Δt of both modes, from sliding histories of y and z.
fn measured_modes(y: &[f64], z: &[f64], time_step_s: f64) -> [Complex; 2] {
    let inner = 1..y.len() - 1;
    let second = |x: &[f64]| inner.clone().map(|n| x[n + 1] - 2.0 * x[n] + x[n - 1]).collect::<Vec<_>>();
    // Centring is the least-squares fit of the constant.
    let centred = |x: &[f64]| {
        let mean = x.iter().sum::<f64>() / x.len() as f64;
        x.iter().map(|value| value - mean).collect::<Vec<_>>()
    };
    let (ay, az) = (centred(&second(y)), centred(&second(z)));
    let (y, z) = (centred(&y[inner.clone()]), centred(&z[inner.clone()]));
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (yy, yz, zz) = (dot(&y, &y), dot(&y, &z), dot(&z, &z));
    let fit = |a: &[f64]| {
        let (ya, za) = (dot(&y, a), dot(&z, a));
        let determinant = yy * zz - yz * yz;
        [(ya * zz - za * yz) / determinant, (yy * za - yz * ya) / determinant]
    };
    let [row_y, row_z] = [fit(&ay), fit(&az)];
    // The eigenvalues of the fitted matrix are q − 2, with q = r + 1/r.
    let half_trace = (row_y[0] + row_z[1]) / 2.0;
    let discriminant = ((row_y[0] - row_z[1]) / 2.0).powi(2) + row_y[1] * row_z[0];
    let root = if discriminant >= 0.0 { (discriminant.sqrt(), 0.0) } else { (0.0, (-discriminant).sqrt()) };
    [-1.0, 1.0].map(|sign| {
        // ln r = 2 arsinh(i v), v² = −(q − 2)/4 in the right half plane; arsinh(i v) = i arcsin(v).
        let v = sqrt((-(half_trace + sign * root.0) / 4.0, sign * root.1 / 4.0));
        // arcsin(v) = −i ln(i v + √(1 − v²))
        let w = sqrt((1.0 - v.0 * v.0 + v.1 * v.1, -2.0 * v.0 * v.1));
        let (size, angle) = ln((w.0 - v.1, w.1 + v.0));
        // arcsin(v) = angle − i size, so ln r = 2 (size + i angle).
        (2.0 * size / time_step_s, 2.0 * angle / time_step_s)
    })
}

/// Displacement [m] from steady sliding at the start. The motion is linear in it while N > 0 and ẏ < V.
const DISTURBANCE_M: f64 = 0.05;

/// Slides from a disturbance for `duration_s`. Returns the displacements of C in y and of B in z.
fn slide(mu: f64, time_step_s: f64, duration_s: f64) -> (Vec<f64>, Vec<f64>) {
    let model = oscillator(time_step_s);
    let drive = Drive { law: Law::coulomb(mu), rate: 10.0, force_n: NORMAL_N, ramp_s: 0.0 };
    let mut state = steady(&model, mu);
    state.u[Y] += DISTURBANCE_M;
    let (mut y, mut z) = (Vec::new(), Vec::new());
    for _ in 0..(duration_s / time_step_s) as usize {
        y.push(state.u[Y]);
        z.push(state.u[BODY_Z]);
        step(&model, &[drive], &mut state);
        assert_eq!(state.contacts.state_of(0, 0), ContactState::Slip, "the measured motion is sliding");
    }
    (y, z)
}

fn modes(mu: f64, time_step_s: f64) -> [Complex; 2] {
    let (y, z) = slide(mu, time_step_s, 20.0);
    measured_modes(&y, &z, time_step_s)
}

/// Rounding of a fitted coefficient over Δt²: displacements of up to 0.5 m are rounded, a second difference
/// has four of them, and the fit divides by the disturbance.
fn fit_rounding(time_step_s: f64) -> f64 {
    4.0 * f64::EPSILON * 0.5 / DISTURBANCE_M / (time_step_s * time_step_s)
}

/// Protects: the follower force that makes friction unstable has the right sign and size. Growth rates and
/// frequencies of flutter converge with the order of the scheme.
#[test]
fn flutter_grows_as_the_eigenvalues_say() {
    for (mu, growth, frequency) in [(0.2, 0.030_863_5, 0.976_574_6), (0.4, 0.097_483_7, 0.972_186_9)] {
        let exact = exact_modes(mu)[0];
        assert!((exact.0 - growth).abs() < 1.0e-7 && (exact.1 - frequency).abs() < 1.0e-7, "{exact:?}");
        let mut rate = Evidence::new("B9", format!("growth rate of flutter at μ = {mu} [1/s]"), SOURCE);
        let mut omega = Evidence::new("B9", format!("frequency of flutter at μ = {mu} [rad/s]"), SOURCE);
        for dt in TIME_STEPS_S {
            let found = modes(mu, dt)[0];
            rate.found(format!("Δt = {dt} s"), found.0, exact.0, exact.0);
            omega.found(format!("Δt = {dt} s"), found.1, exact.1, exact.1);
        }
        // An error δ of each of the four coefficients changes D − T²/4 = (2σω)² by at most 4δ and the root
        // 2σω by 4δ/(4σω). λ² also contains T/2.
        let of_square = fit_rounding(TIME_STEPS_S[2]) * (1.0 + 1.0 / (exact.0 * exact.1));
        rate.judge_order(2.0, 2.0, of_square / (2.0 * exact.1 * exact.0));
        omega.judge_order(2.0, 2.0, of_square / (2.0 * exact.1 * exact.1));
    }
}

/// Protects: below the onset the sliding oscillator has its two frequencies.
#[test]
fn below_the_onset_there_are_two_frequencies() {
    let exact = exact_modes(0.1);
    assert!((exact[0].1 - 1.036_404).abs() < 5.1e-7 && (exact[1].1 - 0.921_118).abs() < 5.1e-7, "{exact:?}");
    let distance = exact[0].1.powi(2) - exact[1].1.powi(2);
    for (mode, name) in ["upper", "lower"].into_iter().enumerate() {
        let mut omega = Evidence::new("B9", format!("{name} frequency at μ = 0.1 [rad/s]"), SOURCE);
        for dt in TIME_STEPS_S {
            omega.found(format!("Δt = {dt} s"), modes(0.1, dt)[mode].1, exact[mode].1, exact[mode].1);
        }
        // As above. Here T²/4 − D is a quarter of the squared distance of the two ω².
        omega.judge_order(2.0, 2.0, fit_rounding(TIME_STEPS_S[2]) * (1.0 + 4.0 / distance));
    }
}

/// Protects: below the onset friction neither feeds nor damps. The amplitude of a mode follows from the
/// invariant ξ_n² − 2 cos θ ξ_n ξ_{n−1} + ξ_{n−1}² = A² sin² θ of its coordinate ξ = (s c) y + (K_yy − Ω²) z
/// (left eigenvector).
#[test]
fn below_the_onset_sliding_is_neutral() {
    const DURATION_S: f64 = 2000.0;
    let (mu, (s, c)) = (0.1, direction());
    let mut growth = Evidence::new("B9", "growth rate at μ = 0.1, below the onset of flutter [1/s]", SOURCE);
    for dt in TIME_STEPS_S {
        let at_rest = steady(&oscillator(dt), mu);
        let (y, z) = slide(mu, dt, DURATION_S);
        for (mode, name) in ["upper", "lower"].into_iter().enumerate() {
            let omega = exact_modes(mu)[mode].1;
            let weight = s * s - mu * s * c - omega * omega;
            let xi = |n: usize| s * c * (y[n] - at_rest.u[Y]) + weight * (z[n] - at_rest.u[BODY_Z]);
            let cosine = 1.0 - (omega * dt).powi(2) / 2.0;
            let squared = |n: usize| xi(n).powi(2) - 2.0 * cosine * xi(n) * xi(n - 1) + xi(n - 1).powi(2);
            let last = y.len() - 1;
            let found = 0.5 * (squared(last) / squared(1)).ln() / DURATION_S;
            // ξ is rounded at the size of u, and the amplitude comes from its difference, ξωΔt. The n steps
            // of a neutral motion add up their roundings, ten per step.
            let bound = 10.0 * f64::EPSILON * 0.5 / DISTURBANCE_M * last as f64 / (omega * dt) / DURATION_S;
            growth.bounded(format!("Δt = {dt} s, {name}"), found, 0.0, 1.0, bound);
        }
    }
    growth.judge_bounded("rounding, ten a step: the scheme keeps neutral modes neutral");
}

/// Protects: the onset itself is right. (2σω)² is measured at three μ beyond it and continued to zero as a
/// quadratic function.
#[test]
fn flutter_sets_in_at_the_critical_friction() {
    let (s, c) = direction();
    let exact = 2.0 * s / c * (1.0 - (1.0 - (c / s).powi(2)).sqrt());
    assert!((exact - 0.177_72).abs() < 5.1e-6, "{exact}");
    let mut onset = Evidence::new(
        "B9",
        "friction coefficient at the onset of flutter, from measured growth",
        "μ_c = 2 tan θ (1 − √(1 − cot² θ)): T² = 4D",
    );
    let time_steps_s = TIME_STEPS_S.map(|dt| 4.0 * dt);
    for dt in time_steps_s {
        let at = [0.2, 0.3, 0.4];
        let g = at.map(|mu| {
            let (growth, omega) = modes(mu, dt)[0];
            (2.0 * growth * omega).powi(2)
        });
        // Newton's divided differences, then the root nearest to 0.2.
        let first = (g[1] - g[0]) / (at[1] - at[0]);
        let second = ((g[2] - g[1]) / (at[2] - at[1]) - first) / (at[2] - at[0]);
        let slope = first - second * (at[1] - at[0]);
        let found = at[0] - 2.0 * g[0] / (slope + (slope * slope - 4.0 * second * g[0]).sqrt());
        onset.found(format!("Δt = {dt} s"), found, exact, exact);
    }
    // Each g has an error of 4δ. The weights of the extrapolation multiply it (their sizes add up to 2 at
    // μ_c). The slope (T/2) s c ≈ 0.16 and μ_c divide it.
    onset.judge_order(2.0, 2.0, 8.0 * fit_rounding(time_steps_s[2]) / (0.16 * exact));
}

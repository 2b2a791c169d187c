//! B8 An oscillator on a moving belt, constant friction coefficient.
//!
//! A mass m is held by a spring k from the ground and pressed with N on a belt of speed V. ω = √(k/m), x_s =
//! μN/k.
//!
//! * **Started at rest**, it slips all the time if μNω/k < V. Friction is the constant μN, and x = x_s (1 −
//!   cos ωt).
//! * **Started stuck** (x = 0, velocity V), it moves with the belt until k x = μN, at t₁ = x_s/V, and then
//!   begins to slip with velocity V: x = x_s + (V/ω) sin ω(t − t₁). Its velocity V cos ω(t − t₁) touches that
//!   of the belt tangentially once a period, and it never sticks again for a finite time. **With a constant
//!   coefficient there is no stick–slip limit cycle**, and the amplitude V/ω remains.
//!
//! Source: integration of m ẍ = μN − k x (den Hartog, *Mechanical Vibrations*, 4th ed. 1956, § 7.1, discusses
//! the mechanism). A static coefficient above the kinetic one does cause stick–slip: see B17.
//!
//! **The discrete solution.** With y = x − x_s the central difference gives y_{n+1} − 2y_n + y_{n−1} = −W²
//! y_n, W = ωΔt. So the motion from rest is exactly y_n = −x_s cos θn with sin(θ/2) = W/2. The error of its
//! phase, θ/W − 1, is W²/24: second order. A slip phase that begins at y_0 = fVΔt, 0 < f ≤ 1, after a step of
//! VΔt has the amplitude
//!
//! ```text
//! A² = (V/ω)² [1 − W² f(1 − f)] / (1 − W²/4)
//! ```
//!
//! This follows from the invariant y_n² − 2 cos θ y_n y_{n−1} + y_{n−1}² = A² sin² θ. The amplitude is
//! between V/ω and (V/ω)/√(1 − W²/4). The fastest step, 2A sin(θ/2) = AW, may exceed VΔt while the middle of
//! the step is within θ/2 of the phase of greatest speed. This is one step per period, and the mass sticks in
//! it. That step ends at y ≥ 0 (it began at y ≥ −A sin θ ≥ −VΔt), so the next slip phase begins as described.
//! Therefore the bounds of the amplitude hold for ever, and the share of stick is at most θ/(2π).

use crate::verification::common::advance;
use crate::verification::evidence::Evidence;
use crate::verification::particles::{Particles, Y, Z, audited_step};
use std::f64::consts::PI;
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::{Drive, Model, State, TimeStep};

const MASS_KG: f64 = 2.0;
const STIFFNESS_N_M: f64 = 50.0;
const OMEGA: f64 = 5.0;
const MU: f64 = 0.4;
const NORMAL_N: f64 = 10.0;
const STATIC_M: f64 = MU * NORMAL_N / STIFFNESS_N_M;
const RESOLUTIONS: [f64; 3] = [0.2, 0.1, 0.05];

fn oscillator(w: f64) -> Model {
    let mut system = Particles::corners(MASS_KG);
    system.release(0, Y).release(0, Z).spring(0, 2, [0.0, 1.0, 0.0], STIFFNESS_N_M).load(0, Z, -1.0);
    system.model(0.0, TimeStep::Given(w / OMEGA))
}

fn drive(belt_speed_m_s: f64) -> Drive {
    Drive { law: Law::coulomb(MU), rate: belt_speed_m_s, force_n: NORMAL_N, ramp_s: 0.0 }
}

fn theta(w: f64) -> f64 {
    2.0 * (w / 2.0).asin()
}

/// Phase per step of the harmonic y from three neighbours, by least squares over a run.
fn measured_theta(y: &[f64]) -> f64 {
    let (mut top, mut bottom) = (0.0, 0.0);
    for n in 1..y.len() - 1 {
        top += (y[n + 1] + y[n - 1]) * y[n];
        bottom += 2.0 * y[n] * y[n];
    }
    (top / bottom).acos()
}

/// Protects: constant friction shifts the centre of a slipping oscillator and does nothing else.
#[test]
fn started_at_rest_it_oscillates_about_the_shifted_centre() {
    let mut discrete = Evidence::new(
        "B8",
        "displacement of an oscillator on a belt, started at rest, against its own difference equation [m]",
        "exact discrete solution (μN/k)(1 − cos θn), sin(θ/2) = ωΔt/2",
    );
    let mut frequency = Evidence::new(
        "B8",
        "frequency of an oscillator slipping on a belt [rad/s]",
        "x = (μN/k)(1 − cos ωt)",
    );
    let mut most_steps = 0;
    for w in RESOLUTIONS {
        let model = oscillator(w);
        let steps = (20.0 * PI / w) as usize;
        most_steps = most_steps.max(steps);
        let mut state = State::at_rest(&model);
        let (mut y, mut worst) = (vec![-STATIC_M], (0.0, 0.0, 0.0));
        for n in 1..=steps {
            advance(&model, &drive(1.1 * STATIC_M * OMEGA), &mut state, 1);
            assert_eq!(state.contacts.state_of(0, 0), ContactState::Slip, "it slips all the time");
            let exact = STATIC_M * (1.0 - (theta(w) * n as f64).cos());
            let error = (state.u[Y] - exact).abs();
            if error >= worst.0 {
                worst = (error, state.u[Y], exact);
            }
            y.push(state.u[Y] - STATIC_M);
        }
        let resolution = format!("ωΔt = {w}");
        discrete.found(&resolution, worst.1, worst.2, STATIC_M);
        frequency.found(&resolution, measured_theta(&y) * OMEGA / w, OMEGA, OMEGA);
    }
    // There are about ten roundings of u, p and the force per step. None of them grows.
    discrete.judge_exact(10.0 * most_steps as f64);
    frequency.judge_order(2.0, 2.0, 10.0 * most_steps as f64 * f64::EPSILON);
}

struct Swing {
    amplitude_m: [f64; 2],
    period_s: f64,
    stick_share: f64,
    energy_residual: f64,
    drive_work_j: f64,
    friction_j: f64,
}

const PERIODS: usize = 40;

/// Follows a mass that is started stuck over whole periods between upward crossings of the centre.
fn swing(w: f64, belt_speed_m_s: f64) -> Swing {
    let model = oscillator(w);
    let dt = model.time_step_s();
    let mut state = State::at_rest(&model);
    state.p[Y] = belt_speed_m_s;
    let mut ledger = EnergyLedger::new(&model, 1);
    let (sine, cosine) = theta(w).sin_cos();
    let (mut crossings, mut amplitude_m) = (Vec::new(), [f64::INFINITY, 0.0]);
    let (mut before, mut sticking, mut steps) = (-STATIC_M, 0, 0);
    while crossings.len() <= PERIODS {
        audited_step(&model, drive(belt_speed_m_s), &mut state, &mut ledger);
        let y = state.u[Y] - STATIC_M;
        let sticks = state.contacts.state_of(0, 0) == ContactState::Stick;
        if crossings.is_empty() {
            assert!(sticks || y > 0.0, "it is carried until friction cannot hold it");
        } else {
            steps += 1;
            sticking += usize::from(sticks);
            let invariant = y * y - 2.0 * cosine * y * before + before * before;
            let amplitude = invariant.sqrt() / sine;
            amplitude_m = [amplitude_m[0].min(amplitude), amplitude_m[1].max(amplitude)];
        }
        if before <= 0.0 && y > 0.0 {
            crossings.push((state.step as f64 - y / (y - before)) * dt);
        }
        before = y;
    }
    let energies = ledger.energies(0);
    Swing {
        amplitude_m,
        period_s: (crossings[PERIODS] - crossings[0]) / PERIODS as f64,
        stick_share: sticking as f64 / steps as f64,
        energy_residual: energies.relative_residual(),
        drive_work_j: energies.drive_work_j,
        friction_j: energies.friction_j + energies.contact_loss_j,
    }
}

/// Protects: the scheme shows no stick–slip where the law has none, and slip → stick → slip at equal
/// velocities costs no energy.
#[test]
fn started_stuck_it_touches_the_belts_speed_and_does_not_stick() {
    const TOUCH: &str = "x = μN/k + (V/ω) sin ω(t − t₁) after t₁ = μN/(kV)";
    let mut amplitude = Evidence::new(
        "B8",
        "amplitude of an oscillator on a belt, started stuck, over 40 periods [m]",
        TOUCH,
    );
    let mut share =
        Evidence::new("B8", "share of stick of an oscillator that touches the belt's speed", TOUCH);
    let mut period = Evidence::new("B8", "period of an oscillator that touches the belt's speed [s]", TOUCH);
    let mut energy = Evidence::new(
        "B8",
        "energy balance of an oscillator on a belt, relative to the energy put in",
        "work of the drive = friction + contact loss + stored energy, an identity of the scheme",
    );
    // This speed has no simple ratio to the other quantities, so the end of stick falls anywhere in a step.
    let belt_speed_m_s = 0.1234 * STATIC_M * OMEGA;
    let exact_m = belt_speed_m_s / OMEGA;
    for w in RESOLUTIONS {
        let found = swing(w, belt_speed_m_s);
        let resolution = format!("ωΔt = {w}");
        let most = 1.0 / (1.0 - w * w / 4.0).sqrt() - 1.0;
        let rounding = 10.0 * 2.0 * PI * PERIODS as f64 / w * f64::EPSILON * STATIC_M / exact_m / w;
        for (what, found_m) in [("smallest", found.amplitude_m[0]), ("largest", found.amplitude_m[1])] {
            amplitude.bounded(format!("{resolution}, {what}"), found_m, exact_m, exact_m, most + rounding);
        }
        assert!(found.amplitude_m[0] >= exact_m * (1.0 - rounding), "the amplitude does not decay");
        share.bounded(&resolution, found.stick_share, 0.0, 1.0, theta(w) / (2.0 * PI));
        period.found(&resolution, found.period_s, 2.0 * PI / OMEGA, 2.0 * PI / OMEGA);
        let steps = 2.0 * PI * PERIODS as f64 / w;
        energy.bounded(&resolution, found.energy_residual, 0.0, 1.0, steps * f64::EPSILON);
        assert!(found.drive_work_j > 0.0 && found.friction_j > 0.0);
    }
    amplitude.judge_bounded("between V/ω and (V/ω)/√(1 − W²/4): first slip step anywhere after the limit");
    share.judge_bounded("one step a period, θ/(2π)");
    period.judge_order(2.0, 2.0, 1.0e-12);
    energy.judge_bounded("one rounding a step");
}

//! B16 Frequency and growth rate of known signals by the program's own estimators.
//!
//! Problem: a total normal force N(t) of known frequency, sampled at steps Δt, goes through `CycleCutter` (two
//! low-pass filters, upward crossings of N = F, linear interpolation) and `steady::frequency_hz`. Source of the
//! answers: the signals themselves. Bounds:
//!
//! * Sinusoid. After the filters it is still a sampled sinusoid. Linear interpolation between t_0 and t_1 is
//!   off by ½x″(t − t_0)(t_1 − t) ≤ (Δt²/8)·ω²·|x|. Beside a crossing |x| ≤ aωΔt, and the slope is aω cos ωΔt
//!   or more. So a crossing is at most ω²Δt³/(8 cos ωΔt) off, and a frequency over the time T twice that over
//!   T. The order in Δt is 3.
//! * Impacts. One-step pulses fall on the step at or after their time, up to Δt late. The crossing follows
//!   its pulse at a fixed delay, because earlier pulses have decayed after a period: (1 + T/τ)e^(−T/τ) with τ
//!   = 6.4 µs is 3·10⁻⁴ of a pulse. Interpolation stays within the step. So each end is off by less than 2Δt.
//!   Half-sines have no jitter, and interpolation within a step is off by less than Δt.
//! * Decay. Under a moving window a line a e^(−λt) cos ωt changes only by the factor e^(−λt). So the
//!   logarithm of its amplitude falls with slope λ, except for the leakage of mean and image, which is less
//!   than 10⁻⁷ of it under the Kaiser window with β = 21. A regression over 7 hops t_h turns errors of 10⁻⁷
//!   into 10⁻⁷·Σ|x|/Σx²/t_h = 10⁻⁷·(12/28)/t_h at most.

use crate::verification::evidence::Evidence;
use std::f64::consts::{PI, TAU};
use tribosweep_mechanics::analysis::cycles::{Cycle, CycleCutter};
use tribosweep_mechanics::analysis::decay::DecayMonitor;
use tribosweep_mechanics::analysis::lines::ROUNDING;
use tribosweep_mechanics::analysis::sample::Sample;
use tribosweep_mechanics::analysis::steady;
use tribosweep_mechanics::solver::Model;
use tribosweep_mechanics::solver::energy::Energies;
use tribosweep_mechanics::spec::{Detection, JobSpec};

const SQUEAL_HZ: f64 = 14_500.0;
const LOAD_N: f64 = 30.0;
/// At this time the remainder of the filters' start, (1 + t/τ)e^(−t/τ), is below rounding. The start has an
/// amplitude of about F. The cutter's memory of it has fallen by e^-5 (its time constant is 0.4 ms), so that
/// an amplitude of 0.01 F is not hidden.
const START_S: f64 = 2.0e-3;

fn sample(time_s: f64, n_over_f: f64) -> Sample {
    Sample { time_s, load_n: LOAD_N, normal_n: n_over_f * LOAD_N, slip: 1, ..Sample::default() }
}

/// Frequency [Hz] of N/F = `signal` over the whole cycles between [`START_S`] and `duration_s` after it.
fn estimate_hz(step_s: f64, duration_s: f64, mut signal: impl FnMut(f64) -> f64) -> f64 {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.numerics.time_step_s = Some(step_s);
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let mut cutter = CycleCutter::new(&model, 0.0);
    let steps = ((START_S + duration_s) / step_s) as usize;
    let cycles: Vec<Cycle> = (0..steps)
        .filter_map(|n| {
            let time_s = n as f64 * step_s;
            cutter.push(&sample(time_s, signal(time_s)), &Energies::default())
        })
        .filter(|cycle| cycle.start_s > START_S)
        .collect();
    steady::frequency_hz(&cycles, 1)
}

/// The estimate furthest from the truth over 16 phases of a cycle.
fn worst_hz(estimate: impl Fn(f64) -> f64) -> f64 {
    (0..16)
        .map(|i| estimate(f64::from(i) / 16.0))
        .max_by(|a, b| (a - SQUEAL_HZ).abs().total_cmp(&(b - SQUEAL_HZ).abs()))
        .expect("sixteen phases")
}

/// Duration [s] of the whole cycles in `duration_s`, at least: a part of a cycle is cut off at either end.
fn whole_cycles_s(duration_s: f64) -> f64 {
    (duration_s * SQUEAL_HZ - 2.0).floor() / SQUEAL_HZ
}

/// Protects: the frequency of a sinusoid is right for the worst of 16 phases.
#[test]
fn sinusoid() {
    for (duration_s, name) in [(1.0e-3, "1 ms"), (5.0e-3, "5 ms")] {
        for amplitude in [0.9, 0.01] {
            let quantity = format!("sinusoid of {amplitude} F, {name}, worst frequency of 16 phases [Hz]");
            let mut evidence = Evidence::new("B16", quantity, "the signal's own frequency");
            for step_s in [1.0e-6, 5.0e-7, 2.5e-7] {
                let found = worst_hz(|phase| {
                    estimate_hz(step_s, duration_s, |t| {
                        1.0 + amplitude * (TAU * (SQUEAL_HZ * t + phase)).sin()
                    })
                });
                let omega = TAU * SQUEAL_HZ;
                let crossing_s = omega * omega * step_s.powi(3) / (8.0 * (omega * step_s).cos());
                let bound = 2.0 * crossing_s / whole_cycles_s(duration_s);
                evidence.bounded(format!("Δt = {step_s:e} s"), found, SQUEAL_HZ, SQUEAL_HZ, bound);
            }
            evidence.judge_bounded("2ω²Δt³/(8 cos ωΔt) over the time");
        }
    }
}

/// Protects: the frequency of impact-like signals, whose spectra are combs, is right for the worst of 16
/// phases.
#[test]
fn impacts() {
    let duration_s = 5.0e-3;
    let pulses = |step_s: f64, phase: f64| {
        let mut count = 0.0;
        estimate_hz(step_s, duration_s, move |t| {
            let reached = (SQUEAL_HZ * t + phase).floor();
            let pulse = reached > count;
            count = reached;
            // One step carries the impulse of the whole cycle.
            if pulse { 1.0 / (SQUEAL_HZ * step_s) } else { 0.0 }
        })
    };
    let half_sines = |step_s: f64, phase: f64| {
        estimate_hz(step_s, duration_s, |t| PI * (TAU * (SQUEAL_HZ * t + phase)).sin().max(0.0))
    };
    let case = |what: &str| {
        let quantity = format!("{what}, 5 ms, worst frequency of 16 phases [Hz]");
        Evidence::new("B16", quantity, "the signal's own frequency")
    };
    let (mut comb, mut humps) = (case("train of one-step impacts"), case("train of half-sines"));
    for step_s in [1.0e-6, 5.0e-7, 2.5e-7] {
        let name = format!("Δt = {step_s:e} s");
        let step = step_s / whole_cycles_s(duration_s);
        comb.bounded(&name, worst_hz(|phase| pulses(step_s, phase)), SQUEAL_HZ, SQUEAL_HZ, 4.0 * step);
        humps.bounded(&name, worst_hz(|phase| half_sines(step_s, phase)), SQUEAL_HZ, SQUEAL_HZ, 2.0 * step);
    }
    comb.judge_bounded("2Δt at either end: the pulses' jitter and interpolation");
    humps.judge_bounded("Δt at either end: interpolation");
}

/// Protects: the growth rate by which sliding is called stable is right.
#[test]
fn growth_rate_of_a_decaying_line() {
    let mut evidence =
        Evidence::new("B16", "growth rate of a damped line [1/s]", "the signal's own growth rate");
    for (rate, hz) in [(-50.0, SQUEAL_HZ), (-500.0, SQUEAL_HZ), (-500.0, 31_000.0), (-200.0, 90_000.0)] {
        let step_s = 8.5e-7;
        let mut monitor =
            DecayMonitor::new(step_s, 0.0, Detection::default().decay_observation_s, ROUNDING, false);
        let found = (0..).find_map(|n| {
            let t = f64::from(n) * step_s;
            let line = 0.1 * (rate * t).exp() * (TAU * hz * t).cos();
            monitor.push(&sample(t, 1.0 + line)).then(|| monitor.growth_rate_per_s())?
        });
        // An observation has sixteen hops.
        let bound = 1.0e-7 * (12.0 / 28.0) * 16.0 / Detection::default().decay_observation_s;
        evidence.bounded(format!("{hz} Hz, {rate} /s"), found.expect("a rate"), rate, 1.0, bound);
    }
    evidence.judge_bounded("leakage of the window, 10⁻⁷, over seven hops");
}

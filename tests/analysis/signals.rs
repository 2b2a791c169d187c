//! Artificial samples, a random generator with a fixed seed, and the coarse scene.

use std::f64::consts::TAU;
use tribosweep_mechanics::analysis::cycles::{Cycle, CycleCutter};
use tribosweep_mechanics::analysis::sample::Sample;
use tribosweep_mechanics::solver::Model;
use tribosweep_mechanics::solver::energy::Energies;
use tribosweep_mechanics::spec::{JobSpec, StabilityMethod};

/// The load of all artificial signals [N].
pub const LOAD_N: f64 = 30.0;
/// The paper's squeal frequency [Hz].
pub const SQUEAL_HZ: f64 = 14_500.0;
/// The reference scene's time step [s].
pub const STEP_S: f64 = 8.5e-7;

/// The coarse scene of the verification: 6 × 8 × 5 elements and a clamp of 2 mm. Every job runs.
pub fn coarse() -> JobSpec {
    let mut spec = JobSpec { stability: StabilityMethod::Simulate, ..JobSpec::default() };
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    // The regimes, decays and times of these tests are those of this damping.
    spec.numerics.beta_r_s = 5.0e-8;
    spec
}

/// The coarse scene's model with the given time step.
pub fn model(time_step_s: f64) -> Model {
    let mut spec = coarse();
    spec.numerics.time_step_s = Some(time_step_s);
    Model::from_scene(&spec.scene, &spec.numerics).unwrap()
}

/// A sample with the given N/F, T/F = 0.3 and a mixture of states.
pub fn sample(time_s: f64, n_over_f: f64) -> Sample {
    Sample {
        time_s,
        load_n: LOAD_N,
        normal_n: n_over_f * LOAD_N,
        smooth_normal_n: n_over_f * LOAD_N,
        contact_tangential_n: 0.3 * n_over_f * LOAD_N,
        clamp_tangential_n: 0.3 * LOAD_N,
        stick: 10,
        slip: 40,
        separated: 13,
        sigma_n_max_pa: 5.0e5,
        ..Sample::default()
    }
}

/// The cycles of `signal` (a sample per time) over `duration_s`.
pub fn cut(time_step_s: f64, duration_s: f64, mut signal: impl FnMut(f64) -> Sample) -> Vec<Cycle> {
    let mut cutter = CycleCutter::new(&model(time_step_s), 0.0);
    let steps = (duration_s / time_step_s) as usize;
    (0..steps).filter_map(|n| cutter.push(&signal(n as f64 * time_step_s), &Energies::default())).collect()
}

/// sin(2π f t + phase).
pub fn sine(frequency_hz: f64, time_s: f64, phase: f64) -> f64 {
    (TAU * frequency_hz * time_s + phase).sin()
}

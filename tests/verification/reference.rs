//! Agreement with an independent solver on the pin-on-disk scene.
//!
//! The numbers are from a separate throw-away implementation of the same model (6 × 8 × 5 fully
//! integrated hexahedra, clamp 2 mm at the inner side, F ramped over 1 ms, β_R = 2·10⁻⁸ s, central
//! difference, Δt = 1.75·10⁻⁶ s, statistics over the last 40 % of 20 ms), not from this program.
//!
//! The tolerances follow from the uncertainty of those numbers:
//! * The means are over a window W that begins at any phase. So the mean of a quantity that oscillates by ±a
//!   at ω may be off by a·2/(ωW). T/F oscillates about as much as N/F, whose range is known.
//! * The frequencies are lines of a spectrum over W, so they are accurate to one line, 1/W.
//! * A share of node-time may differ by the threshold of a regime (3 %), because it depends on when a node at
//!   rest to rounding counts as sticking.

use tribosweep_mechanics::analysis::{JobRecord, Outcome, Unobserved, solve};
use tribosweep_mechanics::spec::{JobSpec, StabilityMethod};

/// The independent solver's scene, which also runs if it is stable, at `omega_rpm` and μ.
fn spec(omega_rpm: f64, mu: f64) -> JobSpec {
    let mut spec = JobSpec { stability: StabilityMethod::Simulate, ..JobSpec::default() };
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.scene.disk.omega_rpm = omega_rpm;
    spec.scene.contact.mu = mu;
    spec.scene.load.ramp_s = 1.0e-3;
    spec.numerics.beta_r_s = 2.0e-8;
    spec.numerics.time_step_s = Some(1.75e-6);
    spec.run.limit_s = 0.02;
    spec.run.stop_early = false;
    spec
}

fn run(spec: &JobSpec) -> JobRecord {
    solve(spec, &mut Unobserved).unwrap()
}

/// Uncertainty of the independent solver's μ*: partial cycles in its window, and `last_digit` / 2.
fn mu_star_tolerance(record: &JobRecord, stretch_s: f64, last_digit: f64) -> f64 {
    let swing = (record.n_over_f_max - record.n_over_f_min) / 2.0;
    swing * 2.0 / (std::f64::consts::TAU * record.frequency_hz.unwrap() * stretch_s) + 0.5 * last_digit
}

/// Windows of the independent solver: 40 % of 20 ms in the table, of 10 ms in the mesh series.
const TABLE_STRETCH_S: f64 = 8.0e-3;
const MESH_STRETCH_S: f64 = 4.0e-3;

/// ω, μ*, f, stick, slip and separated share at μ = 0.4.
const TABLE: [(f64, f64, f64, [f64; 3]); 6] = [
    (0.5, 0.383, 15_780.0, [0.37, 0.61, 0.02]),
    (2.0, 0.342, 15_760.0, [0.32, 0.66, 0.02]),
    (6.0, 0.285, 15_520.0, [0.20, 0.68, 0.12]),
    (7.0, 0.288, 15_480.0, [0.17, 0.68, 0.15]),
    (35.0, 0.365, 15_480.0, [0.02, 0.59, 0.39]),
    (100.0, 0.396, 15_740.0, [0.00, 0.58, 0.42]),
];

/// Protects: μ*, frequency and shares agree over the whole range of speeds, and an early stop at the periodic
/// state does not change μ*. At 0.5 rpm this lightly damped case is quasi-periodic (the amplitude of N beats
/// by 20 % over about five cycles), so it must not be called periodic.
#[test]
fn table_over_the_speeds() {
    for (omega_rpm, mu_star, frequency_hz, shares) in TABLE {
        let full = run(&spec(omega_rpm, 0.4));
        let tolerance = mu_star_tolerance(&full, TABLE_STRETCH_S, 1e-3);
        assert!((full.mu_star - mu_star).abs() < tolerance, "{omega_rpm} rpm: μ* {}", full.mu_star);
        let frequency = full.frequency_hz.unwrap();
        assert!((frequency - frequency_hz).abs() < 1.0 / TABLE_STRETCH_S, "{omega_rpm} rpm: {frequency} Hz");
        for (found, expected) in [full.stick_share, full.slip_share, full.separated_share].iter().zip(shares)
        {
            let threshold = spec(omega_rpm, 0.4).detection.regime_threshold;
            assert!(
                (found - expected).abs() < threshold,
                "{omega_rpm} rpm: share {found} instead of {expected}"
            );
        }
        let mut early = spec(omega_rpm, 0.4);
        early.run.stop_early = true;
        let early = run(&early);
        if omega_rpm < 1.0 {
            assert_eq!(early.outcome, Outcome::NotPeriodic, "{omega_rpm} rpm");
        } else {
            assert_eq!(early.outcome, Outcome::Periodic, "{omega_rpm} rpm");
            assert!(early.simulated_s < 0.7 * full.simulated_s, "{omega_rpm} rpm: it stops early");
        }
        // In a periodic state, μ* of successive cycles agrees within this tolerance.
        let tolerance = spec(omega_rpm, 0.4).detection.tolerance * full.mu_star;
        assert!((early.mu_star - full.mu_star).abs() < tolerance, "{omega_rpm} rpm: early {}", early.mu_star);
    }
}

/// Protects: the threshold of squeal is right. At μ = 0.2 sliding decays at a measured rate, and μ* is μ less
/// the effect of the disk's curvature under the pin (⟨1 − cos ψ⟩ ≈ ⟨y²⟩/2R² = 0.11 %).
#[test]
fn low_friction_slides_stably() {
    let mut spec = spec(7.0, 0.2);
    spec.run.stop_early = true;
    let record = run(&spec);
    assert_eq!(record.outcome, Outcome::Decayed);
    assert!(record.growth_rate_per_s.unwrap() < 0.0);
    let curvature = 0.015_f64.powi(2) / 12.0 / (2.0 * 0.0914_f64.powi(2));
    assert!((record.mu_star / 0.2 - (1.0 - curvature)).abs() < 0.2 * curvature, "μ* {}", record.mu_star);
}

/// Protects: μ* converges in the time step (7 rpm), at first order or better. The limit is that of the finest
/// step and of the independent solver.
#[test]
fn time_step_series_converges() {
    let steps_s = [1.6e-6, 8.0e-7, 4.0e-7, 5.5e-8];
    let independent = [0.2900, 0.2854, 0.2837, 0.2829];
    let records: Vec<JobRecord> = steps_s
        .iter()
        .map(|&dt| {
            let mut spec = spec(7.0, 0.4);
            spec.numerics.time_step_s = Some(dt);
            run(&spec)
        })
        .collect();
    let found: Vec<f64> = records.iter().map(|record| record.mu_star).collect();
    for (record, expected) in records.iter().zip(independent) {
        let tolerance = mu_star_tolerance(record, TABLE_STRETCH_S, 1e-4);
        assert!((record.mu_star - expected).abs() < tolerance, "{found:?} instead of {independent:?}");
    }
    // Aitken's limit and order follow from the first three steps alone, each half of the one before.
    let (first, second) = (found[0] - found[1], found[1] - found[2]);
    let order = (first / second).log2();
    assert!((0.9..2.1).contains(&order), "order {order} of {found:?}");
    let limit = found[2] - second * second / (first - second);
    // The extrapolation is trusted to half of its last difference. The finest step is 7 times smaller.
    let error = (limit - found[3]).abs();
    assert!(error < 0.5 * second, "{found:?} tends to {limit}, the finest step gives {}", found[3]);
}

/// Protects: μ* converges with the mesh at constant clamp width, in agreement with the independent solver
/// (β_R = 5·10⁻⁸ s, 10 ms, 7 rpm).
#[test]
fn mesh_series_agrees() {
    for (elements, dt, mu_star, frequency_hz) in [
        ([6, 8, 5], 1.73e-6, 0.2941, 15_520.0),
        ([12, 15, 10], 8.85e-7, 0.2956, 15_480.0),
        ([18, 22, 15], 5.83e-7, 0.2947, 15_560.0),
    ] {
        let mut spec = spec(7.0, 0.4);
        spec.scene.pin.elements = elements;
        spec.numerics.beta_r_s = 5.0e-8;
        spec.numerics.time_step_s = Some(dt);
        spec.run.limit_s = 0.01;
        let record = run(&spec);
        let tolerance = mu_star_tolerance(&record, MESH_STRETCH_S, 1e-4);
        assert!((record.mu_star - mu_star).abs() < tolerance, "{elements:?}: μ* {}", record.mu_star);
        let frequency = record.frequency_hz.unwrap();
        assert!((frequency - frequency_hz).abs() < 1.0 / MESH_STRETCH_S, "{elements:?}: {frequency} Hz");
    }
}

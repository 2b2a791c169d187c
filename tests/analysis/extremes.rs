//! Short runs and extreme but legal inputs. They give a record without NaN, or a clear error.

use crate::analysis::signals::coarse;
use tribosweep_mechanics::analysis::{JobError, JobRecord, Outcome, Regime, Unobserved, solve};
use tribosweep_mechanics::solver::SolverError;
use tribosweep_mechanics::spec::{ClampSide, JobSpec, TopFace};

/// The record after a round trip through JSON. JSON would store NaN and ∞ as null, which cannot be read back.
fn finite_record(what: &str, spec: &JobSpec) -> JobRecord {
    let record = solve(spec, &mut Unobserved).unwrap_or_else(|e| panic!("{what}: {e}"));
    let json = serde_json::to_string(&record).unwrap();
    let back: JobRecord = serde_json::from_str(&json).unwrap_or_else(|e| panic!("{what}: {e} in {json}"));
    assert_eq!(back, record, "{what}");
    assert!(record.growth_rate_per_s.is_none_or(f64::is_finite), "{what}");
    assert!(record.frequency_hz.is_none_or(|f| f.is_finite() && f > 0.0), "{what}");
    let shares = record.stick_share + record.slip_share + record.separated_share;
    assert!((shares - 1.0).abs() < 1e-12, "{what}: shares sum to {shares}");
    assert!(record.window_start_s >= 0.0 && record.window_start_s <= record.simulated_s, "{what}");
    record
}

fn changed(change: impl FnOnce(&mut JobSpec)) -> JobSpec {
    let mut spec = coarse();
    spec.run.limit_s = 0.002;
    change(&mut spec);
    spec
}

/// Protects: a run that is too short to become periodic or to decay is reported as not periodic, with finite
/// figures.
#[test]
fn runs_too_short_to_settle() {
    let cases: [(&str, JobSpec); 9] = [
        ("too short", changed(|_| ())),
        ("shorter than a cycle", changed(|s| (s.run.limit_s, s.scene.load.ramp_s) = (4.0e-5, 0.0))),
        ("one step", changed(|s| (s.run.limit_s, s.scene.load.ramp_s) = (1.0e-9, 0.0))),
        ("one step of a ramp", changed(|s| (s.run.limit_s, s.scene.load.ramp_s) = (2.0e-9, 1.0e-9))),
        ("just above the ramp", changed(|s| s.run.limit_s = 1.000_001 * s.scene.load.ramp_s)),
        ("sudden load", changed(|s| s.scene.load.ramp_s = 0.0)),
        ("tiny fraction", changed(|s| s.run.average_last_fraction = 1.0e-12)),
        ("nearly all", changed(|s| s.run.average_last_fraction = 1.0 - 1.0e-12)),
        ("many cycles", changed(|s| s.detection.cycles = 10_000)),
    ];
    for (what, spec) in &cases {
        let record = finite_record(what, spec);
        assert_eq!(record.outcome, Outcome::NotPeriodic, "{what}");
    }
}

/// Protects: a run that settles in no state is averaged over its last part, which is as long as the study says.
#[test]
fn unsettled_runs_are_averaged_over_their_last_part() {
    for fraction in [0.25, 0.6] {
        let record = finite_record("unsettled", &changed(|s| s.run.average_last_fraction = fraction));
        let late_s = record.window_start_s - (1.0 - fraction) * 0.002;
        // The window begins with the first whole cycle of the last part. Steps and cycles shift it, the latter by one at
        // most.
        let cycle_s = 1.0 / record.frequency_hz.unwrap();
        assert!((-record.time_step_s..cycle_s + record.time_step_s).contains(&late_s), "{late_s}");
    }
}

/// Protects: a run that decays before the window of the last part begins, with hardly a cycle in it (strong
/// damping), still has figures. μ* is μ less the effect of the disk's curvature.
#[test]
fn decayed_runs_without_cycles() {
    for mu in [0.0, 0.1] {
        let mut spec = coarse();
        spec.scene.contact.mu = mu;
        spec.numerics.beta_r_s = 2.0e-6;
        spec.scene.pin.elements = [3, 4, 2];
        spec.scene.clamp.width_m = 0.004;
        spec.run.limit_s = 0.1;
        let record = finite_record("strongly damped", &spec);
        assert_eq!(record.outcome, Outcome::Decayed, "{record:?}");
        assert!(record.simulated_s < 0.03, "{record:?}");
        assert!((record.mu_star - mu).abs() <= 0.002 * mu + 1.0e-12, "{record:?}");
        assert_eq!((record.slip_share, record.cycles, record.frequency_hz), (1.0, 0, None));
    }
}

/// Protects: an observation that is too short to show a growth of the pin's own oscillations is refused.
/// Otherwise sliding could be called stable without evidence.
#[test]
fn an_observation_of_nothing_is_refused() {
    for observation_s in [1.0e-300, 1.0e-4, 2.4e-3] {
        let spec = changed(|s| s.detection.decay_observation_s = observation_s);
        let Err(JobError::Spec(violations)) = solve(&spec, &mut Unobserved) else {
            panic!("{observation_s:e} s is accepted")
        };
        assert_eq!(violations.0.len(), 1);
        assert_eq!(violations.0[0].field, "detection.decay_observation_s");
    }
}

/// Protects: extreme but legal inputs give a finite record, or an error that names the reason.
#[test]
fn extreme_inputs() {
    let cases: Vec<(&str, JobSpec)> = vec![
        ("frictionless", changed(|s| s.scene.contact.mu = 0.0)),
        ("μ = 2", changed(|s| s.scene.contact.mu = 2.0)),
        ("μ = 50", changed(|s| s.scene.contact.mu = 50.0)),
        ("1e-3 rpm", changed(|s| s.scene.disk.omega_rpm = 1.0e-3)),
        ("1e4 rpm", changed(|s| s.scene.disk.omega_rpm = 1.0e4)),
        ("1e-6 N", changed(|s| s.scene.load.force_n = 1.0e-6)),
        ("1e6 N", changed(|s| s.scene.load.force_n = 1.0e6)),
        ("nearly incompressible", changed(|s| s.scene.pin.poisson_ratio = 0.499)),
        ("auxetic", changed(|s| s.scene.pin.poisson_ratio = -0.9)),
        (
            "one element",
            changed(|s| {
                s.scene.pin.elements = [1, 1, 1];
                s.scene.clamp.side = ClampSide::WholeTop;
            }),
        ),
        (
            "one element, free top, no friction",
            changed(|s| {
                s.scene.pin.elements = [1, 1, 1];
                s.scene.clamp.side = ClampSide::WholeTop;
                s.scene.top = TopFace::FreeInZ;
                s.scene.contact.mu = 0.0;
                s.run.limit_s = 0.05;
            }),
        ),
        ("β₂ = 1", changed(|s| s.numerics.beta2 = 1.0)),
        ("undamped", changed(|s| s.numerics.beta_r_s = 0.0)),
        (
            "hugely overdamped",
            changed(|s| {
                s.scene.pin.elements = [3, 4, 2];
                s.scene.clamp.width_m = 0.004;
                s.numerics.beta_r_s = 1.0e-3;
                s.run.limit_s = 6.0e-4;
            }),
        ),
        ("free top", changed(|s| s.scene.top = TopFace::FreeInZ)),
        ("both ends held", changed(|s| s.scene.clamp.side = ClampSide::BothEnds)),
        ("endless observation", changed(|s| s.detection.decay_observation_s = 1.0e300)),
        (
            "loosest detection",
            changed(|s| {
                (s.detection.cycles, s.detection.tolerance, s.detection.drift_tolerance) = (2, 0.99, 0.99);
            }),
        ),
        ("everything is a regime", changed(|s| s.detection.regime_threshold = 0.0)),
    ];
    for (what, spec) in &cases {
        match solve(spec, &mut Unobserved) {
            Ok(_) => {
                finite_record(what, spec);
            }
            Err(JobError::Solver(SolverError::ClampOffMesh { .. })) if *what == "both ends held" => (),
            Err(error) => panic!("{what}: {error}"),
        }
    }
}

/// Protects: an instability that is odd across a symmetrically clamped pin is not called stable, although the
/// total normal force does not show it. The sideways motion of this job grows from 9 ms on.
#[test]
fn an_odd_instability_is_not_stable() {
    let spec = changed(|s| {
        s.scene.clamp.side = ClampSide::BothSides;
        s.scene.contact.mu = 0.25;
        s.scene.disk.omega_rpm = 10.0;
        s.scene.pin.poisson_ratio = 0.0;
        s.run.limit_s = 0.02;
    });
    assert_ne!(finite_record("odd mode", &spec).outcome, Outcome::Decayed);
}

/// Protects: steady sliding with a corner that stays lifted is linear, too. Its decay is measured, and it is
/// called stable, not squeal.
#[test]
fn a_lifted_corner_may_be_stable() {
    let spec = changed(|s| {
        s.scene.contact.mu = 0.5;
        s.numerics.beta_r_s = 5.0e-6;
        s.run.limit_s = 0.03;
    });
    let record = finite_record("lifted corner", &spec);
    assert_eq!((record.outcome, record.regime), (Outcome::Decayed, Regime::Stable), "{record:?}");
    assert!(record.separated_share > 0.01 && record.stick_share == 0.0, "{record:?}");
    assert!(record.growth_rate_per_s.unwrap() < 0.0);
}

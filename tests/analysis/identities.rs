//! The identities and the early stop in real, but coarse runs.

use crate::analysis::signals::coarse;
use tribosweep_mechanics::analysis::{JobRecord, Outcome, Unobserved, solve};
use tribosweep_mechanics::spec::JobSpec;

fn spec(omega_rpm: f64, mu: f64) -> JobSpec {
    let mut spec = coarse();
    spec.scene.disk.omega_rpm = omega_rpm;
    spec.scene.contact.mu = mu;
    spec.run.limit_s = 0.04;
    spec
}

/// Largest error of an average over a window, in units of T/F. Over the window the pin's momentum changes by
/// at most two contributions. (a) The tolerance of the periodic state allows `tolerance` × aF/ω, where a is
/// half the range of N/F and ω the cycle's angular frequency (all of aF/ω if the run is not periodic). (b)
/// The ends of a cycle are resolved to a step, which allows half a step of the force at each end. N
/// enters with the factor μ, T with the factor 1.
fn averaging_error(spec: &JobSpec, record: &JobRecord) -> f64 {
    let duration_s = record.simulated_s - record.window_start_s;
    let half_range = (record.n_over_f_max - record.n_over_f_min) / 2.0;
    let share = if record.outcome == Outcome::Periodic { spec.detection.tolerance } else { 1.0 };
    let momentum_s = record.frequency_hz.map_or(0.0, |f| share * half_range / (std::f64::consts::TAU * f));
    (1.0 + spec.scene.contact.mu) * (momentum_s + record.time_step_s * half_range) / duration_s + 1e-9
}

fn check(spec: &JobSpec, record: &JobRecord) {
    let what = format!("{} rpm, μ = {}: {record:#?}", spec.scene.disk.omega_rpm, spec.scene.contact.mu);
    let error = averaging_error(spec, record);
    assert!(error < 0.005, "a bound of {error} says nothing; {what}");
    assert!(record.macroscopic_identity_residual.abs() < error, "bound {error}; {what}");
    let n_over_f = 1.0 + error;
    assert!((record.mu_star_contact - record.mu_star).abs() < error * n_over_f, "bound {error}; {what}");
    let reduction = record.mu_reduction_stick + record.mu_reduction_slip;
    assert!((spec.scene.contact.mu - record.mu_star - reduction).abs() < error, "bound {error}; {what}");
    let shares = record.stick_share + record.slip_share + record.separated_share;
    assert!((shares - 1.0).abs() < 1e-12, "{what}");
    // The ledger closes to rounding except for the damping's work, which is a sum over every 16th step: some
    // 100 samples in 20 cycles. The power varies by its own size, so the sum has an error of 10 %. Twice that
    // is allowed.
    let damping = record.energy.damping_j / record.energy.drive_work_j;
    assert!(record.energy_identity_residual.abs() < 0.2 * damping + 1e-9, "damping {damping}; {what}");
    assert!(record.energy_residual < 0.2 * damping + 1e-9, "damping {damping}; {what}");
}

/// Protects: both identities hold, and μ* from the contact forces agrees. An early stop at the periodic state
/// (or at a decay) does not change the result: μ* is within 0.003 and the frequency within 0.2 % of the
/// values from the last 40 % of a run of 40 ms.
#[test]
fn identities_hold_and_stopping_early_changes_nothing() {
    for (omega_rpm, mu) in [
        (2.0, 0.4),
        (7.0, 0.4),
        (35.0, 0.4),
        (7.0, 0.3),
        (7.0, 0.35),
        (7.0, 0.5),
        (7.0, 0.6),
        (20.0, 0.6),
        (7.0, 0.1),
    ] {
        let early_spec = spec(omega_rpm, mu);
        let early = solve(&early_spec, &mut Unobserved).unwrap();
        check(&early_spec, &early);
        let mut full_spec = early_spec.clone();
        full_spec.run.stop_early = false;
        let full = solve(&full_spec, &mut Unobserved).unwrap();
        check(&full_spec, &full);
        let what = format!("{omega_rpm} rpm, μ = {mu}: {early:#?} {full:#?}");
        assert!((early.mu_star - full.mu_star).abs() < 0.003, "{what}");
        assert_eq!(early.outcome == Outcome::Decayed, full.outcome == Outcome::Decayed, "{what}");
        if let (Some(a), Some(b)) = (early.frequency_hz, full.frequency_hz) {
            assert!((a / b - 1.0).abs() < 0.002, "{what}");
        }
        assert_eq!(early.frequency_hz.is_some(), full.frequency_hz.is_some(), "{what}");
    }
}

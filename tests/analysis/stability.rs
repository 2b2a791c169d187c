//! Eigenvalues of steady sliding beside a run.

use super::signals::coarse;
use std::sync::Arc;
use tribosweep::analysis::lanes::Lanes;
use tribosweep::analysis::{ComplexMode, JobRecord, Outcome, SlidingStability, Unobserved, solve};
use tribosweep::solver::Model;
use tribosweep::spec::{JobSpec, StabilityMethod};

fn short(method: StabilityMethod) -> JobSpec {
    let mut spec = JobSpec { stability: method, ..coarse() };
    spec.run.limit_s = 0.002;
    spec
}

fn eigenvalues() -> SlidingStability {
    let mode = ComplexMode {
        frequency_hz: 1.5e4,
        growth_rate_per_s: 120.0,
        damping_ratio: -1.3e-3,
        residual: 1e-9,
        is_converged: true,
    };
    SlidingStability {
        decided: false,
        contact_nodes: 60,
        lifted_nodes: 3,
        mu_star: 0.4,
        band_hz: 5e4,
        modes: vec![mode],
    }
}

/// Protects: a job that runs has its eigenvalues in its record, also if it is continued from a checkpoint by a program that
/// did not compute them. Nothing else in the record depends on them.
#[test]
fn a_checkpoint_carries_the_eigenvalues() {
    let spec = short(StabilityMethod::Simulate);
    let model = Arc::new(Model::from_scene(&spec.scene, &spec.numerics).unwrap());
    let finish = |lanes: &mut Lanes<1>| -> JobRecord {
        loop {
            if let Some(ended) = lanes.advance(&mut |_| {}).pop() {
                return ended.result.unwrap();
            }
        }
    };
    let mut lanes = Lanes::<1>::new(Arc::clone(&model));
    lanes.begin(0, 7, spec.clone()).unwrap();
    lanes.note(0, eigenvalues());
    lanes.advance(&mut |_| {});
    let checkpoint = lanes.checkpoint(7).unwrap();
    let whole = finish(&mut lanes);
    assert_eq!(whole.stability, Some(eigenvalues()));
    let mut other = Lanes::<1>::new(model);
    other.resume(0, 1, spec.clone(), &checkpoint).unwrap();
    assert_eq!(finish(&mut other), whole);
    let plain = solve(&spec, &mut Unobserved).unwrap();
    assert_eq!(plain, JobRecord { stability: None, ..whole });
}

/// Protects: a job that must run to its limit runs, and so does one whose method is the run, with the same bits.
#[test]
fn some_jobs_always_run() {
    let mut records = Vec::new();
    for method in [StabilityMethod::Simulate, StabilityMethod::Eigenvalues] {
        let mut spec = short(method);
        spec.run.stop_early = false;
        let record = solve(&spec, &mut Unobserved).unwrap();
        assert!(record.steps > 0 && record.outcome == Outcome::NotPeriodic, "{record:?}");
        assert_eq!(record.stability, None);
        records.push(record);
    }
    assert_eq!(records[0], records[1]);
}

//! The energy balance of the scheme: kinetic + elastic = work of load and drive − friction − damping −
//! contact loss, exactly (see `solver::energy`), and what sampling it costs.

use tribosweep::solver::energy::EnergyLedger;
use tribosweep::solver::{Drive, Model, State, step};
use tribosweep::spec::{JobSpec, TopFace};

/// A small reference scene that sticks, slips and separates within a millisecond.
fn spec() -> JobSpec {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.scene.load.ramp_s = 1.0e-4;
    spec
}

fn run(spec: &JobSpec, interval: u64) -> (EnergyLedger<1>, u64) {
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let drives = [Drive { mu: 0.5, rate: 1.2, force_n: 30.0, ramp_s: spec.scene.load.ramp_s }];
    let mut state = State::at_rest(&model);
    let mut ledger = EnergyLedger::new(&model, interval);
    let steps = 3000;
    for _ in 0..steps {
        ledger.before_step(&model, &state);
        step(&model, &drives, &mut state);
        ledger.after_step(&model, &drives, &state);
    }
    (ledger, steps)
}

/// Protects: every term of the balance, for every integrator and damping: audited at each step it
/// closes to rounding. A wrong force, work or dissipation anywhere would leave a residual.
#[test]
fn closes_to_rounding_when_every_step_is_audited() {
    for beta2 in [0.5, 0.6, 1.0] {
        for beta_r_s in [0.0, 5.0e-8] {
            for top in [TopFace::TiedInZ, TopFace::FreeInZ] {
                let mut spec = spec();
                spec.numerics.beta2 = beta2;
                spec.numerics.beta_r_s = beta_r_s;
                spec.scene.top = top;
                let (ledger, steps) = run(&spec, 1);
                let energies = ledger.energies(0);
                let bound = f64::EPSILON * steps as f64;
                let residual = energies.relative_residual();
                assert!(residual < bound, "β₂ = {beta2}, β_R = {beta_r_s}: {residual:e}: {energies:?}");
                assert!(energies.friction_j > 0.0 && energies.contact_loss_j > 0.0, "{energies:?}");
                assert_eq!(energies.damping_j > 0.0, beta2 > 0.5 || beta_r_s > 0.0, "{energies:?}");
            }
        }
    }
}

/// Protects: sampling changes the damping's work only within its sampling error, and nothing else.
#[test]
fn sampling_touches_only_the_damping() {
    let (every, _) = run(&spec(), 1);
    let (sampled, _) = run(&spec(), 16);
    // The last audits are at different steps, so compare the balance, not the terms.
    let damping = every.energies(0).damping_j;
    let imbalance = sampled.energies(0).imbalance_j().abs();
    assert!(imbalance < 0.1 * damping, "imbalance {imbalance:e} J, damping {damping:e} J");
}

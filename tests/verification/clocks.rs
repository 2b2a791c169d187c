//! R4 Two clocks: energy and accuracy of the disk's stages.
//!
//! With m stages the disk is a body of the same stiffness and the mass M B⁻¹ in the central difference of the pin's
//! step (`solver::disk::stages`), so the energies of both bodies balance exactly; and its error is of second order in
//! the step, while the contact's is of first order.

use crate::common::{ROUNDINGS_PER_FORCE, advance};
use crate::elastic::{coarse_scene, drive};
use crate::evidence::Evidence;
use tribosweep::solver::energy::EnergyLedger;
use tribosweep::solver::{Model, State};
use tribosweep::spec::{Clock, JobSpec, TargetSurface};

const KRENK: &str = "energy balance of Newmark's method (Krenk 2006)";

fn model(spec: &JobSpec) -> Model {
    Model::from_scene(&spec.scene, &spec.numerics).unwrap()
}

/// Protects: over 20 ms of squeal with several stages a step the energies of pin and disk close to rounding when they
/// are looked at in every step; with bilinear patches and smooth ones.
#[test]
fn energies_close_with_stages() {
    let mut evidence = Evidence::new("R4", "imbalance over the energy put in, 20 ms", KRENK);
    let mut most_steps = 0.0_f64;
    for target in [TargetSurface::Bilinear, TargetSurface::Ferguson] {
        let mut spec = coarse_scene();
        spec.scene.disk.ring.target = target;
        let model = model(&spec);
        assert!(model.disk().unwrap().stages().count() > 1);
        let drive = drive(0.4, 7.0);
        let mut state = State::<1>::at_rest(&model);
        let mut ledger = EnergyLedger::new(&model, 1);
        let steps = (0.02 / model.time_step_s()) as usize;
        for _ in 0..steps {
            ledger.before_step(&model, &state);
            advance(&model, &drive, &mut state, 1);
            ledger.after_step(&model, &[drive], &state);
        }
        let energies = ledger.energies(0);
        assert!(
            energies.friction_j > 0.5 * energies.input_j() && energies.contact_loss_j > 0.0,
            "{energies:?}"
        );
        evidence.found(format!("{target:?}"), energies.imbalance_j(), 0.0, energies.input_j());
        most_steps = most_steps.max(steps as f64);
    }
    // Every step adds works of forces, each rounded as a row of K u is.
    evidence.judge_exact(ROUNDINGS_PER_FORCE * most_steps);
}

/// Protects: what the stages change is small against what the step itself changes, and vanishes with it: the pin's
/// displacements after 0.3 ms of the ramp, against one stage at the same step and against a four times finer step.
#[test]
fn stages_change_less_than_the_step_does() {
    let run = |clock: Clock, time_step_s: f64| {
        let mut spec = coarse_scene();
        spec.scene.disk.ring.clock = clock;
        spec.numerics.time_step_s = Some(time_step_s);
        let model = model(&spec);
        let mut state = State::<1>::at_rest(&model);
        advance(&model, &drive(0.4, 7.0), &mut state, (3.0e-4 / time_step_s).round() as usize);
        (state.u.values().collect::<Vec<_>>(), model.disk().unwrap().stages().count())
    };
    let distance = |a: &[f64], b: &[f64]| {
        let size = b.iter().map(|v| v * v).sum::<f64>().sqrt();
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt() / size
    };
    let own = {
        let mut spec = coarse_scene();
        spec.scene.disk.ring.clock = Clock::Own;
        model(&spec).time_step_s()
    };
    // Rounded so that the steps end at the same time.
    let step = 3.0e-4 / (3.0e-4 / own).ceil();
    let (two_clocks, stages) = run(Clock::Own, step);
    assert!(stages > 1);
    let (fine, one) = run(Clock::Common, step / 8.0);
    assert_eq!(one, 1);
    let (fine_with_clocks, _) = run(Clock::Own, step / 2.0);
    let (coarse_error, finer_error) = (distance(&two_clocks, &fine), distance(&fine_with_clocks, &fine));
    println!("{coarse_error} {finer_error}");
    assert!(finer_error < 0.75 * coarse_error);
}

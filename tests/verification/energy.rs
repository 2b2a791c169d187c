//! B15 The energy balance of the scheme, and the error of sampling it.
//!
//! In every step kinetic + elastic = work of load and drive − friction − damping − contact loss, exactly (S.
//! Krenk, *Energy conservation in Newmark based time integration algorithms*, CMAME 195, 2006, with β = 0;
//! see `solver::energy`).

use crate::verification::common::ROUNDINGS_PER_FORCE;
use crate::verification::evidence::Evidence;
use tribosweep_mechanics::solver::body::pin::Stiffness;
use tribosweep_mechanics::solver::body::pin::{BlockMesh, PinMesh};
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::interface::target;
use tribosweep_mechanics::solver::interface::target::TargetDefinition;
use tribosweep_mechanics::solver::support::clamp;
use tribosweep_mechanics::solver::support::load;
use tribosweep_mechanics::solver::{
    Drive, InLanes, Model, ModelDefinition, SolverError, State, StateOf, TimeStep, guard, material::Material,
    step,
};
use tribosweep_mechanics::spec::{Clamp, Holder, JobSpec, TopFace};

/// A small reference scene that sticks, slips and separates within a millisecond.
fn spec() -> JobSpec {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.scene.load.ramp_s = 1.0e-4;
    spec
}

fn run(spec: &JobSpec, interval: u64) -> (EnergyLedger<1>, u64) {
    run_in(spec, interval)
}

/// The same run with fields of the number type `R`.
fn run_in<R: InLanes<1>>(spec: &JobSpec, interval: u64) -> (EnergyLedger<1, R>, u64) {
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let drives = [Drive { law: Law::coulomb(0.5), rate: 1.2, force_n: 30.0, ramp_s: spec.scene.load.ramp_s }];
    let mut state = StateOf::at_rest(&model);
    let mut ledger = EnergyLedger::new(&model, interval);
    let steps = 3000;
    for _ in 0..steps {
        ledger.before_step(&model, &state);
        step(&model, &drives, &mut state);
        ledger.after_step(&model, &drives, &state);
    }
    (ledger, steps)
}

/// Protects: every term of the balance is right, for every integrator and damping. With an audit at each step
/// the balance closes to rounding. A wrong force, work or dissipation would leave a residual.
#[test]
fn closes_to_rounding_when_every_step_is_audited() {
    let mut evidence = Evidence::new(
        "B15",
        "coarse pin, 3000 steps, imbalance of energies over the input",
        "energy balance of Newmark's method (Krenk 2006)",
    );
    let mut most_steps: f64 = 0.0;
    for beta2 in [0.5, 0.6, 1.0] {
        for (beta_r_s, alpha_r_per_s) in [(0.0, 0.0), (5.0e-8, 0.0), (0.0, 3.0e3), (5.0e-8, 3.0e3)] {
            for top in [TopFace::TiedInZ, TopFace::FreeInZ] {
                let mut spec = spec();
                spec.numerics.beta2 = beta2;
                spec.numerics.beta_r_s = beta_r_s;
                spec.numerics.alpha_r_per_s = Some(alpha_r_per_s);
                spec.scene.top = top;
                let (ledger, steps) = run(&spec, 1);
                let energies = ledger.energies(0);
                most_steps = most_steps.max(steps as f64);
                let alpha =
                    if alpha_r_per_s > 0.0 { format!("α_R = {alpha_r_per_s} 1/s, ") } else { String::new() };
                let name = format!("β₂ = {beta2}, {alpha}β_R = {beta_r_s} s, {top:?}");
                evidence.found(name, energies.imbalance_j() / energies.input_j(), 0.0, 1.0);
                assert!(energies.friction_j > 0.0 && energies.contact_loss_j > 0.0, "{energies:?}");
                let is_damped = beta2 > 0.5 || beta_r_s > 0.0 || alpha_r_per_s > 0.0;
                assert_eq!(energies.damping_j > 0.0, is_damped, "{energies:?}");
            }
        }
    }
    // Every step adds works of forces. Each force is rounded like a row of K u.
    evidence.judge_exact(ROUNDINGS_PER_FORCE * most_steps);
}

/// Protects: the balance in single precision. Each step rounds every force like a row of K u, in f32, and independent roundings
/// add up like the root of their number. The works and energies are summed in f64, so that no rounding of a sum remains.
#[test]
fn closes_to_rounding_in_single_precision() {
    for beta2 in [0.5, 0.6] {
        for (beta_r_s, alpha_r_per_s) in [(0.0, 0.0), (5.0e-8, 0.0), (5.0e-8, 3.0e3)] {
            let mut spec = spec();
            spec.numerics.beta2 = beta2;
            spec.numerics.beta_r_s = beta_r_s;
            spec.numerics.alpha_r_per_s = Some(alpha_r_per_s);
            let (ledger, steps) = run_in::<f32>(&spec, 1);
            let residual = ledger.energies(0).relative_residual();
            let bound = (ROUNDINGS_PER_FORCE * steps as f64).sqrt() * f64::from(f32::EPSILON);
            println!("β₂ = {beta2}, β_R = {beta_r_s} s: {residual:.1e} of {bound:.1e}");
            assert!(residual < bound, "β₂ = {beta2}, β_R = {beta_r_s} s: {residual:e} of {bound:e}");
        }
    }
}

/// Protects: the balance with a speed and a load that change in every step, by steps and by ramps, for every integrator and in
/// both precisions. The work of the drive over an increment takes the speed of that step.
#[test]
fn closes_to_rounding_when_speed_and_load_change() {
    fn residual<R: InLanes<1>>(beta2: f64) -> f64 {
        let mut spec = spec();
        spec.numerics.beta2 = beta2;
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let mut state = StateOf::<1, R>::at_rest(&model);
        let mut ledger = EnergyLedger::<1, R>::new(&model, 1);
        for n in 0..CHANGING_STEPS {
            let up_and_down = 1.0 - (n as f64 / (0.5 * CHANGING_STEPS as f64) - 1.0).abs();
            let force_n = if n % 500 < 250 { 30.0 } else { 10.0 + 30.0 * up_and_down };
            let drives = [Drive { law: Law::coulomb(0.5), rate: 3.0 * up_and_down, force_n, ramp_s: 1.0e-4 }];
            ledger.before_step(&model, &state);
            step(&model, &drives, &mut state);
            ledger.after_step(&model, &drives, &state);
        }
        let energies = ledger.energies(0);
        assert!(energies.friction_j > 0.0 && energies.contact_loss_j > 0.0, "{energies:?}");
        energies.relative_residual()
    }
    for beta2 in [0.5, 0.6, 1.0] {
        // As in the tests above: every step adds works of forces, each of which is rounded like a row of K u.
        let roundings = ROUNDINGS_PER_FORCE * CHANGING_STEPS as f64;
        let bounds = [roundings * f64::EPSILON, roundings.sqrt() * f64::from(f32::EPSILON)];
        for (found, bound) in [residual::<f64>(beta2), residual::<f32>(beta2)].into_iter().zip(bounds) {
            println!("β₂ = {beta2}: {found:.1e} of {bound:.1e}");
            assert!(found < bound, "β₂ = {beta2}: {found:e} of {bound:e}");
        }
    }
}

const CHANGING_STEPS: u64 = 3000;

/// Protects: sampling changes the damping's work only within its sampling error, and nothing else. The power
/// of damping is positive and varies by its own size in every cycle. If n samples were as bad as random ones,
/// their sum would have a relative error of 1/√n, and seldom more than three times that.
#[test]
fn sampling_touches_only_the_damping() {
    let mut evidence = Evidence::new(
        "B15",
        "coarse pin, 3000 steps, imbalance by sampling over the damping's work",
        "energy balance of Newmark's method (Krenk 2006)",
    );
    for interval in [64, 16, 4] {
        let (ledger, steps) = run(&spec(), interval);
        let energies = ledger.energies(0);
        let name = format!("every {interval} steps");
        let bound = 3.0 / ((steps / interval) as f64).sqrt();
        evidence.bounded(name, energies.imbalance_j() / energies.damping_j, 0.0, 1.0, bound);
    }
    evidence.judge_bounded("three standard errors of the samples of a power that swings by its own size");
}

/// The reference pin on a coarse mesh at a fraction of the stability limit, which is not checked.
fn beyond_the_limit(fraction: f64) -> Model {
    let mesh = PinMesh::from(BlockMesh::new([0.012, 0.015, 0.010], [6, 8, 5]));
    let strip = clamp::clamped_strip(&mesh, &Clamp { width_m: 0.002, ..Clamp::default() }).unwrap();
    let definition = ModelDefinition {
        materials: vec![Material { young_modulus_pa: 1.0e9, poisson_ratio: 0.3, density_kg_m3: 2500.0 }],
        stiffness: Stiffness::Elastic,
        supports: clamp::supports(&mesh, &strip, TopFace::TiedInZ, &Holder::default()),
        load: load::normal_load(&mesh),
        target: TargetDefinition::Rigid(target::rotating_disk(&mesh, 0.0914)),
        beta2: 0.5,
        beta_r_s: 5.0e-8,
        alpha_r_per_s: 0.0,
        time_step: TimeStep::FractionOfLimit(1.0),
        mesh,
    };
    let limit_s = Model::new(definition.clone()).unwrap().time_step_limit_s();
    let time_step = TimeStep::Unchecked(fraction * limit_s);
    Model::new(ModelDefinition { time_step, ..definition }).unwrap()
}

/// Runs with the guard as a job does. Returns the guard's error, if the guard stops the run.
fn guarded(model: &Model, steps: u64) -> Result<(), SolverError> {
    let drive = Drive { law: Law::coulomb(0.4), rate: 0.733, force_n: 30.0, ramp_s: 5.0e-4 };
    let mut state = State::<1>::at_rest(model);
    let mut ledger = EnergyLedger::new(model, 16);
    for n in 0..steps {
        ledger.before_step(model, &state);
        step(model, &[drive], &mut state);
        ledger.after_step(model, &[drive], &state);
        if ledger.audits(n) {
            guard::check(model, &drive, &state, 0, ledger.energies(0))?;
        }
    }
    Ok(())
}

/// Protects: a run that diverges is stopped long before its numbers overflow, with step, time, node and the
/// likely cause. A run at the limit is not stopped. (The bound of ω_max is up to a few percent above the true
/// one, so only a step that is larger by as much lets anything grow.)
#[test]
fn divergence_is_noticed_and_explained() {
    guarded(&beyond_the_limit(1.0), 20_000).unwrap();
    let error = guarded(&beyond_the_limit(1.15), 20_000).unwrap_err();
    let SolverError::Diverged { step, time_s, node, what, cause, .. } = &error else { panic!("{error}") };
    let model = beyond_the_limit(1.15);
    assert_eq!(*time_s, *step as f64 * model.time_step_s());
    assert!(*node < model.mesh().block().unwrap().node_count());
    assert!(what.contains("stored energy"), "noticed by its energy, before anything overflows: {what}");
    assert!(cause.contains("1.1500 of the stability limit"), "{cause}");
}

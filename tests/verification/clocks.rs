//! R4 Two clocks: energy and accuracy of the disk's stages.
//!
//! With m stages the disk is a body of the same stiffness and the mass M B⁻¹ in the central difference of the pin's
//! step (`solver::disk::stages`), so the energies of both bodies balance exactly; and its error is of second order in
//! the step, while the contact's is of first order.

use crate::common::{ROUNDINGS_PER_FORCE, advance};
use crate::elastic::{coarse_scene, drive};
use crate::evidence::Evidence;
use tribosweep::solver::energy::EnergyLedger;
use tribosweep::solver::{Model, State, guard};
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
    // First order in the step, as the contact's closing is.
    assert!(finer_error < 0.75 * coarse_error, "{coarse_error} {finer_error}");
    // One stage and several at the same step.
    let (one_clock, single) = run(Clock::Common, step / 4.0);
    let (several, many) = run(Clock::Own, step / 4.0);
    assert!(single == 1 && many == 1);
    assert_eq!(one_clock, several, "with one stage both clocks are the same");
}

/// Protects: with no damping at all, over tens of thousands of steps of a shaken pin that bounces on the disk, for every
/// number of stages and disks from softer than the pin to much stiffer, nothing grows: a frictionless contact force N takes
/// N g_{n−1}/2 ≥ 0, so what is stored is at most what was put in. (Clocks that exchange held forces grow by a percent a step
/// where a multiple of the longer step is in resonance with the finer mesh.)
#[test]
fn nothing_grows_without_damping() {
    let mut seen = std::collections::BTreeSet::new();
    let mut evidence = Evidence::new("R4", "undamped, frictionless, stored energy above what was put in", KRENK);
    for (young_modulus_pa, density_kg_m3) in
        [(3.0e8, 2500.0), (1.0e10, 7800.0), (9.0e10, 7800.0), (2.1e11, 7800.0), (3.5e11, 7800.0)]
    {
        let mut spec = coarse_scene();
        spec.numerics.beta_r_s = 0.0;
        spec.numerics.safety_factor = 0.95;
        spec.scene.disk.ring.young_modulus_pa = young_modulus_pa;
        spec.scene.disk.ring.density_kg_m3 = density_kg_m3;
        let model = model(&spec);
        let stages = model.disk().unwrap().stages().count();
        seen.insert(stages);
        let drive = tribosweep::solver::Drive { mu: 0.0, rate: 0.7, force_n: 30.0, ramp_s: 0.0 };
        let mut state = State::<1>::at_rest(&model);
        for dof in 0..state.p.len() {
            // Any rough pattern; its size is that of the squeal's velocities.
            state.p[dof] = 0.1 * (((dof * 7919) % 101) as f64 / 50.0 - 1.0);
        }
        for &dof in &clamped(&spec) {
            state.p[dof] = 0.0;
        }
        let mut ledger = EnergyLedger::new(&model, 1);
        let mut worst = 0.0_f64;
        let steps = 20_000;
        for _ in 0..steps {
            ledger.before_step(&model, &state);
            advance(&model, &drive, &mut state, 1);
            ledger.after_step(&model, &[drive], &state);
            let energies = ledger.energies(0);
            let input = energies.initial_j + energies.load_work_j + energies.drive_work_j;
            worst = worst.max((energies.kinetic_j + energies.elastic_j - input) / energies.input_j());
        }
        let name = format!("{stages} stages, E = {young_modulus_pa:.1e} Pa");
        evidence.bounded(name, worst, 0.0, 1.0, ROUNDINGS_PER_FORCE * f64::from(steps) * f64::EPSILON);
    }
    assert!(seen.contains(&1) && seen.contains(&4) && seen.len() >= 3, "{seen:?}");
    evidence.judge_bounded("energy balance, and contact that only takes; each step rounds as a row of K u");
}

/// Degrees of freedom that the scene holds or ties, whose velocities are not free to be chosen.
fn clamped(spec: &JobSpec) -> Vec<usize> {
    let mesh = tribosweep::solver::mesh::BlockMesh::new(spec.scene.pin.size_m, spec.scene.pin.elements);
    mesh.top_nodes().flat_map(|node| [3 * node, 3 * node + 1, 3 * node + 2]).collect()
}

/// Protects: a contact solve that does not converge ends the job with an error that says when and by how much.
#[test]
fn a_solve_that_fails_is_an_error() {
    let model = model(&coarse_scene());
    let mut state = State::<1>::at_rest(&model);
    guard::check_contact(&model, &state, 0).unwrap();
    let solves = &mut state.contacts.elastic.as_mut().unwrap().solves[0];
    (solves.failed_step, solves.residual) = (12.0, 0.25);
    let message = guard::check_contact(&model, &state, 0).unwrap_err().to_string();
    for part in ["step 12", "did not converge", "2.5e-1", "500 sweeps"] {
        assert!(message.contains(part), "{part} is not in {message}");
    }
}

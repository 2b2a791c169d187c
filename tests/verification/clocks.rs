//! R4 Two clocks: energy and accuracy of the disk's stages.
//!
//! With m stages per step of the pin, the disk acts in the central difference of the pin's step as a body of
//! the same stiffness and the mass M B⁻¹ (`solver::body::ring::stages`). So the energies of both bodies
//! balance exactly. The error of the stages is of second order in the step, while that of the contact is of
//! first order.

use crate::verification::common::{ROUNDINGS_PER_FORCE, advance};
use crate::verification::elastic::{coarse_scene, drive};
use crate::verification::evidence::Evidence;
use tribosweep_mechanics::analysis::{JobError, Unobserved, solve};
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::{Drive, Model, SolverError, State};
use tribosweep_mechanics::spec::{DiskKind, DiskTimeStep, JobSpec, TargetSurface};

const SPAN_S: f64 = 3.0e-4;
const ONE_CLOCK: &str = "one clock with a sixteenth of the step";
const KRENK: &str = "energy balance of Newmark's method (Krenk 2006)";

fn model(spec: &JobSpec) -> Model {
    Model::from_scene(&spec.scene, &spec.numerics).unwrap()
}

/// Protects: the energies of pin and disk close to rounding in squeal with several stages per step, if every
/// step is audited. This holds with bilinear and with smooth patches.
#[test]
fn energies_close_with_stages() {
    energies_close(4);
}

/// Protects: the same over a longer squeal.
#[test]
#[ignore = "20 ms of squeal on an elastic disk"]
fn energies_close_over_a_long_squeal() {
    energies_close(20);
}

fn energies_close(span_ms: u32) {
    let mut evidence = Evidence::new("R4", format!("imbalance over the energy put in, {span_ms} ms"), KRENK);
    let mut most_steps = 0.0_f64;
    for target in [TargetSurface::Bilinear, TargetSurface::Ferguson] {
        let mut spec = coarse_scene();
        spec.scene.disk.ring.target = target;
        let model = model(&spec);
        assert!(model.ring().unwrap().stages().count() > 1);
        let drive = drive(0.4, 7.0);
        let mut state = State::<1>::at_rest(&model);
        let mut ledger = EnergyLedger::new(&model, 1);
        let steps = (1.0e-3 * f64::from(span_ms) / model.time_step_s()) as usize;
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
    // Every step adds works of forces. Each force is rounded like a row of K u.
    evidence.judge_exact(ROUNDINGS_PER_FORCE * most_steps);
}

/// Protects: several stages cost no more accuracy than the step itself. The reference has one clock and a
/// fine step. The error of the step itself is that on a rigid disk, which has no stages.
#[test]
fn stages_change_less_than_the_step_does() {
    let displacements = |kind: DiskKind, clock: DiskTimeStep, time_step_s: f64| {
        let mut spec = coarse_scene();
        spec.scene.disk.kind = kind;
        spec.scene.disk.ring.clock = clock;
        spec.numerics.time_step_s = Some(time_step_s);
        let model = model(&spec);
        let mut state = State::<1>::at_rest(&model);
        advance(&model, &drive(0.4, 7.0), &mut state, (SPAN_S / time_step_s).round() as usize);
        let stages = model.ring().map_or(0, |disk| disk.stages().count());
        (state.u.values().collect::<Vec<_>>(), stages)
    };
    let distance = |a: &[f64], b: &[f64]| {
        let size = b.iter().map(|v| v * v).sum::<f64>().sqrt();
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt() / size
    };
    // Steps are rounded so that all runs end at the same time.
    let whole = |step: f64| SPAN_S / (SPAN_S / step).ceil();
    let own = model(&coarse_scene()).time_step_s();
    let (elastic, _) = displacements(DiskKind::Elastic, DiskTimeStep::Common, whole(own / 16.0));
    let (rigid, _) = displacements(DiskKind::Rigid, DiskTimeStep::Own, whole(own / 16.0));
    let mut evidence =
        Evidence::new("R4", "two clocks, pin's displacements after 0.3 ms, error over their size", ONE_CLOCK);
    for step in [own, own / 1.5] {
        let step = whole(step);
        let (found, stages) = displacements(DiskKind::Elastic, DiskTimeStep::Own, step);
        assert!(stages > 1);
        let of_step = distance(&displacements(DiskKind::Rigid, DiskTimeStep::Own, step).0, &rigid);
        let name = format!("{stages} stages in {step:.2e} s");
        evidence.bounded(name, distance(&found, &elastic), 0.0, 1.0, of_step);
    }
    evidence.judge_bounded("the error of the same step on a rigid disk");
}

/// Protects: without any damping, nothing grows over many steps of a shaken pin that bounces on the disk, for every number of stages and for disks from softer than the pin to much stiffer. A frictionless
/// contact force N takes N g_{n−1}/2 ≥ 0 over the increments before and after its time. At that time, between
/// the two increments, the force has yet to take N g_n/2. So the stored energy is at most what was put in
/// plus N g_n/2. (Clocks that exchange held forces grow by a percent per step where a multiple of the longer
/// step is in resonance with the finer mesh.)
#[test]
fn nothing_grows_without_damping() {
    nothing_grows(1_000);
}

/// Protects: nothing grows slowly, either.
#[test]
#[ignore = "ten thousand audited steps on five elastic disks"]
fn nothing_grows_slowly() {
    nothing_grows(10_000);
}

fn nothing_grows(steps: u32) {
    let mut seen = std::collections::BTreeSet::new();
    let what = format!("undamped, frictionless, stored energy above what was put in, {steps} steps");
    let mut evidence = Evidence::new("R4", what, KRENK);
    for (young_modulus_pa, density_kg_m3) in
        [(3.0e8, 2500.0), (1.0e10, 7800.0), (9.0e10, 7800.0), (2.1e11, 7800.0), (3.5e11, 7800.0)]
    {
        let mut spec = coarse_scene();
        spec.numerics.beta_r_s = 0.0;
        spec.numerics.safety_factor = 0.95;
        spec.scene.disk.ring.young_modulus_pa = young_modulus_pa;
        spec.scene.disk.ring.density_kg_m3 = density_kg_m3;
        let model = model(&spec);
        let stages = model.ring().unwrap().stages().count();
        seen.insert(stages);
        let drive = Drive { law: Law::coulomb(0.0), rate: 0.7, force_n: 30.0, ramp_s: 0.0 };
        let mut state = State::<1>::at_rest(&model);
        for dof in 0..state.p.len() {
            // The pattern is arbitrary, but rough. Its size is that of the squeal's velocities.
            state.p[dof] = 0.1 * (((dof * 7919) % 101) as f64 / 50.0 - 1.0);
        }
        for &dof in &clamped(&spec) {
            state.p[dof] = 0.0;
        }
        let mut ledger = EnergyLedger::new(&model, 1);
        let mut worst = 0.0_f64;
        for _ in 0..steps {
            ledger.before_step(&model, &state);
            advance(&model, &drive, &mut state, 1);
            ledger.after_step(&model, &[drive], &state);
            let energies = ledger.energies(0);
            let input = energies.initial_j + energies.load_work_j + energies.drive_work_j;
            let contacts = &state.contacts;
            let pending: f64 = (0..contacts.slaves())
                .map(|slave| {
                    let gap_before = contacts.gap_of(slave, 0) - contacts.increment_of(slave, 0)[2];
                    0.5 * contacts.force_of(slave, 0)[2] * gap_before
                })
                .sum();
            let stored = energies.kinetic_j + energies.elastic_j;
            worst = worst.max((stored - input - pending) / energies.input_j());
        }
        let name = format!("{stages} stages, E = {young_modulus_pa:.1e} Pa");
        evidence.bounded(name, worst, 0.0, 1.0, ROUNDINGS_PER_FORCE * f64::from(steps) * f64::EPSILON);
    }
    assert!(seen.contains(&1) && seen.contains(&4) && seen.len() >= 3, "{seen:?}");
    evidence.judge_bounded("energy balance, and contact that only takes; each step rounds as a row of K u");
}

/// Degrees of freedom that the scene holds or ties. Their velocities cannot be chosen freely.
fn clamped(spec: &JobSpec) -> Vec<usize> {
    let mesh = tribosweep_mechanics::solver::body::pin::BlockMesh::new(
        spec.scene.pin.size_m,
        spec.scene.pin.elements,
    );
    mesh.top_nodes().flat_map(|node| [3 * node, 3 * node + 1, 3 * node + 2]).collect()
}

/// Protects: a contact solve that does not converge ends the job with an error that gives the step and the
/// residual. The disk is so light that target nodes with almost no mass couple some tens of slave nodes.
#[test]
fn a_solve_that_fails_is_an_error() {
    let mut spec = coarse_scene();
    spec.scene.disk.ring.density_kg_m3 = 1.0;
    spec.run.limit_s = 0.002;
    let error = solve(&spec, &mut Unobserved).unwrap_err();
    assert!(matches!(error, JobError::Solver(SolverError::ContactNotSolved { .. })), "{error}");
    let message = error.to_string();
    for part in ["of step ", "did not converge", "after 500 sweeps", "more than 1e-10", "very light disk"] {
        assert!(message.contains(part), "{part} is not in {message}");
    }
}

/// Protects: a disk that turns more than once under a pin without contact has no strain. The energies of a
/// disk that carries the pin all the time, over every sector and over the end of the ring's numbering, close.
#[test]
fn more_than_a_turn_strains_nothing() {
    turns_strain_nothing(1.2);
}

/// Protects: the same over three turns.
#[test]
#[ignore = "three turns of an elastic disk"]
fn several_turns_strain_nothing() {
    turns_strain_nothing(3.0);
}

fn turns_strain_nothing(turns: f64) {
    let mut spec = coarse_scene();
    spec.scene.disk.ring.track_arc_deg = 360.0;
    // At a thousand turns per second, a turn takes little time, and the pin passes many edges.
    spec.scene.disk.omega_rpm = 60_000.0;
    let model = model(&spec);
    let steps = (1.0e-3 * turns / model.time_step_s()) as usize;
    let loaded = drive(0.1, spec.scene.disk.omega_rpm);
    let mut state = State::<1>::at_rest(&model);
    for node in 0..model.mesh().block().unwrap().node_count() {
        state.u[3 * node + 2] = 1.0e-6;
    }
    advance(&model, &Drive { force_n: 0.0, ..loaded }, &mut state, steps);
    let disk = state.target.ring().unwrap().1;
    assert!(disk.u.values().chain(disk.p.values()).all(|value| value == 0.0), "the disk turns rigidly");

    let mut evidence =
        Evidence::new("R4", format!("{turns} turns under load, imbalance over the energy put in"), KRENK);
    let mut state = State::<1>::at_rest(&model);
    let mut ledger = EnergyLedger::new(&model, 1);
    for _ in 0..steps {
        ledger.before_step(&model, &state);
        advance(&model, &loaded, &mut state, 1);
        ledger.after_step(&model, &[loaded], &state);
    }
    let energies = ledger.energies(0);
    evidence.found("360° of track", energies.imbalance_j(), 0.0, energies.input_j());
    evidence.judge_exact(ROUNDINGS_PER_FORCE * steps as f64);
}

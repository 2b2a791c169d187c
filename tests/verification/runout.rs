//! B21 A disk with run-out and waviness.
//!
//! * **A point mass** m under the load F that stays on the surface h = a cos(k(q − Vt)) has N = F + m ḧ (Newton). The central
//!   difference replaces ḧ by a second difference, whose error is (ωΔt)²/12 of it, with ω = kV.
//! * **A pin** on a surface that moves slowly is deformed as on a base with the same heights at rest. The difference
//!   falls with the speed: by the damping in proportion to it, and by inertia with its square.
//! * **The energies** close when the surface lifts the pin and the pin falls back on it: the drive does the work N dh.

use crate::verification::common::{ROUNDINGS_PER_FORCE, advance};
use crate::verification::evidence::Evidence;
use crate::verification::particles::{Particles, X, Y, Z, audited_step};
use std::f64::consts::TAU;
use tribosweep_mechanics::analysis::drive;
use tribosweep_mechanics::solver::energy::EnergyLedger;
use tribosweep_mechanics::solver::interface::law::Law;
use tribosweep_mechanics::solver::interface::{ContactState, Relief, Wave};
use tribosweep_mechanics::solver::lane::LaneState;
use tribosweep_mechanics::solver::{Drive, Model, State, TimeStep, step};
use tribosweep_mechanics::spec::{HeightMap, JobSpec};

const MASS_KG: f64 = 0.5;
const AMPLITUDE_M: f64 = 0.01;
const WAVE_NUMBER: f64 = 4.0;
const SPEED_M_S: f64 = 2.5;
const LOAD_N: f64 = 2.0;

/// Protects: the heights under a node at the time of a step, their sign, and the normal force and the work with them, for nodes
/// with and without fixed components.
#[test]
fn a_mass_follows_the_surface() {
    let omega = WAVE_NUMBER * SPEED_M_S;
    let mut force = Evidence::new("B21", "normal force of a mass on a moving wave [N]", "N = F + m ḧ");
    let mut place = Evidence::new("B21", "height of a mass on a moving wave [m]", "z = h(t) − h(0)");
    let mut energy = Evidence::new(
        "B21",
        "energy balance of a mass on a moving wave, relative to the energy put in",
        "stored energy = work of load and drive − contact loss, an identity of the scheme",
    );
    for w in [0.2, 0.1, 0.05, 0.025] {
        let resolution = format!("ωΔt = {w}");
        for is_free in [true, false] {
            let mut system = Particles::corners(MASS_KG);
            system.release(0, Z).load(0, Z, -1.0);
            if is_free {
                system.release(0, X).release(0, Y);
            }
            let wave = Wave { amplitude_m: AMPLITUDE_M, number: WAVE_NUMBER };
            let dt = w / omega;
            let model =
                system.model(0.0, TimeStep::Given(dt)).with_relief(Relief::new(vec![wave], vec![0.0; 4]));
            let drive = Drive { law: Law::coulomb(0.0), rate: SPEED_M_S, force_n: LOAD_N, ramp_s: 0.0 };
            let (mut state, mut ledger) = (State::at_rest(&model), EnergyLedger::new(&model, 1));
            let steps = (30.0 / w) as usize;
            let mut worst: f64 = 0.0;
            for n in 0..steps {
                audited_step(&model, drive, &mut state, &mut ledger);
                let phase = n as f64 * w;
                let exact_n = LOAD_N - MASS_KG * AMPLITUDE_M * omega * omega * phase.cos();
                worst = worst.max((state.contacts.force_of(0, 0)[2] - exact_n).abs());
                let exact_m = AMPLITUDE_M * ((phase + w).cos() - 1.0);
                if n + 1 == steps {
                    place.found(&resolution, state.u[Z], exact_m, AMPLITUDE_M);
                }
            }
            if is_free {
                let scale_n = MASS_KG * AMPLITUDE_M * omega * omega;
                force.found(&resolution, worst, 0.0, scale_n);
            }
            let energies = ledger.energies(0);
            assert!(energies.drive_work_j.abs() > 0.1 * LOAD_N * AMPLITUDE_M, "{energies:?}");
            let residual = energies.imbalance_j() / (LOAD_N * AMPLITUDE_M);
            energy.bounded(&resolution, residual, 0.0, 1.0, 50.0 * steps as f64 * f64::EPSILON);
        }
    }
    force.judge_order(2.0, 2.0, 1.0e-9);
    place.judge_exact(1.0e4);
    energy.judge_bounded("fifty roundings a step");
}

/// A small pin on a disk with 70 waves.
fn wavy() -> JobSpec {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.scene.disk.runout_m = Some(1.0e-6);
    spec.scene.disk.waviness_height_m = Some(1.0e-7);
    spec.scene.disk.waviness_count = Some(70);
    spec.scene.load.ramp_s = 2.0e-4;
    spec
}

/// Protects: the angles of nodes on the disk and the direction in which the surface turns, by the forces on a slow disk.
#[test]
fn a_slow_disk_deforms_the_pin_as_a_base_at_rest_does() {
    // The surface turns by a third of a wave.
    let turned_rad = TAU / 70.0 / 3.0;
    let mut spec = wavy();
    spec.scene.contact.mu = 0.0;
    spec.numerics.beta_r_s = 2.0e-6;
    let forces_n = |spec: &JobSpec, seconds: f64, rate: f64| {
        spec.check().unwrap();
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let steps = (seconds / model.time_step_s()).round() as usize;
        // The forces of the last step are those at its beginning.
        let rate = rate * seconds / ((steps - 1) as f64 * model.time_step_s());
        let mut state = State::<1>::at_rest(&model);
        advance(&model, &Drive { rate, ..drive(spec) }, &mut state, steps);
        let of = |slave: usize| state.contacts.force_of(slave, 0)[2];
        (0..model.slaves().len()).map(of).collect::<Vec<_>>()
    };
    let exact_n = {
        let mut spec = spec.clone();
        let disk = std::mem::take(&mut spec.scene.disk);
        let height = |x: f64, y: f64| {
            let angle = y.atan2(disk.track_radius_m + x) - turned_rad;
            1.0e-6 * angle.cos() + 1.0e-7 * (70.0 * angle).cos()
        };
        // All nodes are points of this map: they are 2 mm and 15/8 mm apart.
        let spacing_m = 0.001 / 8.0;
        let columns = 97;
        let rows = 121;
        let row = |j: usize| {
            let y = (j as f64 - 0.5 * (rows - 1) as f64) * spacing_m;
            (0..columns).map(|i| height((i as f64 - 0.5 * (columns - 1) as f64) * spacing_m, y)).collect()
        };
        let heights_m = (0..rows).map(row).collect();
        spec.scene.pin.base.height_map = Some(HeightMap { file: None, spacing_m, heights_m });
        forces_n(&spec, 4.0e-3, 0.7)
    };
    let mut slow = Evidence::new(
        "B21",
        "largest difference of a nodal force on a slowly turning disk from that at rest, over the mean force",
        "the same pin on a base with the heights of the disk",
    );
    let mean_n = exact_n.iter().sum::<f64>() / exact_n.len() as f64;
    let spread = exact_n.iter().fold(0.0_f64, |most, force| most.max((force - mean_n).abs()));
    assert!(spread > 0.2 * mean_n, "the surface is felt: {spread} of {mean_n}");
    for seconds in [0.002, 0.004, 0.008] {
        let found_n = forces_n(&spec, seconds, turned_rad / seconds);
        let worst = found_n.iter().zip(&exact_n).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        slow.found(format!("{seconds} s"), worst, 0.0, mean_n);
    }
    slow.judge_overall_order(1.0, 2.0, "damping and inertia have orders 1 and 2");
}

/// Protects: the energies close while the pin jumps on a fast wavy disk with friction, and the bits do not depend on other lanes or
/// on an interruption.
#[test]
fn energies_close_and_lanes_are_independent() {
    let mut spec = wavy();
    spec.scene.disk.waviness_height_m = Some(3.0e-6);
    spec.scene.disk.omega_rpm = 600.0;
    spec.check().unwrap();
    let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    let fast = drive(&spec);
    let slow = Drive { rate: 0.3 * fast.rate, ..fast };
    let steps = 3000;
    let mut state = State::<1>::at_rest(&model);
    let mut ledger = EnergyLedger::new(&model, 1);
    let (mut separated, mut stuck) = (0, 0);
    for _ in 0..steps {
        audited_step(&model, fast, &mut state, &mut ledger);
        let states: Vec<_> = state.contacts.states(0).map(ContactState::name).collect();
        separated += states.iter().filter(|name| **name == "separated").count();
        stuck += states.iter().filter(|name| **name == "slip").count();
    }
    assert!(separated > steps && stuck > steps, "{separated}, {stuck}");
    let mut energy = Evidence::new(
        "B21",
        "energy balance of a pin on a wavy disk, relative to the energy put in",
        "energy balance of Newmark's method (Krenk 2006)",
    );
    energy.found("3000 steps", ledger.energies(0).relative_residual(), 0.0, 1.0);
    energy.judge_exact(ROUNDINGS_PER_FORCE * steps as f64);

    let mut both = State::<2>::at_rest(&model);
    for _ in 0..1000 {
        step(&model, &[slow, fast], &mut both);
    }
    let mut saved = Vec::new();
    both.save_lane(1, &mut saved);
    let mut resumed = State::<2>::at_rest(&model);
    resumed.load_lane(0, &mut saved.into_iter());
    for _ in 1000..steps {
        step(&model, &[fast, slow], &mut resumed);
    }
    let lane = |state: &dyn Fn(&mut Vec<f64>)| {
        let mut saved = Vec::new();
        state(&mut saved);
        saved.iter().map(|number| number.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(lane(&|saved| resumed.save_lane(0, saved)), lane(&|saved| state.save_lane(0, saved)));
}

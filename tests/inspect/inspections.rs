//! An inspection shows the job's own run.

use crate::{coarse, inspect};
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use tribosweep_mechanics::analysis::{JobError, Outcome, Regime, Unobserved, solve};
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_mechanics::spec::DiskKind;
use tribosweep_output::inspect::{
    Change, Inspection, InspectionError, JobSpectrum, NodeSelector, Options, PageHeader, Summary,
    has_spectrum, write,
};

/// Protects: both runs of an inspection have the same record as the job solved alone, to the last bit, and the cycles that
/// are shown have its frequency.
#[test]
fn both_runs_are_the_job() {
    let spec = coarse();
    let inspection = inspect(&spec, &Options::default());
    let record = solve(&spec, &mut Unobserved).unwrap();
    assert_eq!((record.outcome, record.regime), (Outcome::Periodic, Regime::StickSlipSeparation));
    assert_eq!(inspection.survey.record, record);
    assert_eq!(inspection.capture.record, record);
    // The averaging window is the last whole cycles of the run.
    let passages = &inspection.survey.passages_s;
    let window = &passages[passages.len() - record.cycles * record.crossings_per_cycle..];
    assert_eq!(window[0][0], record.window_start_s);
    let duration_s = window.last().unwrap()[1] - window[0][0];
    let frequency_hz = window.len() as f64 / duration_s;
    assert!((frequency_hz / record.frequency_hz.unwrap() - 1.0).abs() < 1e-12);
    // The period of the cycles that are shown differs from that of the window by less than the tolerance of the job.
    let tolerated = spec.detection.tolerance;
    assert!((inspection.survey.windows.period_s * frequency_hz - 1.0).abs() < tolerated);
}

/// Protects: totals, face and nodes have the same steps: the totals are the sums over the face, and the history of a node
/// agrees with the face.
#[test]
fn totals_face_and_nodes_agree() {
    let inspection = inspect(&coarse(), &Options::default());
    let slaves = inspection.capture.model.slaves().len();
    let [start_s, end_s] = inspection.survey.windows.cycle_s;
    let steps = (end_s - start_s) / inspection.survey.record.time_step_s;
    assert!((inspection.capture.face.len() as f64 - steps).abs() <= 1.0, "every step of the cycle");
    for step in &inspection.capture.face {
        let total = inspection.capture.totals.iter().find(|total| total.time_s == step.time_s).unwrap();
        let normal: f64 = step.nodes.iter().map(|node| node.force_n[2]).sum();
        // The order of the sums differs.
        assert!((normal - total.normal_n).abs() <= slaves as f64 * f64::EPSILON * total.normal_n);
        let count = |state| step.nodes.iter().filter(|node| node.state == state).count();
        let counts = [ContactState::Stick, ContactState::Slip, ContactState::Separated].map(count);
        assert_eq!(counts, [total.stick, total.slip, total.separated]);
        for (observed, history) in inspection.observed.iter().zip(&inspection.capture.nodes) {
            let same = history.iter().find(|own| own.time_s == step.time_s).unwrap();
            assert_eq!(same.node, step.nodes[observed.node.slave]);
        }
    }
}

/// Protects: the instants are those of the paper's figure 4, at nodes that separate and at nodes that do not: they are in
/// order, within one period, at the steps at which the states change, and the largest stress is at t_C.
#[test]
fn the_instants_are_those_of_the_states() {
    let mut kinds = BTreeSet::new();
    for omega_rpm in [1.0, 2.0, 4.0, 7.0, 20.0] {
        let mut spec = coarse();
        spec.scene.disk.omega_rpm = omega_rpm;
        let inspection = inspect(&spec, &Options::default());
        let period_s = inspection.survey.windows.period_s;
        for (observed, steps) in inspection.observed.iter().zip(&inspection.capture.nodes) {
            let instants = observed.instants.unwrap();
            let letters: String = instants.named().iter().map(|(letter, _)| *letter).collect();
            let context = format!("{omega_rpm} rpm, {}: {:?}", observed.node.name, instants.named());
            let place = |time_s: f64| steps.iter().position(|step| step.time_s >= time_s).unwrap();
            let state = |time_s: f64| steps[place(time_s)].node.state;
            let before = |time_s: f64| steps[place(time_s) - 1].node.state;
            if let (Some(b), Some(d)) = (instants.stick_s, instants.slip_s) {
                assert!(b < d && d - b < period_s, "{context}");
                assert!(state(b) == ContactState::Stick && before(b) != ContactState::Stick, "{context}");
                assert!(state(d) != ContactState::Stick && before(d) == ContactState::Stick, "{context}");
            }
            if let (Some(a), Some(e), Some(f)) = (instants.contact_s, instants.separation_s, instants.end_s) {
                assert!(
                    state(a) != ContactState::Separated && before(a) == ContactState::Separated,
                    "{context}"
                );
                let apart = &steps[place(e)..place(f)];
                assert!(apart.iter().all(|step| step.node.state == ContactState::Separated), "{context}");
                assert!(
                    before(e) != ContactState::Separated && state(f) != ContactState::Separated,
                    "{context}"
                );
                assert!((f - a - period_s).abs() < 0.1 * period_s, "one cycle, not two: {context}");
                assert!(instants.peak_s >= a && instants.peak_s < e, "{context}");
                let between = &steps[place(a)..place(e)];
                let largest = between.iter().map(|step| step.stress_pa[2]).fold(0.0, f64::max);
                assert_eq!(steps[place(instants.peak_s)].stress_pa[2], largest, "{context}");
                if let (Some(b), Some(d)) = (instants.stick_s, instants.slip_s) {
                    assert!(a <= b && d <= e, "{context}");
                }
            } else {
                assert!(!letters.contains(['A', 'E', 'F']), "all of a separation or none of it: {context}");
            }
            kinds.insert(letters);
        }
    }
    // The loop above had nodes with separation and nodes without.
    assert!(kinds.contains("ABCDEF") && kinds.contains("BCD"), "{kinds:?}");
}

/// Protects: the waves of contact and separation are exactly the runs of neighbouring nodes that separate.
#[test]
fn waves_are_those_of_the_face() {
    let inspection = inspect(&coarse(), &Options::default());
    let mesh = inspection.mesh();
    let [nx, ny, _] = mesh.block().unwrap().elements();
    let separates: Vec<bool> = (0..=ny)
        .map(|j| {
            let states = inspection
                .capture
                .face
                .iter()
                .map(|step| step.nodes[mesh.block().unwrap().node(nx / 2, j, 0)].state);
            states.into_iter().any(|state| state == ContactState::Separated)
        })
        .collect();
    let runs: Vec<[usize; 2]> = (0..=ny)
        .filter(|&j| separates[j] && (j == 0 || !separates[j - 1]))
        .map(|j| [j, (j..=ny).take_while(|&k| separates[k]).last().unwrap()])
        .filter(|[first, last]| last > first)
        .collect();
    let y = |j: usize| mesh.coordinates_m(mesh.block().unwrap().node(0, j, 0))[1];
    let expected: Vec<_> = runs.iter().map(|&[first, last]| [y(first), y(last)]).collect();
    assert!(!expected.is_empty());
    let summary = Summary::of(&inspection);
    for change in [Change::Contact, Change::Separation] {
        let found: Vec<_> =
            summary.waves.iter().filter(|wave| wave.change == change).map(|wave| wave.from_to_m).collect();
        assert_eq!(found, expected, "{change:?}");
    }
}

/// Protects: no more cycles are shown than those that repeat, so that the transient is never shown as limit cycles.
#[test]
fn no_more_cycles_than_there_are() {
    let inspection = inspect(&coarse(), &Options { cycles: 1000, ..Options::default() });
    let (windows, record) = (&inspection.survey.windows, &inspection.survey.record);
    assert!(windows.has_cycles);
    assert_eq!(windows.cycle_count, record.cycles);
    assert!((windows.shown_s[0] / record.window_start_s - 1.0).abs() < 1e-12, "{windows:?}");
}

/// Protects: up to rounding, a node that sticks has the velocity of the disk, and a node that slips has |τ| = μ σ_n.
#[test]
fn stick_and_slip_are_exact() {
    let spec = coarse();
    let summary = Summary::of(&inspect(&spec, &Options::default()));
    for node in &summary.nodes {
        assert!(node.shares.iter().all(|share| *share > 0.0), "{node:?}");
        // The velocity is a difference of positions of some µm over a step, which has their rounding errors.
        let rounding_m_s = 4.0 * f64::EPSILON * 1e-5 / summary.record.time_step_s;
        assert!(node.stick_speed_error_m_s <= rounding_m_s, "{node:?}");
        assert!(node.slip_friction_error <= 4.0 * f64::EPSILON, "{node:?}");
    }
}

/// Protects: displacements and velocities of the frames agree: with a frame for every step, the difference quotient of two
/// frames is the velocity, at every node of the pin.
#[test]
fn frames_are_of_the_same_motion() {
    let inspection = inspect(&coarse(), &Options { frames: 1000, ..Options::default() });
    let dt = inspection.survey.record.time_step_s;
    let frames = &inspection.capture.frames;
    assert_eq!(frames.len(), inspection.capture.face.len(), "no more frames than steps");
    let fastest = frames.iter().flat_map(|frame| &frame.velocity_m_s).map(|v| v.abs()).fold(0.0, f64::max);
    assert!(fastest > 0.1, "{fastest} m/s");
    for pair in frames.windows(2) {
        assert!((pair[1].time_s - pair[0].time_s - dt).abs() < 1e-3 * dt);
        for ((before, after), velocity) in pair[0].u_m.iter().zip(&pair[1].u_m).zip(&pair[1].velocity_m_s) {
            // The displacements of some µm have rounding errors, which are divided by the time step.
            let rounding = 4.0 * f64::EPSILON * before.abs().max(after.abs()) / dt + 1e-12 * fastest;
            let difference = (after - before) / dt - velocity;
            assert!(
                difference.abs() <= rounding,
                "{before} {after} {velocity}: {difference:e} > {rounding:e}"
            );
        }
    }
}

/// Protects: a job without cycles can be inspected too, and all files exist.
#[test]
fn stable_sliding_has_no_cycles() {
    let mut spec = coarse();
    spec.scene.contact.mu = 0.1;
    let inspection = inspect(&spec, &Options::default());
    assert_eq!(inspection.survey.record.regime, Regime::Stable);
    let summary = Summary::of(&inspection);
    assert!(!summary.cycles && summary.waves.is_empty() && summary.nodes[0].frequency_hz.is_none());
    assert_eq!(summary.nodes[0].shares, [0.0, 1.0, 0.0]);
    let folder = tempfile::tempdir().unwrap();
    let files = write(&inspection, folder.path(), &PageHeader::default()).unwrap();
    assert!(files.iter().all(|file| file.is_file()));
}

/// Protects: nodes can be selected by name and by coordinates, and the numbers of a node agree with the job's record.
#[test]
fn any_node_can_be_observed() {
    let nodes = ["centre", "-6,7.5", "front_centre"].map(|text| NodeSelector::parse(text).unwrap()).to_vec();
    let inspection = inspect(&coarse(), &Options { nodes, ..Options::default() });
    let names: Vec<_> = inspection.observed.iter().map(|observed| observed.node.name.as_str()).collect();
    assert_eq!(names, ["centre", "x-6.000_y+7.500mm", "front_centre"]);
    let found = Summary::of(&inspection).nodes[2].clone();
    let recorded = &inspection.survey.record.nodes[0];
    assert_eq!(recorded.name, "front_centre");
    // The extremes of four cycles are within those of twenty, and differ by less than the tolerance of the job.
    let tolerated = coarse().detection.tolerance;
    for (shown, all) in [
        (found.peak_to_peak_m[1], recorded.y_peak_to_peak_m),
        (found.lift_max_m, recorded.lift_max_m),
        (found.sigma_n_max_pa, recorded.sigma_n_max_pa),
        (found.slip_speed_max_m_s, recorded.slip_speed_max_m_s),
    ] {
        assert!(shown <= all && shown > (1.0 - 2.0 * tolerated) * all, "{shown} of {all}");
    }
    let off = Options { nodes: vec![NodeSelector::parse("0,8").unwrap()], ..Options::default() };
    let error = Inspection::run(&coarse(), &off, &mut |_| ControlFlow::Continue(())).unwrap_err();
    assert!(matches!(&error, InspectionError::Node(text) if text.contains("0,8 mm")), "{error}");
}

/// Protects: an inspection can be stopped in either run.
#[test]
fn an_inspection_can_be_interrupted() {
    for run_to_stop in [1, 2] {
        let (mut run, mut last_s) = (1, 0.0);
        let found = Inspection::run(&coarse(), &Options::default(), &mut |simulated_s| {
            run += u32::from(simulated_s < last_s);
            last_s = simulated_s;
            if run == run_to_stop && simulated_s > 1e-3 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        assert!(matches!(found, Err(InspectionError::Job(JobError::Interrupted))));
        assert_eq!(run, run_to_stop);
    }
}

/// Protects: jobs on an elastic disk can be inspected. A node that sticks moves with the surface of the disk, whose own
/// velocity is not zero, but smaller than that of the pin by the ratio of the stiffnesses.
#[test]
fn an_elastic_disk_moves_under_sticking_nodes() {
    let mut spec = coarse();
    spec.scene.disk.kind = DiskKind::Elastic;
    spec.scene.disk.ring.element_size_m = 0.005;
    let inspection = inspect(&spec, &Options { frames: 16, ..Options::default() });
    assert_eq!(inspection.survey.record, inspection.capture.record);
    let node = &Summary::of(&inspection).nodes[0];
    // The same forces move two half-spaces in the ratio of their stiffnesses, here 1 : 210. The pin is a block with free
    // sides, which moves several times as much as a half-space.
    let ratio = spec.scene.pin.young_modulus_pa / spec.scene.disk.ring.young_modulus_pa;
    let bound_m_s = 10.0 * ratio * node.relative_speed_max_m_s;
    assert!(node.stick_speed_error_m_s > 0.0 && node.stick_speed_error_m_s < bound_m_s, "{node:?}");
}

/// Protects: the friction energies of the loops of all nodes add up to the solver's own, which the record has, to rounding.
/// So the area under friction over slip is the dissipated energy. Over a closed cycle on a rigid disk, the work of the disk is
/// dissipated, goes into the pin, or is lost where nodes begin to stick.
#[test]
fn loops_have_the_energy_of_the_balance() {
    let inspection = inspect(&coarse(), &Options::default());
    let loops = Summary::of(&inspection).loops;
    let audited = loops.audited.unwrap();
    let [from_s, to_s] = audited.from_to_s;
    let period_s = inspection.survey.windows.period_s;
    // Audits are 16 steps apart.
    assert!(to_s - from_s > period_s - 33.0 * inspection.survey.record.time_step_s, "nearly a cycle");
    // Both are sums over nodes and steps. The balance is a difference of sums since the start of the run.
    let terms = inspection.survey.record.steps as f64 * inspection.capture.model.slaves().len() as f64;
    let rounding_j = terms * f64::EPSILON * inspection.survey.record.energy.friction_j;
    assert!((audited.loops_j - audited.balance_j).abs() <= rounding_j, "{audited:?} {rounding_j:e}");
    assert!(audited.balance_j > 1e6 * rounding_j, "{audited:?} {rounding_j:e}");

    let face = loops.face;
    let lost_j = face.drive_j - face.friction_j - face.into_pin_j;
    let [first, .., last] = inspection.capture.audits.as_slice() else { panic!("audits") };
    let balance_lost_j = last.energies.contact_loss_j - first.energies.contact_loss_j;
    // The loss of the balance has the impacts too, and lacks up to 32 steps of the cycle. A closed loop has an error of the
    // one step from its end to its start.
    let step_j = face.drive_j * 33.0 * inspection.survey.record.time_step_s / period_s;
    assert!(lost_j > -step_j && lost_j < balance_lost_j + step_j, "{lost_j:e} {balance_lost_j:e} {step_j:e}");
    assert!(face.friction_j > 0.3 * face.drive_j && face.into_pin_j > 0.0, "{face:?}");
    // The work of the disk over a cycle, from the macroscopic coefficient. Cycles differ by the tolerance of the job.
    let record = &inspection.survey.record;
    let spec = coarse();
    let track_m_s = inspection.observed[0].target_velocity_m_s;
    let work_j = record.mu_star * spec.scene.load.force_n * track_m_s * period_s;
    // Under the pin the velocity of the disk varies with the radius, by half of the pin's width over the track radius.
    let varies = 0.5 * spec.scene.pin.size_m[0] / spec.scene.disk.track_radius_m;
    let tolerated = 2.0 * spec.detection.tolerance + varies;
    assert!((face.drive_j / work_j - 1.0).abs() < tolerated, "{} {work_j}", face.drive_j);
}

/// Protects: nodes, too, share out the work of the disk; the loop of a node begins at zero in every cycle, does not slip while
/// it sticks, and slips by the way of the disk in a cycle.
#[test]
fn loops_of_nodes_are_their_histories() {
    let inspection = inspect(&coarse(), &Options::default());
    let folder = tempfile::tempdir().unwrap();
    write(&inspection, folder.path(), &PageHeader::default()).unwrap();
    let table = std::fs::read_to_string(folder.path().join("loops.csv")).unwrap();
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(
        lines[0],
        ["place", "time_s", "slip_y_m", "displacement_y_m", "friction_y_n", "clamp_tangential_n", "state"]
    );
    let of = |place: &str| -> Vec<&Vec<&str>> { lines.iter().filter(|line| line[0] == place).collect() };
    let number = |cell: &str| cell.parse::<f64>().unwrap();
    let front = of("front_centre");
    assert_eq!(front.len(), inspection.capture.nodes[0].len());
    let zeros = front.iter().filter(|line| number(line[2]) == 0.0).count();
    assert!(zeros >= inspection.survey.windows.cycle_count, "{zeros} cycles begin at zero");
    let way_m = inspection.observed[0].target_velocity_m_s * inspection.survey.windows.period_s;
    // The steps of the largest displacement of a cycle are within one step of the disk and of the node.
    let reach_m = front.iter().map(|line| number(line[2])).fold(0.0, f64::max);
    assert!(reach_m > 0.9 * way_m, "{reach_m} {way_m}");
    for pair in front.windows(2).filter(|pair| pair[0][6] == "stick" && number(pair[1][2]) != 0.0) {
        // A node that sticks has the disk's velocity to the rounding of its displacement.
        assert!((number(pair[1][2]) - number(pair[0][2])).abs() <= 1e-6 * way_m, "{pair:?}");
    }
    let face = of("face");
    assert_eq!(face.len(), inspection.capture.face.len());
    assert!(face.iter().all(|line| !line[5].is_empty() && line[6].is_empty()));
    let energies = Summary::of(&inspection).loops.nodes;
    for node in energies {
        // What is lost at the beginning of stick is a part of it.
        let sum = node.friction_j + node.into_pin_j;
        assert!((sum / node.drive_j - 1.0).abs() < 0.1, "{node:?}");
    }
}

/// Protects: a spectrum that is stored alone, from one run, is that of the whole inspection, and its folder is known by the
/// job's key.
#[test]
fn a_spectrum_alone_is_the_same() {
    let spec = coarse();
    let inspection = inspect(&spec, &Options::default());
    let alone = JobSpectrum::of_job(&spec, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(alone.record, inspection.survey.record);
    // The averaging window has more cycles than are shown, so both spectra are over that window.
    assert_eq!(alone.spectrum, inspection.spectrum);
    let folder = tempfile::tempdir().unwrap();
    let [short, full] = ["short", "full"].map(|name| folder.path().join(name));
    alone.write(&spec, "abc", &short).unwrap();
    write(&inspection, &full, &PageHeader { key: "abc".to_owned(), ..PageHeader::default() }).unwrap();
    let read = |path: &std::path::Path| std::fs::read(path.join("spectrum.csv")).unwrap();
    assert_eq!(read(&short), read(&full));
    for path in [&short, &full] {
        assert!(has_spectrum(path, "abc") && !has_spectrum(path, "abd"));
    }
    assert!(!has_spectrum(folder.path(), "abc"));
    let stopped = JobSpectrum::of_job(&spec, &mut |_| ControlFlow::Break(()));
    assert!(matches!(stopped, Err(JobError::Interrupted)));
}

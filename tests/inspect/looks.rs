//! A look is the job's own run.

use crate::{coarse, look_into};
use std::ops::ControlFlow;
use tribosweep::analysis::{JobError, Outcome, Regime, Unobserved, solve};
use tribosweep::inspect::{Look, LookError, Options, Origin, Place, Summary, write};
use tribosweep::solver::contact::ContactState;
use tribosweep::spec::DiskKind;

/// Protects: what is shown is the job: both runs of a look have the record of the job solved alone, to the last bit,
/// and the cycles that are shown are those of its frequency.
#[test]
fn both_runs_are_the_job() {
    let spec = coarse();
    let look = look_into(&spec, &Options::default());
    let record = solve(&spec, &mut Unobserved).unwrap();
    assert_eq!((record.outcome, record.regime), (Outcome::Periodic, Regime::StickSlipSeparation));
    assert_eq!(look.survey.record, record);
    assert_eq!(look.capture.record, record);
    // The averaging window is the last whole cycles of the run.
    let passages = &look.survey.passages_s;
    let window = &passages[passages.len() - record.cycles * record.crossings_per_cycle..];
    assert_eq!(window[0][0], record.window_start_s);
    let duration_s = window.last().unwrap()[1] - window[0][0];
    let frequency_hz = window.len() as f64 / duration_s;
    assert!((frequency_hz / record.frequency_hz.unwrap() - 1.0).abs() < 1e-12);
    // Over the cycles that are shown the period is that of the window within what the job tolerates of it.
    let tolerated = spec.detection.tolerance;
    assert!((look.survey.windows.period_s * frequency_hz - 1.0).abs() < tolerated);
}

/// Protects: totals, face and nodes tell of the same steps: sums of the face are the totals, and a node's history is
/// the face's.
#[test]
fn what_is_shown_adds_up() {
    let look = look_into(&coarse(), &Options::default());
    let slaves = look.capture.model.slaves().len();
    let [start_s, end_s] = look.survey.windows.cycle_s;
    let steps = (end_s - start_s) / look.survey.record.time_step_s;
    assert!((look.capture.face.len() as f64 - steps).abs() <= 1.0, "every step of the cycle");
    for step in &look.capture.face {
        let total = look.capture.totals.iter().find(|total| total.time_s == step.time_s).unwrap();
        let normal: f64 = step.nodes.iter().map(|node| node.force_n[2]).sum();
        // Sums in another order.
        assert!((normal - total.normal_n).abs() <= slaves as f64 * f64::EPSILON * total.normal_n);
        let count = |state| step.nodes.iter().filter(|node| node.state == state).count();
        let counts = [ContactState::Stick, ContactState::Slip, ContactState::Separated].map(count);
        assert_eq!(counts, [total.stick, total.slip, total.separated]);
        for (observed, history) in look.observed.iter().zip(&look.capture.nodes) {
            let same = history.iter().find(|own| own.time_s == step.time_s).unwrap();
            assert_eq!(same.node, step.nodes[observed.node.slave]);
        }
    }
}

/// Protects: the instants are where the paper's figure 4 has them: in their order, with the states they are named
/// after between them, and the largest stress at t_C.
#[test]
fn the_instants_are_those_of_the_states() {
    let look = look_into(&coarse(), &Options::default());
    let observed = &look.observed[0];
    assert_eq!(observed.node.name, "front_centre");
    let instants = observed.instants.unwrap();
    let named = instants.named();
    assert_eq!(named.iter().map(|(letter, _)| *letter).collect::<String>(), "ABCDEF");
    assert!(named.windows(2).all(|pair| pair[0].1 <= pair[1].1), "{named:?}");
    let steps = &look.capture.nodes[0];
    let states = |from_s: f64, to_s: f64| {
        steps
            .iter()
            .filter(move |step| step.time_s >= from_s && step.time_s < to_s)
            .map(|step| step.node.state)
    };
    let [a, b, d, e, f] =
        [instants.contact_s, instants.stick_s, instants.slip_s, instants.separation_s, instants.end_s]
            .map(Option::unwrap);
    assert!(states(e, f).all(|state| state == ContactState::Separated));
    let dt = look.survey.record.time_step_s;
    assert!(
        states(a, a + 0.5 * dt).chain(states(f, f + 0.5 * dt)).all(|state| state != ContactState::Separated)
    );
    assert!(states(b, b + 0.5 * dt).all(|state| state == ContactState::Stick));
    assert!(states(d, d + 0.5 * dt).all(|state| state != ContactState::Stick));
    let stress = |time_s: f64| steps.iter().find(|step| step.time_s == time_s).unwrap().node.sigma_n_pa;
    let between = steps.iter().filter(|step| step.time_s >= a && step.time_s <= e);
    assert_eq!(stress(instants.peak_s), between.map(|step| step.node.sigma_n_pa).fold(0.0, f64::max));
    // One cycle, not two.
    assert!((f - a - look.survey.windows.period_s).abs() < 0.1 * look.survey.windows.period_s);
}

/// Protects: what the figures claim of stick and slip: a node that sticks has the velocity of the disk and one that
/// slips has |τ| = μ σ_n, to rounding.
#[test]
fn stick_and_slip_are_exact() {
    let spec = coarse();
    let summary = Summary::of(&look_into(&spec, &Options::default()));
    for node in &summary.nodes {
        assert!(node.shares.iter().all(|share| *share > 0.0), "{node:?}");
        // Positions of some µm, whose differences over a step round to its parts.
        let rounding_m_s = 4.0 * f64::EPSILON * 1e-5 / summary.record.time_step_s;
        assert!(node.stick_speed_error_m_s <= rounding_m_s, "{node:?}");
        assert!(node.slip_friction_error <= 4.0 * f64::EPSILON, "{node:?}");
    }
}

/// Protects: displacements and velocities of the frames belong together: with a frame for every step, the difference of
/// two is the velocity between them, at every node of the pin.
#[test]
fn frames_are_of_the_same_motion() {
    let look = look_into(&coarse(), &Options { frames: 1000, ..Options::default() });
    let dt = look.survey.record.time_step_s;
    let frames = &look.capture.frames;
    assert_eq!(frames.len(), look.capture.face.len(), "no more frames than steps");
    let fastest = frames.iter().flat_map(|frame| &frame.velocity_m_s).map(|v| v.abs()).fold(0.0, f64::max);
    assert!(fastest > 0.1, "{fastest} m/s");
    for pair in frames.windows(2) {
        assert!((pair[1].time_s - pair[0].time_s - dt).abs() < 1e-3 * dt);
        for ((before, after), velocity) in pair[0].u_m.iter().zip(&pair[1].u_m).zip(&pair[1].velocity_m_s) {
            // Displacements of some µm round, and their difference is over a step.
            let rounding = 4.0 * f64::EPSILON * before.abs().max(after.abs()) / dt + 1e-12 * fastest;
            let difference = (after - before) / dt - velocity;
            assert!(
                difference.abs() <= rounding,
                "{before} {after} {velocity}: {difference:e} > {rounding:e}"
            );
        }
    }
}

/// Protects: a job without cycles can be looked into as well, and is said to have none; all its files are there.
#[test]
fn stable_sliding_has_no_cycles() {
    let mut spec = coarse();
    spec.scene.contact.mu = 0.1;
    let look = look_into(&spec, &Options::default());
    assert_eq!(look.survey.record.regime, Regime::Stable);
    let summary = Summary::of(&look);
    assert!(
        !summary.cycles && summary.waves.separation_s.is_none() && summary.nodes[0].frequency_hz.is_none()
    );
    assert_eq!(summary.nodes[0].shares, [0.0, 1.0, 0.0]);
    let folder = tempfile::tempdir().unwrap();
    let files = write(&look, folder.path(), &Origin::default()).unwrap();
    assert!(files.iter().all(|file| file.is_file()));
    let page = std::fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(page.contains("no limit cycle"), "the page says so");
}

/// Protects: nodes by name and by coordinates, and the job's own figures of the two that it always observes.
#[test]
fn any_node_can_be_observed() {
    let places = ["centre", "-6,7.5", "front_centre"].map(|text| Place::parse(text).unwrap()).to_vec();
    let look = look_into(&coarse(), &Options { places, ..Options::default() });
    let names: Vec<_> = look.observed.iter().map(|observed| observed.node.name.as_str()).collect();
    assert_eq!(names, ["centre", "x-6.000_y+7.500mm", "front_centre"]);
    let found = Summary::of(&look).nodes[2].clone();
    let recorded = &look.survey.record.nodes[0];
    assert_eq!(recorded.name, "front_centre");
    // Extremes of four cycles are within those of twenty, which repeat within what the job tolerates.
    let tolerated = coarse().detection.tolerance;
    for (shown, all) in [
        (found.peak_to_peak_m[1], recorded.y_peak_to_peak_m),
        (found.lift_max_m, recorded.lift_max_m),
        (found.sigma_n_max_pa, recorded.sigma_n_max_pa),
        (found.slip_speed_max_m_s, recorded.slip_speed_max_m_s),
    ] {
        assert!(shown <= all && shown > (1.0 - 2.0 * tolerated) * all, "{shown} of {all}");
    }
    let off = Options { places: vec![Place::parse("0,8").unwrap()], ..Options::default() };
    let error = Look::into(&coarse(), &off, &mut |_| ControlFlow::Continue(())).unwrap_err();
    assert!(matches!(&error, LookError::Place(text) if text.contains("0,8 mm")), "{error}");
}

/// Protects: a look can be stopped in either run.
#[test]
fn a_look_can_be_interrupted() {
    for run_to_stop in [1, 2] {
        let (mut run, mut last_s) = (1, 0.0);
        let found = Look::into(&coarse(), &Options::default(), &mut |simulated_s| {
            run += u32::from(simulated_s < last_s);
            last_s = simulated_s;
            if run == run_to_stop && simulated_s > 1e-3 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        assert!(matches!(found, Err(LookError::Job(JobError::Interrupted))));
        assert_eq!(run, run_to_stop);
    }
}

/// Protects: jobs on an elastic disk, where a node that sticks moves with a surface that itself moves: by less than
/// it slips, and not by nothing.
#[test]
fn an_elastic_disk_moves_under_sticking_nodes() {
    let mut spec = coarse();
    spec.scene.disk.kind = DiskKind::Elastic;
    spec.scene.disk.ring.element_size_m = 0.005;
    let look = look_into(&spec, &Options { frames: 16, ..Options::default() });
    assert_eq!(look.survey.record, look.capture.record);
    let node = &Summary::of(&look).nodes[0];
    assert!(
        node.stick_speed_error_m_s > 0.0 && node.stick_speed_error_m_s < 0.1 * node.slip_speed_max_m_s,
        "{node:?}"
    );
}

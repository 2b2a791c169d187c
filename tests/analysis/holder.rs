//! The motion of a holder in samples and in the record.

use std::ops::ControlFlow;
use tribosweep::analysis::sample::HolderSample;
use tribosweep::analysis::{self, JobObserver, Moment};
use tribosweep::spec::JobSpec;

#[derive(Default)]
struct Motions(Vec<(f64, [HolderSample; 3])>);

impl JobObserver for Motions {
    fn step(&mut self, moment: &Moment<'_>) {
        self.0.push((moment.sample.time_s, moment.sample.holder));
    }

    fn needs_run(&self) -> bool {
        true
    }

    fn progress(&mut self, _: f64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

fn spec() -> JobSpec {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = [6, 8, 5];
    spec.scene.clamp.width_m = 0.002;
    spec.run.limit_s = 0.004;
    spec.run.stop_early = false;
    spec
}

/// Protects: the record's figures of a holder are those of its samples in the window, in the directions in which it moves. Sums of
/// some thousand squares in another order differ by their roundings.
#[test]
fn the_record_has_the_motion_of_the_holder() {
    let mut spec = spec();
    spec.scene.holder.mass_kg = Some(0.01);
    spec.scene.holder.stiffness_y_n_m = Some(1.0e7);
    spec.scene.holder.stiffness_z_n_m = Some(0.0);
    let mut seen = Motions::default();
    let record = analysis::solve(&spec, &mut seen).unwrap();
    let directions: Vec<_> = record.holder.iter().map(|motion| motion.direction.as_str()).collect();
    assert_eq!(directions, ["y", "z"]);
    for (motion, axis) in record.holder.iter().zip([1, 2]) {
        let in_window = || seen.0.iter().filter(|(time_s, _)| *time_s >= record.window_start_s);
        let of = |value: fn(&HolderSample) -> f64| in_window().map(move |(_, all)| value(&all[axis]));
        let displacements = || of(|holder| holder.displacement_m);
        let [low, high] = [
            displacements().fold(f64::INFINITY, f64::min),
            displacements().fold(f64::NEG_INFINITY, f64::max),
        ];
        assert_eq!(motion.peak_to_peak_m, high - low);
        assert!(motion.peak_to_peak_m > 0.0);
        let squares: f64 = of(|holder| holder.acceleration_m_s2.powi(2)).sum();
        let rms = (squares / in_window().count() as f64).sqrt();
        let error = (motion.acceleration_rms_m_s2 / rms - 1.0).abs();
        assert!(error < 1.0e-10, "{error:e}");
    }
    // The acceleration is the second difference of the displacement, to the rounding of displacements over Δt².
    let [_, y, _] = spec.scene.holder.directions().map(|direction| direction.is_some());
    assert!(y);
    let dt = record.time_step_s;
    for window in seen.0.windows(3).skip(1) {
        let [before, now, after] = [0, 1, 2].map(|at| window[at].1[1].displacement_m);
        let second = (after - 2.0 * now + before) / (dt * dt);
        let rounding = 16.0 * f64::EPSILON * now.abs().max(after.abs()) / (dt * dt);
        let difference = (second - window[1].1[1].acceleration_m_s2).abs();
        assert!(difference <= rounding, "{difference:e} of {rounding:e}");
    }
}

/// Protects: an ideal holder has no figures, and its record is that of versions without them.
#[test]
fn an_ideal_holder_has_no_motion() {
    let mut seen = Motions::default();
    let record = analysis::solve(&spec(), &mut seen).unwrap();
    assert!(record.holder.is_empty());
    assert!(!serde_json::to_string(&record).unwrap().contains("holder"));
    assert!(seen.0.iter().all(|(_, holder)| *holder == [HolderSample::default(); 3]));
}

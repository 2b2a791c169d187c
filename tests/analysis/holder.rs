//! The motion of a holder in samples and in the record.

use std::ops::ControlFlow;
use tribosweep::analysis::figures::Figures;
use tribosweep::analysis::sample::{HolderSample, Sample};
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

/// Protects: the record has the figures of a holder in the directions in which it moves. The window can begin and end within a
/// step, so its extremes are within those of the steps from the one before it on.
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
        let first_s = record.window_start_s - record.time_step_s;
        let in_window = || seen.0.iter().filter(|(time_s, _)| *time_s >= first_s).map(|(_, all)| all[axis]);
        let high = in_window().fold(f64::NEG_INFINITY, |most, holder| most.max(holder.displacement_m));
        let low = in_window().fold(f64::INFINITY, |least, holder| least.min(holder.displacement_m));
        let strongest = in_window().fold(0.0_f64, |most, holder| most.max(holder.acceleration_m_s2.abs()));
        assert!(motion.peak_to_peak_m > 0.0 && motion.peak_to_peak_m <= high - low, "{motion:?}");
        let rms = motion.acceleration_rms_m_s2;
        assert!(rms > 0.0 && rms <= strongest, "{motion:?}, {strongest}");
    }
    // The acceleration is the second difference of the displacement, to the rounding of displacements over Δt².
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

/// Protects: peak to peak and root mean square, with weights, in every direction. Eight numbers have a few roundings.
#[test]
fn figures_of_a_holder_are_extremes_and_a_root_mean_square() {
    let mut figures = Figures::EMPTY;
    let (mut squares, mut weights) = ([0.0; 3], 0.0);
    for step in 0..8 {
        let weight = if step == 0 { 0.25 } else { 1.0 };
        let at = |axis: usize| f64::from(step) * (axis as f64 + 1.0);
        let holder = [0, 1, 2]
            .map(|axis| HolderSample { displacement_m: at(axis) - 3.0, acceleration_m_s2: 10.0 - at(axis) });
        figures.add(&Sample { holder, ..Sample::default() }, weight);
        weights += weight;
        for axis in 0..3 {
            squares[axis] += weight * (10.0 - at(axis)).powi(2);
        }
    }
    for (axis, squares) in squares.into_iter().enumerate() {
        let [peak_to_peak_m, rms] = figures.holder(axis);
        assert_eq!(peak_to_peak_m, 7.0 * (axis as f64 + 1.0));
        assert!((rms / (squares / weights).sqrt() - 1.0).abs() < 8.0 * f64::EPSILON, "{rms}");
    }
}

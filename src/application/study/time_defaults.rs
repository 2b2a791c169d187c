//! Durations that nobody gives: those of the reference scene, in proportion to the pin's own times.

use crate::spec::{JobSpec, RunControl, Scene};

/// The fields.
pub(super) const FIELDS: [&str; 3] = ["limit_s", "decay_observation_s", "ramp_s"];

/// Sets the run's time limit, the observation of a decay and the load's ramp, except for those that something else `gives`
/// by name. They have three significant digits. For the pin of the reference scene they are 0.04, 0.008 and 0.0005 s.
///
/// A run with a program lasts until its last point.
///
/// A ramp that nobody gives must not be what makes a job unusable: where it would be longer than a given time limit, it is
/// half of that limit.
pub(super) fn fill(job: &mut JobSpec, gives: impl Fn(&str) -> bool) {
    let defaults = JobSpec::default();
    let scale = scale(&job.scene);
    if !gives("limit_s") {
        // A program without a time above 0 is refused itself.
        let limit_s = job.scene.program.end_s().filter(|end_s| *end_s > 0.0);
        let limit_s = limit_s.unwrap_or_else(|| three_digits(defaults.run.limit_s * scale));
        job.run.limit_s = limit_s.min(RunControl::LONGEST_LIMIT_S);
    }
    if !gives("decay_observation_s") {
        job.detection.decay_observation_s = three_digits(defaults.detection.decay_observation_s * scale);
    }
    if !gives("ramp_s") {
        let (ramp_s, limit_s) = (three_digits(defaults.scene.load.ramp_s * scale), job.run.limit_s);
        // An unusable limit is refused itself.
        let fits = ramp_s < limit_s || limit_s <= 0.0;
        job.scene.load.ramp_s = if fits { ramp_s } else { three_digits(limit_s / 2.0) };
    }
}

/// How much slower than the reference pin under such a clamp a pin vibrates; 1 for an unphysical pin, which is refused
/// itself.
fn scale(scene: &Scene) -> f64 {
    let reference = Scene { clamp: scene.clamp.clone(), ..Scene::default() };
    let scale = scene.vibration_time_s() / reference.vibration_time_s();
    if scale.is_normal() && scale > 0.0 { scale } else { 1.0 }
}

/// The value rounded to three significant digits.
fn three_digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::ClampSide;

    /// Protects: the reference scene keeps its bits under every clamp, and the times are as many times longer as the pin is
    /// slower: four times for twice the size and half the wave speed.
    #[test]
    fn times_are_in_proportion_to_the_pin() {
        let filled = |change: fn(&mut JobSpec), side: ClampSide| {
            let mut job = JobSpec::default();
            job.scene.clamp.side = side;
            change(&mut job);
            fill(&mut job, |_| false);
            [job.run.limit_s, job.detection.decay_observation_s, job.scene.load.ramp_s]
        };
        for &side in ClampSide::ALL {
            assert_eq!(filled(|_| {}, side), [0.04, 0.008, 0.0005], "{}", side.name());
            let slow = |job: &mut JobSpec| {
                job.scene.pin.size_m = job.scene.pin.size_m.map(|edge_m| 2.0 * edge_m);
                job.scene.pin.young_modulus_pa /= 4.0;
            };
            assert_eq!(filled(slow, side), [0.16, 0.032, 0.002], "{}", side.name());
        }
        let stiffer = filled(|job| job.scene.pin.young_modulus_pa *= 100.0, ClampSide::InnerSide);
        assert_eq!(stiffer, [0.004, 0.0008, 0.00005]);
    }

    /// Protects: a slender pin, whose bending is slower than any wave, gets times in proportion to it. A blade bends in its
    /// plane only where a strip across it is clamped.
    #[test]
    fn a_slender_pin_gets_longer_times() {
        let limit_s = |size_m, side| {
            let mut job = JobSpec::default();
            job.scene.pin.size_m = size_m;
            job.scene.clamp.side = side;
            fill(&mut job, |_| false);
            job.run.limit_s
        };
        // ℓ²/h = 450 mm instead of the reference pin's 15 mm.
        assert_eq!(limit_s([0.002, 0.006, 0.03], ClampSide::WholeTop), 1.2);
        assert_eq!(limit_s([0.03, 0.002, 0.002], ClampSide::InnerSide), 1.2);
        assert_eq!(limit_s([0.03, 0.002, 0.002], ClampSide::WholeTop), 0.08);
    }

    /// Protects: what is given stays, and a ramp that nobody gives fits a given limit.
    #[test]
    fn given_times_stay() {
        let mut job = JobSpec::default();
        job.scene.pin.young_modulus_pa = 1.0e6;
        job.run.limit_s = 0.01;
        fill(&mut job, |name| name == "limit_s");
        assert_eq!((job.run.limit_s, job.scene.load.ramp_s), (0.01, 0.005));
        assert_eq!(job.detection.decay_observation_s, 0.253);
        // The longest limit is that of the check.
        job.scene.pin.young_modulus_pa = 1.0;
        fill(&mut job, |_| false);
        assert_eq!(job.run.limit_s, 100.0);
        job.check().unwrap();
    }
}

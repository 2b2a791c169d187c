//! The projection of a trial force on the friction cone, which all laws share.
//!
//! ```text
//! |t| ≤ limit      stick:  t is the force that stops the relative motion
//! |t| = limit      slip:   t opposes the relative motion
//! ```

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use crate::solver::real::Real;

/// Friction of one node, or of the nodes of a vector.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct Friction<R: Real> {
    /// Components of the friction force \[N\], x and y.
    pub force_n: [R; 2],
    /// Which nodes stick.
    pub sticks: R::Mask,
}

/// Projects the trial force \[N\] (the force that would stop all relative motion) on the disk of the radius
/// `limit_n`, which is not negative.
///
/// With an isotropic mass the projection along the trial force is the exact solution: the remaining relative motion
/// is parallel to the trial force, so friction opposes the slip.
#[inline(always)]
pub(in crate::solver) fn project<R: Real>(trial_n: [R; 2], limit_n: R) -> Friction<R> {
    let trial = (trial_n[0] * trial_n[0] + trial_n[1] * trial_n[1]).root();
    let sticks = trial.at_most(limit_n);
    let scale = limit_n / trial;
    Friction {
        force_n: [
            R::choose(sticks, trial_n[0], trial_n[0] * scale),
            R::choose(sticks, trial_n[1], trial_n[1] * scale),
        ],
        sticks,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::simd::dispatch;
    use fearless_simd::{f64x8, prelude::*};

    /// Projects eight nodes with the same numbers. Returns the result of the first.
    fn project_eight(trial_n: [f64; 2], limit_n: f64) -> ([f64; 2], bool) {
        dispatch!(simd => {
            let all = |value| f64x8::splat(simd, value);
            let friction = project([all(trial_n[0]), all(trial_n[1])], all(limit_n));
            (friction.force_n.map(|force| force[0]), friction.sticks.test(0))
        })
    }

    /// Protects: a trial force inside the cone is not changed; one outside is scaled to the cone.
    #[test]
    fn inside_sticks_outside_slips_on_the_cone() {
        assert_eq!(project_eight([0.3, -0.4], 0.5), ([0.3, -0.4], true));
        let (force, sticks) = project_eight([3.0, -4.0], 0.5);
        assert!(!sticks);
        assert!((force[0] - 0.3).abs() < 1e-15 && (force[1] + 0.4).abs() < 1e-15);
    }

    /// Protects: without friction no force is transmitted, and a node without slip gives no 0/0.
    #[test]
    fn limits_are_finite() {
        assert_eq!(project_eight([1.0, 0.0], 0.0), ([0.0, 0.0], false));
        assert_eq!(project_eight([0.0, 0.0], 2.0), ([0.0, 0.0], true));
        assert_eq!(project_eight([0.0, 0.0], 0.0).0, [0.0, 0.0]);
    }

    /// The force in the disk that is nearest to the trial force, found by a search. It is the trial force if that
    /// is in the disk. Otherwise it is the best of a fan of directions on the rim, and the fan is refined around
    /// the best one.
    fn nearest_in_the_disk(trial_n: [f64; 2], limit_n: f64) -> [f64; 2] {
        let distance = |t: [f64; 2]| libm::hypot(t[0] - trial_n[0], t[1] - trial_n[1]);
        if libm::hypot(trial_n[0], trial_n[1]) <= limit_n {
            return trial_n;
        }
        let on_rim = |angle: f64| [limit_n * libm::cos(angle), limit_n * libm::sin(angle)];
        let (mut middle, mut half_width) = (0.0, std::f64::consts::PI);
        while half_width > 1e-9 {
            let fan = (-50..=50).map(|i| middle + half_width * f64::from(i) / 50.0);
            middle = fan.min_by(|a, b| distance(on_rim(*a)).total_cmp(&distance(on_rim(*b)))).unwrap();
            half_width /= 20.0;
        }
        on_rim(middle)
    }

    /// Protects: the projection is the nearest force of the disk, in all directions, near the rim and far from it.
    /// One node and eight nodes give the same bits.
    #[test]
    fn the_projection_is_the_nearest_force() {
        for i in 0..48 {
            let angle = 0.1 + std::f64::consts::TAU * f64::from(i) / 48.0;
            for length in [0.0, 1e-7, 0.7, 0.999, 1.001, 3.0, 1e5] {
                for limit_n in [0.0, 0.4, 1.0] {
                    let trial_n = [length * libm::cos(angle), length * libm::sin(angle)];
                    let (force, sticks) = project_eight(trial_n, limit_n);
                    let one = project(trial_n, limit_n);
                    assert_eq!(
                        (one.force_n.map(f64::to_bits), one.sticks),
                        (force.map(f64::to_bits), sticks)
                    );
                    let nearest = nearest_in_the_disk(trial_n, limit_n);
                    // Rounding changes the distance d by εd. A turn by an angle δ changes d by TLδ²/(2d). So the
                    // search resolves directions only to δ = √(2ε/TL)d ≤ √(8εT/L), that is forces to √(8εTL).
                    let tolerance = (8.0 * f64::EPSILON * length * limit_n).sqrt() + 2e-9 * limit_n;
                    for c in 0..2 {
                        assert!(
                            (force[c] - nearest[c]).abs() <= tolerance,
                            "{trial_n:?}, {limit_n}: {force:?}, {nearest:?}"
                        );
                    }
                }
            }
        }
    }
}

//! The Coulomb cone, without regularisation.
//!
//! ```text
//! |t| ≤ μN      stick:  t is whatever stops the relative motion
//! |t| = μN      slip:   t opposes the relative motion
//! ```

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use fearless_simd::{Simd, f64x8, mask64x8, prelude::*};

/// Friction on eight nodes.
#[derive(Debug, Clone, Copy)]
pub struct Friction<S: Simd> {
    /// Its components [N].
    pub force_n: [f64x8<S>; 2],
    /// Which nodes stick.
    pub sticks: mask64x8<S>,
}

/// Projects the trial tangential force (the one that would stop all relative motion) on the cone of
/// the normal force `normal_n` ≥ 0. All forces in newton.
///
/// With an isotropic mass the projection along the trial force is the exact solution: what is left
/// of the relative motion is parallel to the trial force, so friction opposes the slip.
#[inline(always)]
pub fn project<S: Simd>(trial_n: [f64x8<S>; 2], normal_n: f64x8<S>, mu: f64x8<S>) -> Friction<S> {
    let limit = mu * normal_n;
    let trial = (trial_n[0] * trial_n[0] + trial_n[1] * trial_n[1]).sqrt();
    let sticks = trial.simd_le(limit);
    let scale = limit / trial;
    Friction {
        force_n: [
            sticks.select(trial_n[0], trial_n[0] * scale),
            sticks.select(trial_n[1], trial_n[1] * scale),
        ],
        sticks,
    }
}

/// [`project`] of one node: the force [N] and whether it sticks.
pub fn project_one(trial_n: [f64; 2], normal_n: f64, mu: f64) -> ([f64; 2], bool) {
    let limit = mu * normal_n;
    let trial = (trial_n[0] * trial_n[0] + trial_n[1] * trial_n[1]).sqrt();
    if trial <= limit { (trial_n, true) } else { (trial_n.map(|t| t * (limit / trial)), false) }
}

/// Friction [N] on a node that slips by `given_m` ≠ 0 in a direction in which it is held, and that a trial
/// force of zero would let slip by `free_m` in the other one, where a force t changes the slip by
/// t/`stiffness_n_m`. It opposes the whole slip, t = −μN s/|s|: components in the held and in the free
/// direction.
///
/// The free slip δ is the root of g(δ) = δ + (μN/k) δ/√(given² + δ²) − free. On the side of `free_m` g
/// increases and is concave, so Newton's method from a point between 0 and the root climbs to it without
/// overshooting.
pub fn oppose(given_m: f64, free_m: f64, stiffness_n_m: f64, normal_n: f64, mu: f64) -> [f64; 2] {
    let limit = mu * normal_n;
    let (reach, aim) = (limit / stiffness_n_m, free_m.abs());
    // Two lower bounds of the root: δ/√(given² + δ²) is at most δ/|given| and at most 1.
    let mut slip = (aim / (1.0 + reach / given_m.abs())).max(aim - reach);
    loop {
        let length = (given_m * given_m + slip * slip).sqrt();
        let residual = slip + reach * slip / length - aim;
        let slope = 1.0 + reach * given_m * given_m / (length * length * length);
        let next = slip - residual / slope;
        // Rounding ends the climb, and so does a number that is not finite.
        if next > slip {
            slip = next;
        } else {
            let scale = -limit / length;
            return [scale * given_m, scale * slip.copysign(free_m)];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::{Level, dispatch};

    /// Protects: the force on a half-held node lies on the cone, opposes the slip that it leaves, and is
    /// found from any side and at any ratio of the slips.
    #[test]
    fn a_half_held_nodes_friction_opposes_its_slip() {
        for given in [1e-9, -0.5, 1.0, 1e6_f64] {
            for free in [0.0, 1e-7, -0.3, 2.0, -1e5_f64] {
                for limit in [0.0, 0.4, 100.0] {
                    let stiffness = 3.0;
                    let force = oppose(given, free, stiffness, limit / 0.5, 0.5);
                    let slip: f64 = free + force[1] / stiffness;
                    let length = given.hypot(slip);
                    // The slip cancels in free + t/k: rounded at the size of these.
                    let rounding =
                        8.0 * f64::EPSILON * (limit + limit * (free.abs() + limit / stiffness) / length);
                    let exact = [-limit * given / length, -limit * slip / length];
                    for c in 0..2 {
                        let error = (force[c] - exact[c]).abs();
                        assert!(error <= rounding, "{given}, {free}, {limit}: {force:?}, not {exact:?}");
                    }
                }
            }
        }
    }

    /// [`super::project`] of one node, and whether it sticks.
    fn project(trial_n: [f64; 2], normal_n: f64, mu: f64) -> ([f64; 2], bool) {
        dispatch!(Level::new(), simd => {
            let all = |value| f64x8::splat(simd, value);
            let friction = super::project([all(trial_n[0]), all(trial_n[1])], all(normal_n), all(mu));
            (friction.force_n.map(|force| force[0]), friction.sticks.test(0))
        })
    }

    /// Protects: inside the cone the force is untouched, outside it lies on the cone along the trial.
    #[test]
    fn inside_sticks_outside_slips_on_the_cone() {
        assert_eq!(project([0.3, -0.4], 2.0, 0.25), ([0.3, -0.4], true));
        let (force, sticks) = project([3.0, -4.0], 2.0, 0.25);
        assert!(!sticks);
        assert!((force[0] - 0.3).abs() < 1e-15 && (force[1] + 0.4).abs() < 1e-15);
    }

    /// Protects: without friction nothing is transmitted, and a node that is exactly still has no 0/0.
    #[test]
    fn limits_are_finite() {
        assert_eq!(project([1.0, 0.0], 5.0, 0.0), ([0.0, 0.0], false));
        assert_eq!(project([0.0, 0.0], 5.0, 0.4), ([0.0, 0.0], true));
        assert_eq!(project([0.0, 0.0], 5.0, 0.0).0, [0.0, 0.0]);
    }
}

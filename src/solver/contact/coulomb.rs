//! The Coulomb cone, without regularisation.
//!
//! ```text
//! |t| ≤ μN      stick:  t is whatever stops the relative motion
//! |t| = μN      slip:   t opposes the relative motion
//! ```

use super::ContactState;

/// Projects the trial tangential force (the one that would stop all relative motion) on the cone of
/// the normal force `normal_n` ≥ 0. All forces in newton.
///
/// With an isotropic mass the projection along the trial force is the exact solution: what is left
/// of the relative motion is parallel to the trial force, so friction opposes the slip.
pub fn project(trial_n: [f64; 2], normal_n: f64, mu: f64) -> ([f64; 2], ContactState) {
    let limit = mu * normal_n;
    let trial = (trial_n[0] * trial_n[0] + trial_n[1] * trial_n[1]).sqrt();
    if trial <= limit {
        return (trial_n, ContactState::Stick);
    }
    let scale = limit / trial;
    ([trial_n[0] * scale, trial_n[1] * scale], ContactState::Slip)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: inside the cone the force is untouched, outside it lies on the cone along the trial.
    #[test]
    fn inside_sticks_outside_slips_on_the_cone() {
        assert_eq!(project([0.3, -0.4], 2.0, 0.25), ([0.3, -0.4], ContactState::Stick));
        let (force, state) = project([3.0, -4.0], 2.0, 0.25);
        assert_eq!(state, ContactState::Slip);
        assert!((force[0] - 0.3).abs() < 1e-15 && (force[1] + 0.4).abs() < 1e-15);
    }

    /// Protects: without friction nothing is transmitted, and a node that is exactly still has no 0/0.
    #[test]
    fn limits_are_finite() {
        assert_eq!(project([1.0, 0.0], 5.0, 0.0), ([0.0, 0.0], ContactState::Slip));
        assert_eq!(project([0.0, 0.0], 5.0, 0.4), ([0.0, 0.0], ContactState::Stick));
        assert_eq!(project([0.0, 0.0], 5.0, 0.0).0, [0.0, 0.0]);
    }
}

//! Whether eigenvalues alone may say that a run decays.
//!
//! Just below the threshold a limit cycle can exist beside stable sliding, and the start of a run decides between them. So
//! eigenvalues decide only at a distance in μ from the threshold: sliding must be stable at μ and at a larger μ
//! ([`further_mu`]). The slower the disk, the lower cycles reach: docs/evidence/eigenvalues.md has the runs.
//!
//! Sliding counts as stable at a point if three things hold there:
//!
//! * the growth rates of the known modes up to [`JUDGED`] of the basis's band are negative by more than their errors, in
//!   continuous time and with the time step of the run; the errors are estimated from the residuals of right and left
//!   eigenvectors,
//! * above that frequency nothing is left unseen: the basis has all modes, or no mode can grow there (`bound`), or a run of the
//!   job on a coarser mesh, which carries such vibrations, decayed, and damping wins: with the largest gain g = (Re λ + βω²/2)/ω
//!   of a known mode, gω < βω²/2; near the end of its band the basis has the modes badly, so that their gains are known but
//!   not their signs,
//! * every number is finite.

use super::sliding::{JUDGED, SlidingPoint};
use std::f64::consts::TAU;

/// The distance from the threshold, over μ, that a fast disk needs.
const DISTANCE: f64 = 0.08;
/// The larger μ is rounded up to a multiple of this, so that points of many speeds share an equilibrium.
const STEP: f64 = 0.01;

/// A larger μ at which sliding must be stable, too.
///
/// `speed` is the disk's speed over the pin's natural speed μp/(ρc_s), at which friction drives shear waves as fast as the
/// disk moves. Cycles were found up to 13 % below the threshold at a speed of 1/20, 5 % at 1/5, and 1 % above 1
/// (docs/evidence/eigenvalues.md). The distance is more than three times as large: 8 % (1 + speed^(−½)), rounded up to a multiple of
/// 0.01.
pub fn further_mu(mu: f64, speed: f64) -> f64 {
    let further = mu * (1.0 + DISTANCE * (1.0 + 1.0 / speed.sqrt()));
    (further / STEP).ceil() * STEP
}

/// What the eigenvalues of a point say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decision {
    /// All modes decay.
    Stable,
    /// A mode grows.
    Unstable,
    /// Errors are larger than the growth rates, or modes beyond the band may grow.
    Open,
}

/// What the eigenvalues of a point say, with a damping α \[1/s\] and β \[s\]. `coarser_decayed`: a run of the job on a coarser mesh
/// decayed.
pub fn verdict(
    point: &SlidingPoint,
    [alpha_r_per_s, damping_s]: [f64; 2],
    coarser_decayed: bool,
) -> Decision {
    let judged_hz = JUDGED * point.band_hz;
    let mut gain: f64 = 0.0;
    let mut verdict = Decision::Stable;
    for mode in &point.modes {
        let (value, in_steps) = (mode.eigenvalue_per_s, mode.eigenvalue_in_steps_per_s);
        let error = mode.growth_error_per_s;
        let [least, most] = [value.re.min(in_steps.re) - error, value.re.max(in_steps.re) + error];
        if least > 0.0 {
            return Decision::Unstable;
        }
        let is_judged = point.has_all_modes || value.im <= TAU * judged_hz;
        // The minimum and the maximum with NaN are the other number.
        let decays = most < 0.0 && value.re.is_finite() && in_steps.re.is_finite();
        if is_judged && !decays {
            verdict = Decision::Open;
        }
        if value.im > 0.0 {
            let growth_per_s = value.re + if is_judged { error } else { 0.0 };
            let undamped_per_s = growth_per_s + alpha_r_per_s / 2.0;
            gain = gain.max(undamped_per_s / value.im + damping_s * value.im / 2.0);
        }
    }
    let is_damped = point.damped_above_hz.is_some_and(|limit_hz| limit_hz <= judged_hz);
    let is_seen = coarser_decayed && 2.0 * gain < damping_s * TAU * judged_hz;
    let is_covered = point.has_all_modes || is_damped || is_seen;
    if point.modes.is_empty() || !is_covered { Decision::Open } else { verdict }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::{Equilibrium, Mode};
    use nalgebra::Complex;

    fn point(modes: &[(f64, f64, f64)], band_hz: f64) -> SlidingPoint {
        let mode = |&(growth_per_s, in_steps_per_s, growth_error_per_s): &(f64, f64, f64)| Mode {
            eigenvalue_per_s: Complex::new(growth_per_s, 1.0e5),
            eigenvalue_in_steps_per_s: Complex::new(in_steps_per_s, 1.0e5),
            residual: 0.0,
            growth_error_per_s,
            is_converged: true,
            shape: Vec::new(),
        };
        let equilibrium = Equilibrium {
            u_m: Vec::new(),
            normal_n: Vec::new(),
            in_contact: Vec::new(),
            disk_z_m: Vec::new(),
            mu: 0.4,
            mu_share: Vec::new(),
            mu_star: 0.4,
        };
        SlidingPoint {
            equilibrium,
            modes: modes.iter().map(mode).collect(),
            band_hz,
            has_all_modes: false,
            damped_above_hz: None,
            basis: 0,
            is_reduced: true,
        }
    }

    /// Protects: only growth rates that are negative by more than their error make sliding stable, in continuous time and in
    /// steps, and one that is positive by more makes it unstable. The error here is 300 1/s.
    #[test]
    fn a_sign_needs_more_than_the_error() {
        let of = |growth_per_s, in_steps_per_s| {
            verdict(
                &point(&[(-500.0, -500.0, 0.0), (growth_per_s, in_steps_per_s, 300.0)], 5.0e4),
                [0.0, 1.0e-6],
                true,
            )
        };
        assert_eq!(of(-310.0, -310.0), Decision::Stable);
        assert_eq!(of(-290.0, -310.0), Decision::Open);
        assert_eq!(of(-310.0, -290.0), Decision::Open);
        assert_eq!(of(310.0, 310.0), Decision::Unstable);
        assert_eq!(of(310.0, 290.0), Decision::Open);
        assert_eq!(of(f64::NAN, -310.0), Decision::Open);
        assert_eq!(verdict(&point(&[], 5.0e4), [0.0, 1.0e-6], true), Decision::Open);
    }

    /// Protects: without enough damping, modes beyond the band of the basis may grow. A mode at 10⁵ rad/s that decays with
    /// 100 1/s has the gain β·10⁵/2 − 10⁻³, which a band of 20 kHz covers for β = 10⁻⁷ s and not for β = 0.
    #[test]
    fn modes_beyond_the_band_must_be_damped() {
        let at =
            |damping_s, band_hz| verdict(&point(&[(-100.0, -100.0, 0.0)], band_hz), [0.0, damping_s], true);
        assert_eq!(at(1.0e-7, 2.0e4), Decision::Stable);
        assert_eq!(at(0.0, 2.0e4), Decision::Open);
        // The gain is 0.004, so 85 % of the band have to reach 2·0.004/10⁻⁷ rad/s = 12.7 kHz.
        assert_eq!(at(1.0e-7, 1.45e4), Decision::Open);
        assert_eq!(at(1.0e-7, 1.55e4), Decision::Stable);
    }

    /// Protects: eigenvalues do not decide by a band beyond which nobody looked. Beyond it must be nothing, or a proof that
    /// nothing grows from 85 % of the band on, or a run on a coarser mesh that decayed.
    #[test]
    fn what_is_beyond_the_band_must_be_known() {
        let mut point = point(&[(-100.0, -100.0, 0.0)], 5.0e4);
        let of = |point: &SlidingPoint, coarser_decayed| verdict(point, [0.0, 1.0e-7], coarser_decayed);
        assert_eq!([of(&point, false), of(&point, true)], [Decision::Open, Decision::Stable]);
        for (damped_above_hz, expected) in [(4.3e4, Decision::Open), (4.2e4, Decision::Stable)] {
            point.damped_above_hz = Some(damped_above_hz);
            assert_eq!(of(&point, false), expected);
        }
        (point.damped_above_hz, point.has_all_modes) = (None, true);
        assert_eq!(of(&point, false), Decision::Stable);
    }

    /// Protects: a mode near the end of the band is not judged by its own growth rate, because the basis does not have it
    /// well, unless the basis has all modes or the mode clearly grows.
    #[test]
    fn modes_near_the_end_of_the_band_are_left_to_damping() {
        // At 15.9 kHz, 80 % and 90 % of the band, with an error larger than the growth rate, beside a judged mode.
        let of = |band_hz, growth_per_s, has_all_modes| {
            let modes = [(-800.0, -800.0, 0.0), (growth_per_s, growth_per_s, 300.0)];
            let mut point = point(&modes, band_hz);
            point.modes[0].eigenvalue_per_s.im = 0.5e5;
            point.has_all_modes = has_all_modes;
            verdict(&point, [0.0, 1.0e-6], true)
        };
        assert_eq!(of(1.59e4 / 0.8, -290.0, false), Decision::Open);
        assert_eq!(of(1.59e4 / 0.9, -290.0, false), Decision::Stable);
        assert_eq!(of(1.59e4 / 0.9, -290.0, true), Decision::Open);
        assert_eq!(of(1.59e4 / 0.9, 400.0, false), Decision::Unstable);
    }

    /// Protects: the slower the disk, the farther from the threshold a job must be. The distances are 16 % and 24 %, and 0.232
    /// and 0.248 are rounded up.
    #[test]
    fn a_slow_disk_needs_a_larger_distance() {
        assert!((further_mu(0.2, 1.0) - 0.24).abs() < 1e-12);
        assert!((further_mu(0.2, 0.25) - 0.25).abs() < 1e-12);
        assert_eq!(further_mu(0.0, f64::INFINITY), 0.0);
    }
}

//! The β₂ method (Newmark with β = 0, γ = β₂; the paper's equation \[2\]).
//!
//! The unknowns are the displacements u_n and p_n = v_{n−1} + (1−β₂)Δt a_{n−1}. The damping α_R M + β_R K of the pin acts on p_n:
//!
//! ```text
//! M a_n   = r_n − K (u_n + β_R p_n) − α_R M p_n + contact forces
//! u_{n+1} = u_n + Δt p_n + (½+β₂) Δt² a_n
//! p_{n+1} = p_n + Δt a_n
//! ```
//!
//! In the first step (n = 0), p_0 is the initial velocity v_0, and the factors of Δt² a and Δt a are ½ and 1−β₂.
//!
//! # Stability
//! For one mode, with W = ωΔt and b = β_R/Δt, the amplification matrix of the recursion has
//!
//! ```text
//! det = 1 − (β₂ − ½ + b) W²        trace = 2 − (½ + β₂ + b) W²
//! ```
//!
//! α_R adds α_R Δt to b W², as any damper c/m does. The recursion is stable while 1 + trace + det ≥ 0, that is **W² (β₂ + b) ≤ 2**, a quadratic inequality in Δt.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::field::in_slots_of;
use super::number::Number;
use fearless_simd::{Simd, prelude::*};

/// How the time step is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeStep {
    /// A fraction of the stability limit.
    FractionOfLimit(f64),
    /// A step \[s\] that is refused if it is above the limit.
    Given(f64),
    /// A step \[s\] that is used without a check, to study what happens above the limit.
    Unchecked(f64),
}

/// The parameters of the method. All bodies share them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scheme {
    /// The parameter β₂, which is Newmark's γ.
    pub beta2: f64,
    /// Stiffness-proportional damping `β_R` \[s\].
    pub beta_r_s: f64,
    /// Mass-proportional damping `α_R` \[1/s\] of the pin.
    pub alpha_r_per_s: f64,
    /// Time step Δt \[s\].
    pub time_step_s: f64,
}

/// Factors of the acceleration in one step of all lanes. The factors of a lane's first step differ from the others.
#[derive(Debug, Clone, Copy)]
pub struct StepFactors<R: Number = f64> {
    /// Time step Δt \[s\].
    pub time_step_s: f64,
    /// Stiffness-proportional damping `β_R` \[s\].
    pub beta_r_s: f64,
    /// Δt \[s\] in the numbers of the fields.
    pub rounded_time_step_s: R,
    /// `β_R` \[s\] in the numbers of the fields.
    pub rounded_beta_r_s: R,
    /// Factor of a in `u_{n+1}` \[s²\], one per slot.
    pub u_scale: R::Row,
    /// Factor of a in `p_{n+1}` \[s\], one per slot.
    pub p_scale: R::Row,
}

impl Scheme {
    /// Factors of Δt² a in `u_{n+1}` and of Δt a in `p_{n+1}`. The first step (n = 0) has its own.
    pub(in crate::solver) fn factors(&self, is_first: bool) -> (f64, f64) {
        if is_first { (0.5, 1.0 - self.beta2) } else { (0.5 + self.beta2, 1.0) }
    }

    /// The factors of a step before which each lane has done `steps_done` steps.
    pub(in crate::solver) fn step_factors<const L: usize, R: Number>(
        &self,
        steps_done: &[u64; L],
    ) -> StepFactors<R> {
        let dt = self.time_step_s;
        let (mut u_scale, mut p_scale) = ([0.0; L], [0.0; L]);
        for lane in 0..L {
            let (u_factor, p_factor) = self.factors(steps_done[lane] == 0);
            (u_scale[lane], p_scale[lane]) = (u_factor * dt * dt, p_factor * dt);
        }
        StepFactors {
            time_step_s: dt,
            beta_r_s: self.beta_r_s,
            rounded_time_step_s: R::from_f64(dt),
            rounded_beta_r_s: R::from_f64(self.beta_r_s),
            u_scale: in_slots_of::<R>(&u_scale),
            p_scale: in_slots_of::<R>(&p_scale),
        }
    }
}

impl<R: Number> StepFactors<R> {
    /// Returns u + Δt p + cΔt² a and p + dΔt a for a = −force/m, where cΔt² and dΔt are the two scales.
    #[inline(always)]
    pub fn moved<S: Simd>(
        &self,
        simd: S,
        force: R::Vector<S>,
        inverse_mass: &R::Row,
        u: &R::Row,
        p: &R::Row,
    ) -> [R::Vector<S>; 2] {
        let load = |row| R::Vector::<S>::load_array_ref(simd, row);
        let a = force * load(inverse_mass);
        let before = load(p);
        let dt = R::Vector::<S>::splat(simd, self.rounded_time_step_s);
        let stroke = before * dt - a * load(&self.u_scale);
        [load(u) + stroke, before - a * load(&self.p_scale)]
    }
}

/// Contribution of one part of a model to the stability limit.
///
/// By Rayleigh's quotient the largest ω² of a sum of parts is at most the sum of their largest ω².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bound {
    /// Upper bound of the angular frequency ω \[rad/s\].
    pub omega_max_rad_s: f64,
    /// Upper bound of c/m \[1/s\] for damping other than `β_R` K.
    pub damping_per_s: f64,
}

impl Bound {
    /// The bound of both parts together: ω² and c/m add up.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            omega_max_rad_s: libm::hypot(self.omega_max_rad_s, other.omega_max_rad_s),
            damping_per_s: self.damping_per_s + other.damping_per_s,
        }
    }

    /// Largest stable time step \[s\]: the positive root of β₂ω²Δt² + (β_Rω² + c/m)Δt = 2.
    pub fn time_step_limit_s(&self, beta2: f64, beta_r_s: f64) -> f64 {
        let omega = self.omega_max_rad_s;
        let mut damping = beta_r_s * omega;
        if self.damping_per_s > 0.0 {
            damping += self.damping_per_s / omega;
        }
        // This form of the root, 2c/(b+√(b²+4ac)), does not cancel when damping is strong.
        4.0 / (omega * (damping + (damping * damping + 8.0 * beta2).sqrt()))
    }
}

/// Largest stable time step \[s\] for modes up to `omega_max` \[rad/s\], with no damping but `β_R` K.
pub fn time_step_limit_s(omega_max: f64, beta2: f64, beta_r_s: f64) -> f64 {
    Bound { omega_max_rad_s: omega_max, damping_per_s: 0.0 }.time_step_limit_s(beta2, beta_r_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the closed form is the limit of the recursion itself, for every β₂ and damping. Just below it a
    /// mode stays bounded, just above it the mode grows.
    #[test]
    fn limit_is_that_of_the_recursion() {
        for beta2 in [0.5, 0.6, 0.8, 1.0] {
            for damping in [0.0, 0.1, 1.0, 10.0] {
                let omega = 3.0e5;
                let beta_r = damping / omega;
                let limit = time_step_limit_s(omega, beta2, beta_r);
                for (factor, bounded) in [(0.999, true), (1.001, false)] {
                    let dt = factor * limit;
                    let (mut u, mut p) = (1.0_f64, 0.0_f64);
                    for _ in 0..100_000 {
                        let a = -omega * omega * (u + beta_r * p);
                        u += dt * p + (0.5 + beta2) * dt * dt * a;
                        p += dt * a;
                        if u.abs() > 1e6 {
                            break;
                        }
                    }
                    assert_eq!(
                        u.abs() < 1e6,
                        bounded,
                        "β₂ = {beta2}, β_R ω = {damping}, {factor} of the limit"
                    );
                }
            }
        }
    }

    /// Protects: a part with a damper of its own keeps its place in the limit. With the stiffnesses and the damper of two
    /// parts on one mode, the recursion stays bounded just below the limit of their sum and grows just above it.
    #[test]
    fn the_limit_of_two_parts_is_that_of_the_recursion() {
        for beta2 in [0.5, 0.8] {
            for (beta_r, damping_per_s) in [(0.0, 1.0e5), (1.0e-6, 3.0e5), (1.0e-6, 0.0)] {
                let body = Bound { omega_max_rad_s: 3.0e5, damping_per_s: 0.0 };
                let both = body.and(Bound { omega_max_rad_s: 2.0e5, damping_per_s });
                let omega_squared = 3.0e5_f64.powi(2) + 2.0e5_f64.powi(2);
                for (factor, bounded) in [(0.999, true), (1.001, false)] {
                    let dt = factor * both.time_step_limit_s(beta2, beta_r);
                    let (mut u, mut p) = (1.0_f64, 0.0_f64);
                    for _ in 0..100_000 {
                        let a = -omega_squared * (u + beta_r * p) - damping_per_s * p;
                        u += dt * p + (0.5 + beta2) * dt * dt * a;
                        p += dt * a;
                        if u.abs() > 1e6 {
                            break;
                        }
                    }
                    let is_bounded = u.abs() < 1e6;
                    assert_eq!(
                        is_bounded, bounded,
                        "β₂ = {beta2}, β_R = {beta_r}, c/m = {damping_per_s}: {factor}"
                    );
                }
            }
        }
    }

    /// Protects: the closed form gives the published limits: √(2/β₂) without damping, and (2/ω)(√(1+ξ²) − ξ) for
    /// the damped central difference.
    #[test]
    fn agrees_with_the_published_limits() {
        let omega = 2.0e5;
        for beta2 in [0.5, 0.75, 1.0] {
            let w = omega * time_step_limit_s(omega, beta2, 0.0);
            assert!((w - (2.0 / beta2).sqrt()).abs() < 1e-15 * 4.0);
        }
        for xi in [0.01, 0.5, 3.0_f64] {
            let exact = 2.0 / omega * ((1.0 + xi * xi).sqrt() - xi);
            let limit = time_step_limit_s(omega, 0.5, 2.0 * xi / omega);
            assert!((limit / exact - 1.0).abs() < 1e-14);
        }
    }
}

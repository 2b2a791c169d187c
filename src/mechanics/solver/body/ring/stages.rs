//! Stabilised leapfrog–Chebyshev stages, with which the disk takes the time step of the pin.
//!
//! In one step Δt of the pin the disk makes m stages, each with one product with A = M⁻¹K. Together they are one
//! step of the leapfrog with a filtered acceleration:
//!
//! ```text
//! a = −Ã x + B M⁻¹ f      Δt² Ã = 2 [1 − T_m(ν − sA)/T_m(ν)]      B = Ã A⁻¹      x = u + β_R p
//! ```
//!
//! with Chebyshev's polynomials T_m, ν ≥ 1, and s such that Ã = A − O(A²). B and Ã = B A are polynomials in A. So
//! this is the central difference of the body with the same stiffness K and the mass matrix M̃ = M B⁻¹, which is
//! symmetric and positive. Therefore all properties of the central difference with one step hold:
//! * The energy balance with ½vM̃v + ½uKu is exact.
//! * The displacements of the contact solve meet at t_{n+1}.
//! * The step is stable as long as the eigenvalues of Δt²Ã, at most 2\[1 + 1/T_m(ν)\], are within the limit of
//!   [`scheme`]. This holds up to A = (1+ν)/s, that is for about m times the step of one stage.
//!
//! Static states are exact for any m.
//!
//! Subcycling, in which the two bodies exchange held or interpolated forces, has no such stability. It grows where
//! a multiple of the longer step is in resonance with a mode of the finer body. Here such a mode has B ≈ 0, so
//! contact forces do not drive it.
//!
//! Sources: Diaz and Grote, *Energy conserving explicit local time stepping for second-order wave equations*, SIAM
//! J. Sci. Comput. 31 (2009); Grote, Michel and Sauter, *Stabilized leapfrog based local time-stepping method for
//! the wave equation*, Math. Comp. 90 (2021); Carle, Hochbruck and Sturm, *On leapfrog-Chebyshev schemes*, SIAM J.
//! Numer. Anal. 58 (2020).
//!
//! [`scheme`]: crate::solver::scheme

/// Largest number of stages in a step. A disk that needs more makes the time step shorter.
pub const MAX_STAGES: usize = 4;

/// Fraction of the stability limit of Δt²Ã that the stages use.
const MARGIN: f64 = 0.95;

/// Lower bound of T_m(ν). It keeps Ã positive where T_m(ν − sA) is 1, and it shortens the step by a few percent.
const LEAST_DAMPING: f64 = 1.05;

/// One stage: d ← α d − γ d_before − σ A (x + d).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage {
    /// Factor α of d.
    pub own: f64,
    /// Factor γ of the previous d.
    pub before: f64,
    /// Factor σ \[s²\] of A (x + d).
    pub force_s2: f64,
}

/// The stages of one step. After the last one Δt² a = 2 d.
#[derive(Debug, Clone, PartialEq)]
pub struct Stages {
    stages: Vec<Stage>,
    /// Largest eigenvalue \[1/s²\] of A for which the stages are stable.
    largest_per_s2: f64,
}

impl Stages {
    /// `count` stages in a step with the damping β_R. `None` if the damping alone is too strong for stability.
    pub fn new(count: usize, time_step_s: f64, beta_r_s: f64) -> Option<Self> {
        let m = count as f64;
        // ω̃²(½Δt² + β_RΔt) ≤ 2, with ω̃²Δt² = 2(1 + 1/T_m(ν)).
        let damping = 0.5 + beta_r_s / time_step_s;
        if count == 1 {
            let force_s2 = 0.5 * time_step_s * time_step_s;
            let stage = Stage { own: 1.0, before: 0.0, force_s2 };
            let largest = 2.0 * MARGIN / (damping * time_step_s * time_step_s);
            return Some(Self { stages: vec![stage], largest_per_s2: largest });
        }
        let room = MARGIN / damping - 1.0;
        if room <= 0.0 {
            return None;
        }
        let top = (1.0 / room).max(LEAST_DAMPING);
        let angle = libm::acosh(top) / m;
        let nu = libm::cosh(angle);
        // T_m′(ν) = m U_{m−1}(ν).
        let slope = m * libm::sinh(m * angle) / libm::sinh(angle);
        let s = 0.5 * time_step_s * time_step_s * top / slope;
        let tau = |k: usize| libm::cosh(k as f64 * angle);
        let stages = (0..count)
            .map(|k| match k {
                0 => Stage { own: 1.0, before: 0.0, force_s2: s / nu },
                _ => Stage {
                    own: 2.0 * nu * tau(k) / tau(k + 1),
                    before: tau(k - 1) / tau(k + 1),
                    force_s2: 2.0 * s * tau(k) / tau(k + 1),
                },
            })
            .collect();
        Some(Self { stages, largest_per_s2: (1.0 + nu) / s })
    }

    /// The fewest stages, up to `most`, that are stable for eigenvalues of A up to `largest_per_s2`.
    pub fn fewest(largest_per_s2: f64, most: usize, time_step_s: f64, beta_r_s: f64) -> Option<Self> {
        (1..=most)
            .filter_map(|count| Self::new(count, time_step_s, beta_r_s))
            .find(|stages| largest_per_s2 <= stages.largest_per_s2)
    }

    /// The longest step \[s\] for which [`Stages::fewest`] finds stages.
    pub fn longest_step_s(largest_per_s2: f64, most: usize, beta_r_s: f64) -> f64 {
        let works = |dt: f64| Self::fewest(largest_per_s2, most, dt, beta_r_s).is_some();
        // If a step is stable, a shorter one need not be, because damping weighs more in it. So the search starts
        // from above. Its start is an upper bound, because m stages allow less than m times the undamped step of
        // one stage.
        let mut high = 2.0 * most as f64 / largest_per_s2.sqrt();
        let mut low = high;
        while !works(low) {
            (high, low) = (low, low * 0.98);
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            *(if works(middle) { &mut low } else { &mut high }) = middle;
        }
        low
    }

    /// The stages in their order.
    pub fn stages(&self) -> &[Stage] {
        &self.stages
    }

    /// Number of stages.
    pub fn count(&self) -> usize {
        self.stages.len()
    }

    /// Δt² Ã and B of a mode with the eigenvalue A \[1/s²\].
    pub fn of_mode(&self, time_step_s: f64, a_per_s2: f64) -> [f64; 2] {
        let [mut d, mut before] = [0.0, 0.0];
        for stage in &self.stages {
            let next = stage.own * d - stage.before * before - stage.force_s2 * a_per_s2 * (1.0 + d);
            before = d;
            d = next;
        }
        [-2.0 * d, -2.0 * d / (a_per_s2 * time_step_s * time_step_s)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 5.0e-7;

    /// Protects: over the whole range for which stages count as stable, Ã is positive and within the limit of the
    /// damped central difference. B lies in (0, 1], so M̃ is a positive mass, at least as large as M.
    #[test]
    fn every_mode_is_a_stable_oscillator_with_a_positive_mass() {
        for count in 1..=MAX_STAGES {
            for beta_r_s in [0.0, 1.0e-8, 5.0e-8, 1.5e-7] {
                let stages = Stages::new(count, DT, beta_r_s).unwrap();
                for n in 1..=10_000 {
                    let a = stages.largest_per_s2 * f64::from(n) / 1.0e4;
                    let [stiffness, filter] = stages.of_mode(DT, a);
                    let limit = 2.0 / (0.5 + beta_r_s / DT);
                    assert!(stiffness > 0.0 && stiffness <= limit, "{count}, {beta_r_s}: {stiffness}");
                    assert!(filter > 0.0 && filter <= 1.0 + 1.0e-9, "{count}, {beta_r_s}: {filter}");
                }
            }
        }
    }

    /// Protects: slow modes are integrated to second order, as by the central difference itself.
    #[test]
    fn slow_modes_are_exact_to_second_order() {
        for count in 1..=MAX_STAGES {
            let stages = Stages::new(count, DT, 5.0e-8).unwrap();
            let error = |w: f64| (stages.of_mode(DT, w * w / (DT * DT))[0] / (w * w) - 1.0).abs();
            if count == 1 {
                assert!(error(0.1) < 1.0e-15);
            } else {
                let ratio = error(0.1) / error(0.05);
                assert!((ratio - 4.0).abs() < 0.05, "{count}: {ratio}");
                // The error constant of the undamped filter is (1 − 1/m²)/12 < 1/12. Damping adds less than twice
                // this.
                assert!(error(0.1) < 0.01 / 4.0);
            }
        }
    }

    /// Protects: the longest step is found where damping is so strong that stages are unstable with some shorter
    /// steps.
    #[test]
    fn strong_damping_does_not_hide_the_longest_step() {
        let (largest_per_s2, beta_r_s) = (1.0e15, 5.0e-8);
        let longest = Stages::longest_step_s(largest_per_s2, MAX_STAGES, beta_r_s);
        let works = |dt: f64| Stages::fewest(largest_per_s2, MAX_STAGES, dt, beta_r_s).is_some();
        assert!(works(longest) && !works(0.5 * longest) && works(0.1 * longest));
        assert!((1..1000).all(|n| !works(longest * (1.0 + 1.0e-3 * f64::from(n)))));
    }

    /// Protects: more stages allow a longer step, nearly in proportion.
    #[test]
    fn stages_lengthen_the_step() {
        let step = |most| Stages::longest_step_s(1.0e13, most, 1.0e-8);
        for most in 2..=MAX_STAGES {
            let ratio = step(most) / step(1);
            assert!(ratio > 0.8 * most as f64 && ratio < 1.05 * most as f64, "{most}: {ratio}");
        }
    }
}

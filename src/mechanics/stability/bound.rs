//! A frequency above which no mode grows.
//!
//! Let q be an eigenvector of λ = σ + iω with σ ≥ 0 and ω > 0, with qᴴMq = 1, and let κ = qᴴK_μq, where K_μ = K − B has the
//! coupling B by friction. With dampers d = qᴴ(D + C)q ≥ 0, the real and the imaginary part of qᴴP(λ)q = 0 are
//!
//! ```text
//! σ² − ω² + σ(β Re κ + d) − ωβ Im κ + Re κ = 0        Im κ (1 + σβ) = −ω (2σ + β Re κ + d)
//! ```
//!
//! Let |Im κ| ≤ γ Re κ for every q. The first equation has no solution unless β² Re κ < 1, and the second one gives
//! ω ≤ γ(1 + σβ)/(β + 2σ/Re κ), which then is at most γ/β. So no mode grows above γ/(2πβ), whatever the mesh, the speed and the
//! contact damping D are.
//!
//! γ is the largest ratio of the skew part of B to K, over one minus the largest ratio of its symmetric part. Both come from a
//! Lanczos iteration in the energy, which finds them from below, so that they are taken [`MARGIN`] times as large. For short waves
//! on a flat base γ is close to μG/(λ + 2G) = μ(1 − 2ν)/(2(1 − ν)): that is the ratio for a half-space that the disk holds in z.

use crate::solver::material::Material;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use std::f64::consts::TAU;

/// Steps of the iteration.
const STEPS: usize = 24;
/// Smallest share (of energies) of a vector that is not in the others.
const INDEPENDENT: f64 = 1.0e-12;
/// What the iteration finds may be too small by this factor: with twice as many steps it changes by less than 2 %.
const MARGIN: f64 = 1.1;

/// Friction as a coupling of displacements: B, its transpose and the inverse of K, in the space that the constraints allow.
pub struct Coupling<'a> {
    pub b: &'a mut dyn FnMut(&[f64]) -> Vec<f64>,
    pub transposed: &'a mut dyn FnMut(&[f64]) -> Vec<f64>,
    pub solve: &'a mut dyn FnMut(&[f64]) -> Vec<f64>,
}

/// γ, from a force with which the iteration begins. None if friction may take all stiffness from a displacement.
pub fn sector(coupling: &mut Coupling<'_>, start: &[f64]) -> Option<f64> {
    let [skew, symmetric] = [-0.5, 0.5].map(|sign| largest(coupling, start, sign));
    let left = 1.0 - MARGIN * symmetric;
    (left > 0.0).then(|| MARGIN * skew / left)
}

/// The frequency \[Hz\] above which no mode grows; none without damping.
pub fn damped_above_hz(sector: f64, damping_s: f64) -> Option<f64> {
    let limit_hz = sector / (TAU * damping_s);
    limit_hz.is_finite().then_some(limit_hz)
}

/// About the smallest frequency \[Hz\] that [`damped_above_hz`] gives: that of a half-space with these elastic constants.
pub fn least_hz(mu: f64, material: &Material, damping_s: f64) -> f64 {
    let shear = material.shear_modulus_pa();
    mu * shear / (material.lame_lambda_pa() + 2.0 * shear) / (TAU * damping_s)
}

/// The largest modulus of an eigenvalue of K⁻¹(B/2 + sign·Bᵀ), with a sign of ± ½.
fn largest(coupling: &mut Coupling<'_>, start: &[f64], sign: f64) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut basis: Vec<[Vec<f64>; 2]> = Vec::new();
    let mut projected = DMatrix::<f64>::zeros(STEPS, STEPS);
    let mut force = start.to_vec();
    for step in 0..STEPS {
        let mut x = (coupling.solve)(&force);
        let before = dot(&x, &force);
        // Vectors are orthogonal in K, whose product with each of them is known.
        for _ in 0..2 {
            for [v, kv] in &basis {
                let share = dot(&x, kv);
                for (to, from) in x.iter_mut().zip(v).chain(force.iter_mut().zip(kv)) {
                    *to -= share * from;
                }
            }
        }
        let left = dot(&x, &force);
        // What is left of a space that has no more vectors is rounding. This is false for NaN, too.
        let goes_on = left > INDEPENDENT * before;
        if !goes_on {
            break;
        }
        let norm = left.sqrt();
        for value in x.iter_mut().chain(&mut force) {
            *value /= norm;
        }
        let [straight, turned] = [(coupling.b)(&x), (coupling.transposed)(&x)];
        let next: Vec<f64> = straight.iter().zip(&turned).map(|(b, t)| 0.5 * b + sign * t).collect();
        basis.push([x, std::mem::replace(&mut force, next)]);
        for (i, [v, _]) in basis.iter().enumerate() {
            projected[(i, step)] = dot(v, &force);
            projected[(step, i)] = (2.0 * sign) * projected[(i, step)];
        }
    }
    let squares = projected.transpose() * &projected;
    let values: DVector<f64> = SymmetricEigen::new(squares).eigenvalues;
    values.max().max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Applies the rows of a 2×2 matrix.
    fn times(rows: [[f64; 2]; 2]) -> impl FnMut(&[f64]) -> Vec<f64> {
        move |x| rows.iter().map(|row| row[0] * x[0] + row[1] * x[1]).collect()
    }

    /// Protects: γ is that of the pencil. With K = diag(1, 4) and B = [[0, a + b], [a − b, 0]], the skew part b and the symmetric
    /// part a have the ratios b/√(1·4) and a/√(1·4) to K. Without damping there is no frequency.
    #[test]
    fn the_sector_is_that_of_the_coupling() {
        let of = |a: f64, b: f64| {
            let mut coupling = Coupling {
                b: &mut times([[0.0, a + b], [a - b, 0.0]]),
                transposed: &mut times([[0.0, a - b], [a + b, 0.0]]),
                solve: &mut times([[1.0, 0.0], [0.0, 0.25]]),
            };
            sector(&mut coupling, &[1.0, 0.3])
        };
        let expected = MARGIN * 0.15 / (1.0 - MARGIN * 0.1);
        assert!((of(0.2, 0.3).unwrap() - expected).abs() < 1.0e-12);
        assert_eq!(of(1.9, 0.3), None);
        assert!((damped_above_hz(0.1, 1.0e-6).unwrap() - 1.0e5 / TAU).abs() < 1.0e-9);
        assert_eq!(damped_above_hz(0.1, 0.0), None);
    }

    /// Protects: a coupling of few nodes has a small space, and rounding after its end adds nothing. Three of forty unknowns are coupled here,
    /// and the sector is that of these three.
    #[test]
    fn an_exhausted_space_adds_nothing() {
        let stiffness = |i: usize| 1.0 + 0.37 * i as f64;
        let entry = |i: usize, j: usize| if i < 3 && j < 3 { 0.05 * (j as f64 - i as f64) } else { 0.0 };
        let apply = |x: &[f64], sign: f64| -> Vec<f64> {
            (0..40).map(|i| (0..40).map(|j| sign * entry(i, j) * x[j]).sum()).collect()
        };
        let mut coupling = Coupling {
            b: &mut |x| apply(x, 1.0),
            transposed: &mut |x| apply(x, -1.0),
            solve: &mut |x| x.iter().enumerate().map(|(i, x)| x / stiffness(i)).collect(),
        };
        let start: Vec<f64> = (0..40).map(|i| libm::sin(1.0 + i as f64)).collect();
        let scaled = |i: usize, j: usize| entry(i, j) / (stiffness(i) * stiffness(j)).sqrt();
        let exact = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| scaled(i, j).powi(2)).iter().sum::<f64>().sqrt();
        let found = sector(&mut coupling, &start).unwrap();
        assert!((found / (MARGIN * exact) - 1.0).abs() < 1.0e-6, "{found} {exact}");
    }

    /// Protects: the bound itself. A system of two unknowns whose coupling has the sector γ is unstable without damping; with
    /// more damping than γ over its frequency both modes decay, as the bound says.
    #[test]
    fn above_the_frequency_damping_wins() {
        // K − B = k [[1, −γ], [γ, 1]] has κ = k(1 ± iγ), and λ² + βκλ + κ = 0.
        let (k, gamma) = (1.0e10, 0.02);
        let growth = |beta: f64| {
            let kappa = nalgebra::Complex::new(k, k * gamma);
            let root = (kappa * kappa * beta * beta - kappa * 4.0).sqrt();
            [root, -root].map(|root| ((root - kappa * beta) / 2.0).re).into_iter().fold(f64::MIN, f64::max)
        };
        let limit = |beta: f64| damped_above_hz(gamma, beta).unwrap();
        let own_hz = k.sqrt() / TAU;
        assert!(growth(1.9e-7) > 0.0 && limit(1.9e-7) > own_hz);
        assert!(growth(2.1e-7) < 0.0 && limit(2.1e-7) < own_hz);
    }
}

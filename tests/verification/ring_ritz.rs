//! Free vibrations of an elastic ring by the Rayleigh–Ritz method; a tool for the other files.
//!
//! For n waves around, u_r and u_z are products of Legendre polynomials in r and z times cos nθ, and u_θ
//! times sin nθ. The total degree is ≤ N (as in J. So, A. W. Leissa, *Three-dimensional vibrations of thick
//! circular and annular plates*, J. Sound Vib. 209, 1998, with algebraic polynomials there). Gauss quadrature
//! with the weight r gives the integrals. The frequencies are upper bounds, and their errors fall
//! exponentially in N. With n = 0, u_θ decouples, and the torsional modes are found together with the others.

use crate::verification::ring_tools::{RADII_M, STEEL, THICKNESS_M};
use nalgebra::{DMatrix, SymmetricEigen};
use std::f64::consts::{PI, TAU};

/// Values and slopes of the Legendre polynomials up to `order` at ξ, normalised by √(2k + 1).
fn legendre(order: usize, xi: f64) -> Vec<[f64; 2]> {
    let mut p = vec![[1.0, 0.0], [xi, 1.0]];
    for k in 1..order {
        let ([last, slope], [before, slope_before], n) = (p[k], p[k - 1], k as f64);
        p.push([
            ((2.0 * n + 1.0) * xi * last - n * before) / (n + 1.0),
            ((2.0 * n + 1.0) * (last + xi * slope) - n * slope_before) / (n + 1.0),
        ]);
    }
    p.iter().enumerate().map(|(k, p)| p.map(|value| value * ((2 * k + 1) as f64).sqrt())).collect()
}

/// Gauss points and weights on [−1, 1].
pub fn gauss(count: usize) -> Vec<[f64; 2]> {
    let norm = ((2 * count + 1) as f64).sqrt();
    (0..count)
        .map(|n| {
            let mut xi = (PI * (n as f64 + 0.75) / (count as f64 + 0.5)).cos();
            // Newton's iteration doubles the correct digits, so fewer iterations lead from two digits to all
            // of them.
            for _ in 0..8 {
                let [p, slope] = legendre(count, xi)[count];
                xi -= p / slope;
            }
            let slope = legendre(count, xi)[count][1] / norm;
            [xi, 2.0 / ((1.0 - xi * xi) * slope * slope)]
        })
        .collect()
}

/// Frequencies [Hz] of the reference ring with n waves around and polynomials up to degree `order`, ascending.
/// `symmetric` to the middle plane: u_r and u_θ are even and u_z is odd in the height above it, or the reverse.
pub fn frequencies_hz(n: usize, order: usize, symmetric: bool) -> Vec<f64> {
    let basis: Vec<[usize; 3]> = (0..3)
        .flat_map(|c| (0..=order).flat_map(move |l| (0..=order - l).map(move |m| [c, l, m])))
        .filter(|[c, _, m]| (m % 2 == 0) == ((*c < 2) == symmetric))
        .collect();
    let (half_width, half_height) = (0.5 * (RADII_M[1] - RADII_M[0]), 0.5 * THICKNESS_M);
    let points = gauss(order + 8);
    let (lambda, shear) = (STEEL.lame_lambda_pa(), STEEL.shear_modulus_pa());
    let count = points.len() * points.len();
    // The rows are strains and displacements at the points, times the roots of their weights in the energies.
    let mut strains = DMatrix::zeros(7 * count, basis.len());
    let mut moved = DMatrix::zeros(3 * count, basis.len());
    let waves = n as f64;
    for (a, [xi, weight_r]) in points.iter().enumerate() {
        let r = RADII_M[0] + half_width * (1.0 + xi);
        let in_r = legendre(order, *xi);
        for (b, [zeta, weight_z]) in points.iter().enumerate() {
            let in_z = legendre(order, *zeta);
            let weight = weight_r * weight_z * r;
            let point = a * points.len() + b;
            for (column, &[c, l, m]) in basis.iter().enumerate() {
                let u = in_r[l][0] * in_z[m][0];
                let (by_r, by_z) =
                    (in_r[l][1] * in_z[m][0] / half_width, in_r[l][0] * in_z[m][1] / half_height);
                // ε_rr, ε_θθ, ε_zz, γ_rθ, γ_θz, γ_zr.
                let strain = match c {
                    0 => [by_r, u / r, 0.0, -waves * u / r, 0.0, by_z],
                    1 => [0.0, waves * u / r, 0.0, by_r - u / r, by_z, 0.0],
                    _ => [0.0, 0.0, by_z, 0.0, -waves * u / r, by_r],
                };
                strains[(7 * point, column)] = (weight * lambda).sqrt() * (strain[0] + strain[1] + strain[2]);
                for (row, value) in strain.iter().enumerate() {
                    let modulus = if row < 3 { 2.0 * shear } else { shear };
                    strains[(7 * point + 1 + row, column)] = (weight * modulus).sqrt() * value;
                }
                moved[(3 * point + c, column)] = (weight * STEEL.density_kg_m3).sqrt() * u;
            }
        }
    }
    let factor = moved.tr_mul(&moved).cholesky().expect("a basis").l();
    let half = factor.solve_lower_triangular(&strains.tr_mul(&strains)).expect("a basis");
    let k = factor.solve_lower_triangular(&half.transpose()).expect("a basis");
    let values = SymmetricEigen::new((&k + k.transpose()) * 0.5).eigenvalues;
    let mut values: Vec<f64> = values.iter().map(|v| v.max(0.0).sqrt() / TAU).collect();
    values.sort_by(f64::total_cmp);
    values
}

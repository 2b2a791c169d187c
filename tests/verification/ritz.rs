//! Free vibrations of an elastic block by the Rayleigh–Ritz method; a tool for the other files.
//!
//! Each displacement component is a sum of products of Legendre polynomials of total degree ≤ N (H. H.
//! Demarest, *Cube-resonance method to determine the elastic constants of solids*, J. Acoust. Soc. Am. 49,
//! 1971; W. M. Visscher et al., *On the normal modes of free vibration of inhomogeneous and anisotropic
//! elastic objects*, J. Acoust. Soc. Am. 90, 1991). All integrals have a closed form. The frequencies are
//! upper bounds for every N and converge exponentially in N.

use crate::verification::modes::{MirrorClass, mirror_sign};
use nalgebra::DMatrix;
use std::f64::consts::TAU;
use tribosweep_mechanics::solver::material::Material;

/// A basis function: component and degrees in x, y and z.
type Basis = (usize, [usize; 3]);

/// ∫ p_k p_l′ dξ over [−1, 1] of orthonormal Legendre polynomials.
fn slope(k: usize, l: usize) -> f64 {
    if k < l && (l - k) % 2 == 1 { (((2 * k + 1) * (2 * l + 1)) as f64).sqrt() } else { 0.0 }
}

/// ∫ p_k′ p_l′ dξ.
fn slopes(k: usize, l: usize) -> f64 {
    (0..k.min(l)).map(|m| slope(m, k) * slope(m, l)).sum()
}

/// Frequencies [Hz] of one mirror class with polynomials up to degree `order`, ascending; rigid ones are 0.
pub fn frequencies_hz(size_m: [f64; 3], material: &Material, order: usize, class: MirrorClass) -> Vec<f64> {
    let degrees = || (0..=order).flat_map(move |l| (0..=order - l).map(move |m| (l, m)));
    let basis: Vec<Basis> = (0..3)
        .flat_map(|c| degrees().flat_map(move |(l, m)| (0..=order - l - m).map(move |n| (c, [l, m, n]))))
        .filter(|(c, degree)| (0..3).all(|a| (degree[a] % 2 == 0) == (mirror_sign(class, a, *c) > 0.0)))
        .collect();
    // ∫ ∂_a f ∂_b g over the block, per volume/8.
    let product = |f: &[usize; 3], a: usize, g: &[usize; 3], b: usize| -> f64 {
        let factors = (0..3).map(|s| match (s == a, s == b) {
            (true, true) => slopes(f[s], g[s]),
            (true, false) => slope(g[s], f[s]),
            (false, true) => slope(f[s], g[s]),
            (false, false) => f64::from(f[s] == g[s]),
        });
        factors.product::<f64>() * 4.0 / (size_m[a] * size_m[b])
    };
    let (lambda, shear) = (material.lame_lambda_pa(), material.shear_modulus_pa());
    let k = DMatrix::from_fn(basis.len(), basis.len(), |row, column| {
        let ((i, f), (j, g)) = (&basis[row], &basis[column]);
        let mut value = lambda * product(f, *i, g, *j) + shear * product(f, *j, g, *i);
        if i == j {
            value += shear * (0..3).map(|a| product(f, a, g, a)).sum::<f64>();
        }
        value / material.density_kg_m3
    });
    let mut values: Vec<f64> = k.symmetric_eigenvalues().iter().map(|v| v.max(0.0).sqrt() / TAU).collect();
    values.sort_by(f64::total_cmp);
    values
}

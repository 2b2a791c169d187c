//! Displacement gradients H = ∂u/∂X and what follows from them, in vectors.
//!
//! Everything is formed from H and not from F = 1 + H: its rounding is then in proportion to the strain, however small that is.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use fearless_simd::{Simd, f64x8, prelude::*};

/// A tensor.
pub(super) type Tensor<S> = [[f64x8<S>; 3]; 3];

/// ∂J/∂F − 1 = (tr H) 1 − Hᵀ + cof H, and J − 1 = tr H + ½((tr H)² − tr H²) + det H.
#[inline(always)]
pub(super) fn cofactor<S: Simd>(h: &Tensor<S>) -> (Tensor<S>, f64x8<S>) {
    let mut cofactor = *h;
    for i in 0..3 {
        let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
        for j in 0..3 {
            let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
            cofactor[i][j] = h[i1][j1] * h[i2][j2] - h[i1][j2] * h[i2][j1];
        }
    }
    let trace = h[0][0] + h[1][1] + h[2][2];
    // The trace of cof H is the second invariant.
    let second = cofactor[0][0] + cofactor[1][1] + cofactor[2][2];
    let third = h[0][0] * cofactor[0][0] + h[0][1] * cofactor[0][1] + h[0][2] * cofactor[0][2];
    let mut change = cofactor;
    for i in 0..3 {
        for j in 0..3 {
            change[i][j] = cofactor[i][j] - h[j][i];
        }
        change[i][i] += trace;
    }
    (change, trace + second + third)
}

/// E = ½(H + Hᵀ + HᵀH).
#[inline(always)]
pub(super) fn green_strain<S: Simd>(simd: S, h: &Tensor<S>) -> Tensor<S> {
    let half = f64x8::splat(simd, 0.5);
    let mut strain = *h;
    for i in 0..3 {
        for j in i..3 {
            let square = h[0][i] * h[0][j] + h[1][i] * h[1][j] + h[2][i] * h[2][j];
            strain[i][j] = half * (h[i][j] + h[j][i] + square);
            strain[j][i] = strain[i][j];
        }
    }
    strain
}

/// (1 + H) S.
#[inline(always)]
pub(super) fn deformed<S: Simd>(h: &Tensor<S>, stress: &Tensor<S>) -> Tensor<S> {
    let mut product = *stress;
    for i in 0..3 {
        for j in 0..3 {
            product[i][j] += h[i][0] * stress[0][j] + h[i][1] * stress[1][j] + h[i][2] * stress[2][j];
        }
    }
    product
}

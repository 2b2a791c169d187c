//! Deformation gradients and what follows from them, in vectors.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use fearless_simd::{Simd, f64x8, prelude::*};

/// A tensor.
pub(super) type Tensor<S> = [[f64x8<S>; 3]; 3];

/// ∂J/∂F, and J.
#[inline(always)]
pub(super) fn cofactor<S: Simd>(f: &Tensor<S>) -> (Tensor<S>, f64x8<S>) {
    let mut cofactor = *f;
    for i in 0..3 {
        let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
        for j in 0..3 {
            let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
            cofactor[i][j] = f[i1][j1] * f[i2][j2] - f[i1][j2] * f[i2][j1];
        }
    }
    let j = f[0][0] * cofactor[0][0] + f[0][1] * cofactor[0][1] + f[0][2] * cofactor[0][2];
    (cofactor, j)
}

/// E = ½(FᵀF − 1).
#[inline(always)]
pub(super) fn green_strain<S: Simd>(simd: S, f: &Tensor<S>) -> Tensor<S> {
    let (half, one) = (f64x8::splat(simd, 0.5), f64x8::splat(simd, 1.0));
    let mut strain = *f;
    for i in 0..3 {
        for j in i..3 {
            let mut sum = f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j];
            if i == j {
                sum -= one;
            }
            strain[i][j] = half * sum;
            strain[j][i] = strain[i][j];
        }
    }
    strain
}

/// a A + b B.
#[inline(always)]
pub(super) fn combined<S: Simd>(a: f64x8<S>, of_a: &Tensor<S>, b: f64x8<S>, of_b: &Tensor<S>) -> Tensor<S> {
    let mut sum = *of_a;
    for i in 0..3 {
        for j in 0..3 {
            sum[i][j] = a * of_a[i][j] + b * of_b[i][j];
        }
    }
    sum
}

/// A B.
#[inline(always)]
pub(super) fn product<S: Simd>(a: &Tensor<S>, b: &Tensor<S>) -> Tensor<S> {
    let mut product = *a;
    for i in 0..3 {
        for j in 0..3 {
            product[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        }
    }
    product
}

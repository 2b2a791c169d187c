//! Displacement gradients H = ∂u/∂X and what follows from them, in vectors.
//!
//! Everything is formed from H and not from F = 1 + H: its rounding is then in proportion to the strain, however small that is.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use fearless_simd::{Simd, f64x8, prelude::*};

/// A tensor.
pub(super) type Tensor<S> = [[f64x8<S>; 3]; 3];

/// The vectors of one value per corner.
pub(super) type Corners<S> = [[f64x8<S>; 3]; 8];

/// Derivatives along the axes of the unit cube, at the four Gauss points across each axis: axis → point → component.
pub(super) type Slopes<S> = [[[f64x8<S>; 3]; 4]; 3];

/// Numbers of a Gauss point: the derivatives ∂ξ_a/∂X_j \[1/m\] in the unit cube, and its volume \[m³\].
pub(super) const OF_POINT: usize = 10;

/// Weights of the near and of the far corner at a Gauss point, along each axis.
const NEAR: f64 = 0.5 + 0.288_675_134_594_812_9;
const FAR: f64 = 0.5 - 0.288_675_134_594_812_9;

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

/// The two axes across one, ascending.
const ACROSS: [[usize; 2]; 3] = [[1, 2], [0, 2], [0, 1]];

/// The number, of the four across an axis, of a Gauss point or of an edge at a corner.
#[inline(always)]
pub(super) fn across(point: usize, axis: usize) -> usize {
    let [b, c] = ACROSS[axis];
    (point >> b & 1) | (point >> c & 1) << 1
}

/// The derivatives of the displacements along the axes of the unit cube.
#[inline(always)]
pub(super) fn slopes_of<S: Simd>(simd: S, u: &Corners<S>, slopes: &mut Slopes<S>) {
    for axis in 0..3 {
        for corner in 0..8 {
            if corner >> axis & 1 == 0 {
                for c in 0..3 {
                    slopes[axis][across(corner, axis)][c] = u[corner | 1 << axis][c] - u[corner][c];
                }
            }
        }
        between(simd, &mut slopes[axis]);
    }
}

/// The forces on the corners of what is at the Gauss points. It is the transpose of [`slopes_of`].
#[inline(always)]
pub(super) fn spread<S: Simd>(simd: S, sums: &mut Slopes<S>, force: &mut Corners<S>) {
    for axis in 0..3 {
        between(simd, &mut sums[axis]);
    }
    for corner in 0..8 {
        for c in 0..3 {
            let mut total = f64x8::splat(simd, 0.0);
            for axis in 0..3 {
                let value = sums[axis][across(corner, axis)][c];
                if corner >> axis & 1 == 0 {
                    total -= value;
                } else {
                    total += value;
                }
            }
            force[corner][c] = total;
        }
    }
}

/// Goes from four edges to the Gauss points between them, or back: the weights are symmetric.
#[inline(always)]
fn between<S: Simd>(simd: S, values: &mut [[f64x8<S>; 3]; 4]) {
    let (near, far) = (f64x8::splat(simd, NEAR), f64x8::splat(simd, FAR));
    for [a, b] in [[0, 1], [2, 3], [0, 2], [1, 3]] {
        for c in 0..3 {
            let (first, second) = (values[a][c], values[b][c]);
            values[a][c] = near * first + far * second;
            values[b][c] = far * first + near * second;
        }
    }
}

/// H at a Gauss point.
#[inline(always)]
pub(super) fn gradient<S: Simd>(
    simd: S,
    number: &impl Fn(usize) -> f64x8<S>,
    slopes: &Slopes<S>,
    point: usize,
) -> Tensor<S> {
    let mut h = [[f64x8::splat(simd, 0.0); 3]; 3];
    for j in 0..3 {
        let at = point * OF_POINT + j;
        let [x, y, z] = [number(at), number(at + 3), number(at + 6)];
        for i in 0..3 {
            h[i][j] = slopes[0][across(point, 0)][i] * x
                + slopes[1][across(point, 1)][i] * y
                + slopes[2][across(point, 2)][i] * z;
        }
    }
    h
}

//! The preconditioner: an operator close to K whose inverse is a product of one-dimensional transforms.
//!
//! Without the couplings of x, y and z, K of a uniform block is a sum of tensor products for each component:
//!
//! ```text
//! A_c = a_x Sx My Mz + a_y Mx Sy Mz + a_z Mx My Sz        a = λ+2G in the component's own direction, otherwise G
//! ```
//!
//! With the eigenvectors of S φ = κ M φ in each direction, A_c is diagonal (Lynch, Rice and Thomas, 1964). By Korn's
//! inequality its condition relative to K does not depend on the mesh. In z the contact plane is held, and the top is held
//! in the tangential components if the whole top is clamped. Other clamps are not in A_c. A small multiple of the mass keeps it regular.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::space::block_of;
use crate::solver::Model;
use crate::solver::body::Freedom;
use crate::solver::field::{Field, Row, WIDTH};
use crate::solver::simd::dispatch;
use fearless_simd::{Simd, f64x8, prelude::*};
use nalgebra::{DMatrix, SymmetricEigen};

/// Eigenvectors of S φ = κ M φ in one direction.
#[derive(Debug, Clone)]
struct Line {
    /// Row → column: value of the eigenvector `column` at the node `row`.
    vectors: Vec<f64>,
    /// The transpose.
    transposed: Vec<f64>,
    /// κ \[1/m²\]; infinite where there is no eigenvector, because a node is held.
    values: Vec<f64>,
}

/// The preconditioner.
#[derive(Debug)]
pub struct Separable {
    nodes: [usize; 3],
    components: [Component; 3],
}

#[derive(Debug)]
struct Component {
    lines: [Line; 3],
    /// Inverse of the eigenvalues of A_c, in the order of nodes.
    inverse: Vec<f64>,
}

/// Shift in units of G(π/2l)², with the pin's height l: about the stiffness that the clamp gives.
const SHIFT: f64 = 0.5;

impl Separable {
    pub fn new(model: &Model) -> Self {
        let (mesh, material) = (block_of(model), model.pin().material());
        let nodes = mesh.nodes_per_axis();
        let size = mesh.element_size_m();
        let (lambda, g) = (material.lame_lambda_pa(), material.shear_modulus_pa());
        let freedoms = model.pin().freedoms();
        let height_m = mesh.size_m()[2];
        let components = [0, 1, 2].map(|c| {
            let is_held = |mut nodes: std::ops::Range<usize>| {
                nodes.all(|node| freedoms[3 * node + c] == Freedom::Fixed)
            };
            let lines = [0, 1, 2].map(|axis| {
                let ends = match axis {
                    2 => [c == 2 || is_held(mesh.bottom_nodes()), is_held(mesh.top_nodes())],
                    _ => [false; 2],
                };
                Line::new(nodes[axis], size[axis], ends)
            });
            let factors: [f64; 3] = std::array::from_fn(|axis| if axis == c { lambda + 2.0 * g } else { g });
            let is_regular = lines[2].values.iter().any(|value| value.is_infinite());
            let shift =
                if is_regular { 0.0 } else { SHIFT * g * (std::f64::consts::FRAC_PI_2 / height_m).powi(2) };
            let mut inverse = Vec::with_capacity(nodes.iter().product());
            for z in &lines[2].values {
                for y in &lines[1].values {
                    for x in &lines[0].values {
                        inverse.push(1.0 / (factors[0] * x + factors[1] * y + factors[2] * z + shift));
                    }
                }
            }
            Component { lines, inverse }
        });
        Self { nodes, components }
    }

    /// y = A⁻¹ x.
    pub fn solve<const L: usize>(&self, x: &Field<L>, y: &mut Field<L>) {
        let line_numbers = self.nodes[0] * L;
        let mut work = vec![0.0; line_numbers * self.nodes[1] * self.nodes[2]];
        for (c, component) in self.components.iter().enumerate() {
            let lines = work.chunks_exact_mut(line_numbers);
            for (line, blocks) in lines.zip(x.blocks().chunks_exact(x.blocks_per_line())) {
                for (numbers, block) in line.chunks_mut(WIDTH).zip(blocks) {
                    copy(numbers, &block.0[c]);
                }
            }
            let mut stride = L;
            for (axis, line) in component.lines.iter().enumerate() {
                dispatch!(simd => transform(simd, &line.transposed, self.nodes[axis], stride, &mut work));
                stride *= self.nodes[axis];
            }
            for (lanes, inverse) in work.chunks_exact_mut(L).zip(&component.inverse) {
                for value in lanes {
                    *value *= inverse;
                }
            }
            for (axis, line) in component.lines.iter().enumerate().rev() {
                stride /= self.nodes[axis];
                dispatch!(simd => transform(simd, &line.vectors, self.nodes[axis], stride, &mut work));
            }
            let blocks_per_line = y.blocks_per_line();
            let lines = work.chunks_exact(line_numbers);
            for (line, blocks) in lines.zip(y.blocks_mut().chunks_exact_mut(blocks_per_line)) {
                for (numbers, block) in line.chunks(WIDTH).zip(blocks) {
                    copy(&mut block.0[c], numbers);
                }
            }
        }
    }
}

impl Line {
    /// The eigenvectors on `nodes` nodes at the distance `h`, of which the first and the last may be held.
    fn new(nodes: usize, h: f64, held: [bool; 2]) -> Self {
        let first = usize::from(held[0]);
        let free = nodes - first - usize::from(held[1]);
        let end = |node: usize| node == 0 || node == nodes - 1;
        let entry = |centre: f64, beside: f64| {
            DMatrix::from_fn(free, free, |i, j| match i.abs_diff(j) {
                0 if end(i + first) => centre / 2.0,
                0 => centre,
                1 => beside,
                _ => 0.0,
            })
        };
        let (stiffness, mass) = (entry(2.0 / h, -1.0 / h), entry(4.0 * h / 6.0, h / 6.0));
        let factor = mass.cholesky().expect("a mass matrix is positive definite").l();
        let half = factor.solve_lower_triangular(&stiffness).expect("a regular factor");
        let both = factor.solve_lower_triangular(&half.transpose()).expect("a regular factor");
        let eigen = SymmetricEigen::new((&both + both.transpose()) * 0.5);
        let vectors =
            factor.transpose().solve_upper_triangular(&eigen.eigenvectors).expect("a regular factor");
        let mut line = Self {
            vectors: vec![0.0; nodes * nodes],
            transposed: vec![0.0; nodes * nodes],
            values: vec![f64::INFINITY; nodes],
        };
        for column in 0..free {
            line.values[column] = eigen.eigenvalues[column].max(0.0);
            for row in 0..free {
                line.vectors[(row + first) * nodes + column] = vectors[(row, column)];
                line.transposed[column * nodes + row + first] = vectors[(row, column)];
            }
        }
        line
    }
}

/// Number of results that are computed together.
const TILE: usize = 4;

/// Copies the numbers that both have. A copy of a whole block, whose length the compiler knows, is not a call.
#[inline(always)]
fn copy(to: &mut [f64], from: &[f64]) {
    if let (Some(to), Some(from)) = (to.first_chunk_mut::<WIDTH>(), from.first_chunk::<WIDTH>()) {
        *to = *from;
    } else {
        let shared = to.len().min(from.len());
        to[..shared].copy_from_slice(&from[..shared]);
    }
}

/// Multiplies every line of `length` numbers, `stride` apart, with a matrix (row → column).
#[inline(always)]
fn transform<S: Simd>(simd: S, matrix: &[f64], length: usize, stride: usize, work: &mut [f64]) {
    let mut lines = vec![Row::<f64>::default(); length];
    for block in work.chunks_exact_mut(stride * length) {
        for first in (0..stride).step_by(WIDTH) {
            let width = WIDTH.min(stride - first);
            for (at, row) in lines.iter_mut().enumerate() {
                let start = first + at * stride;
                copy(&mut row.0, &block[start..start + width]);
            }
            for (tile, rows) in matrix.chunks(TILE * length).enumerate() {
                let mut sums = [f64x8::splat(simd, 0.0); TILE];
                if rows.len() == TILE * length {
                    for (at, value) in lines.iter().enumerate() {
                        let value = f64x8::from_slice(simd, &value.0);
                        for t in 0..TILE {
                            sums[t] += value * f64x8::splat(simd, rows[t * length + at]);
                        }
                    }
                } else {
                    for (t, row) in rows.chunks_exact(length).enumerate() {
                        for (factor, value) in row.iter().zip(&lines) {
                            sums[t] += f64x8::from_slice(simd, &value.0) * f64x8::splat(simd, *factor);
                        }
                    }
                }
                let mut sum = Row::<f64>::default();
                for t in 0..rows.len() / length {
                    let start = first + (tile * TILE + t) * stride;
                    sums[t].store_slice(&mut sum.0);
                    copy(&mut block[start..start + width], &sum.0);
                }
            }
        }
    }
}

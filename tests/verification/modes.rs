//! Free vibrations of a block from the program's own stiffness and lumped mass; a tool for the other files.
//!
//! A block has three mirror planes, so each of its modes is even or odd in every one of them. The
//! eigenproblem is solved separately in each of the eight mirror classes. Modes of one class do not cross as
//! the mesh is refined, so their rank within the class identifies them on every mesh.

use nalgebra::DMatrix;
use std::f64::consts::TAU;
use tribosweep_mechanics::solver::Model;
use tribosweep_mechanics::solver::body::pin::BlockMesh;

/// Per direction +1 where the displacement field is its own mirror image and −1 where it is the
/// reverse of it: u_c(−x_a) = class_a · (−1 if c = a, else 1) · u_c(x_a).
pub type MirrorClass = [f64; 3];

/// All mirror classes.
pub const CLASSES: [MirrorClass; 8] = [
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [-1.0, -1.0, -1.0],
];

/// Sign of the mirror image of component `c` in direction `axis`.
pub fn mirror_sign(class: MirrorClass, axis: usize, c: usize) -> f64 {
    if c == axis { -class[axis] } else { class[axis] }
}

/// A mode: frequency, and shape over all degrees of freedom (φᵀMφ = 1).
pub struct Mode {
    pub frequency_hz: f64,
    pub shape: Vec<f64>,
}

/// The independent degrees of freedom of one mirror class.
struct ClassFreedom {
    /// For every degree of freedom: the independent one that it follows, and the sign.
    follows: Vec<Option<(usize, f64)>>,
    count: usize,
}

fn freedom(mesh: &BlockMesh, class: MirrorClass, held: &dyn Fn(usize) -> bool) -> ClassFreedom {
    let n = mesh.elements();
    let mut number = vec![None; 3 * mesh.node_count()];
    let mut count = 0;
    let mut follows = vec![None; 3 * mesh.node_count()];
    // The longest direction is numbered last, which keeps the band narrow.
    let longest = (0..3).max_by_key(|&a| n[a]).expect("three directions");
    let mut nodes: Vec<usize> = (0..mesh.node_count()).collect();
    nodes.sort_by_key(|&node| mesh.grid_position(node)[longest]);
    for dof in nodes.into_iter().flat_map(|node| 3 * node..3 * node + 3) {
        let c = dof % 3;
        let grid = mesh.grid_position(dof / 3);
        let image: [usize; 3] = std::array::from_fn(|a| grid[a].min(n[a] - grid[a]));
        let signs: [f64; 3] = std::array::from_fn(|a| mirror_sign(class, a, c));
        let still = (0..3).any(|a| 2 * grid[a] == n[a] && signs[a] < 0.0);
        if still || held(dof) {
            continue;
        }
        let leader = 3 * mesh.node(image[0], image[1], image[2]) + c;
        let sign = (0..3).filter(|&a| 2 * grid[a] > n[a]).map(|a| signs[a]).product();
        let index = *number[leader].get_or_insert_with(|| {
            count += 1;
            count - 1
        });
        follows[dof] = Some((index, sign));
    }
    ClassFreedom { follows, count }
}

/// Cholesky's factor of a symmetric positive definite matrix with `band` diagonals below the main one.
struct Banded {
    band: usize,
    /// The rows. The last entry of a row is the diagonal.
    rows: Vec<Vec<f64>>,
}

impl Banded {
    fn factor(mut rows: Vec<Vec<f64>>, band: usize) -> Self {
        for r in 0..rows.len() {
            let (done, rest) = rows.split_at_mut(r);
            let row = &mut rest[0];
            for c in r.saturating_sub(band)..=r {
                let first = r.saturating_sub(band).max(c.saturating_sub(band));
                let (from_r, from_c) = (first + band - r, first + band - c);
                let length = c - first;
                if c == r {
                    let sum: f64 = row[from_r..from_r + length].iter().map(|x| x * x).sum();
                    assert!(row[band] > sum, "positive definite");
                    row[band] = (row[band] - sum).sqrt();
                } else {
                    let other = &done[c];
                    let pairs = row[from_r..from_r + length].iter().zip(&other[from_c..from_c + length]);
                    let sum: f64 = pairs.map(|(a, b)| a * b).sum();
                    row[c + band - r] = (row[c + band - r] - sum) / other[band];
                }
            }
        }
        Self { band, rows }
    }

    fn solve(&self, x: &mut [f64]) {
        let band = self.band;
        for r in 0..x.len() {
            let first = r.saturating_sub(band);
            let sum: f64 = (first..r).map(|c| self.rows[r][c + band - r] * x[c]).sum();
            x[r] = (x[r] - sum) / self.rows[r][band];
        }
        for r in (0..x.len()).rev() {
            x[r] /= self.rows[r][band];
            for c in r.saturating_sub(band)..r {
                x[c] -= self.rows[r][c + band - r] * x[r];
            }
        }
    }
}

/// The `count` lowest modes of one mirror class, rigid motions included, by inverse subspace iteration
/// shifted by `shift_hz` below zero. `held` degrees of freedom do not move.
pub fn lowest_modes(
    model: &Model,
    rows: &[Vec<(usize, f64)>],
    class: MirrorClass,
    count: usize,
    shift_hz: f64,
    held: &dyn Fn(usize) -> bool,
) -> Vec<Mode> {
    let ClassFreedom { follows, count: size } = freedom(model.mesh().block().unwrap(), class, held);
    let mut mass = vec![0.0; size];
    let mut stiffness = vec![Vec::<(usize, f64)>::new(); size];
    let mut band = 0;
    for (dof, follow) in follows.iter().enumerate() {
        let Some((r, sign)) = *follow else { continue };
        mass[r] += model.pin().masses_kg()[dof / 3];
        for &(column, value) in &rows[dof] {
            let Some((c, other)) = follows[column] else { continue };
            stiffness[r].push((c, sign * other * value));
            band = band.max(r.abs_diff(c));
        }
    }
    let shift = (TAU * shift_hz).powi(2);
    let mut shifted = vec![vec![0.0; band + 1]; size];
    for r in 0..size {
        shifted[r][band] += shift * mass[r];
        for &(c, value) in &stiffness[r] {
            if c <= r {
                shifted[r][c + band - r] += value;
            }
        }
    }
    let factor = Banded::factor(shifted, band);
    let width = (2 * count + 4).min(size);
    let mut block: Vec<Vec<f64>> = (0..width)
        .map(|v| (0..size).map(|i| (((i * 7919 + v * 104_729) % 1009) as f64 - 504.0) / 504.0).collect())
        .collect();
    let mut previous = vec![f64::INFINITY; count];
    loop {
        for x in &mut block {
            x.iter_mut().zip(&mass).for_each(|(x, m)| *x *= m);
            factor.solve(x);
        }
        orthonormalise(&mut block, &mass);
        let values = rotate_to_modes(&mut block, &stiffness);
        let lowest = &values[..count.min(width)];
        let settled =
            lowest.iter().zip(&previous).all(|(new, old)| (new - old).abs() < 1e-12 * (shift + new));
        previous = lowest.to_vec();
        if settled {
            break;
        }
    }
    let frequencies = previous.iter().map(|value| value.max(0.0).sqrt() / TAU);
    let expand = |x: &Vec<f64>| follows.iter().map(|f| f.map_or(0.0, |(i, sign)| sign * x[i])).collect();
    frequencies.zip(&block).map(|(frequency_hz, x)| Mode { frequency_hz, shape: expand(x) }).collect()
}

fn orthonormalise(block: &mut [Vec<f64>], mass: &[f64]) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).zip(mass).map(|((a, b), m)| a * b * m).sum::<f64>();
    for v in 0..block.len() {
        let (done, rest) = block.split_at_mut(v);
        let x = &mut rest[0];
        for _ in 0..2 {
            for y in done.iter() {
                let part = dot(x, y);
                x.iter_mut().zip(y).for_each(|(x, y)| *x -= part * y);
            }
        }
        let norm = dot(x, x).sqrt();
        for x in x.iter_mut() {
            *x /= norm;
        }
    }
}

/// Rayleigh–Ritz within the block: rotates it to its modes and returns their ω², ascending.
fn rotate_to_modes(block: &mut [Vec<f64>], stiffness: &[Vec<(usize, f64)>]) -> Vec<f64> {
    let forces: Vec<Vec<f64>> = block
        .iter()
        .map(|x| stiffness.iter().map(|row| row.iter().map(|&(c, value)| value * x[c]).sum()).collect())
        .collect();
    let small = DMatrix::from_fn(block.len(), block.len(), |r, c| {
        block[r].iter().zip(&forces[c]).map(|(x, f)| x * f).sum::<f64>()
    });
    let eigen = ((&small + small.transpose()) * 0.5).symmetric_eigen();
    let mut order: Vec<usize> = (0..block.len()).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let rotated: Vec<Vec<f64>> = order
        .iter()
        .map(|&column| {
            let mut x = vec![0.0; block[0].len()];
            for (v, old) in block.iter().enumerate() {
                let weight = eigen.eigenvectors[(v, column)];
                x.iter_mut().zip(old).for_each(|(x, old)| *x += weight * old);
            }
            x
        })
        .collect();
    block.clone_from_slice(&rotated);
    order.iter().map(|&i| eigen.eigenvalues[i]).collect()
}

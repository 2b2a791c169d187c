//! Rigorous upper bounds of the largest frequency of a block and of point masses joined by springs.

use super::mesh::BlockMesh;
use crate::solver::body::Freedom;
use crate::solver::body::hexahedron::ElementStiffness;
use nalgebra::DMatrix;
use std::collections::BTreeSet;

/// Upper bound of the largest angular frequency \[rad/s\] of the constrained, lumped block.
///
/// By Rayleigh's quotient ω_max² of a sum of parts is at most the largest ω² of a part. Two partitions are
/// evaluated, and the smaller bound is used:
/// * Single elements, each reduced to the motions that its fixed and tied degrees of freedom allow. This is exact
///   for one-dimensional columns.
/// * Free patches of two or three elements a side. Constraints can only lower ω_max, so they are left out. This
///   bound is within a few percent of the assembled block, where that of single elements is a quarter too high.
pub fn omega_max_bound(
    mesh: &BlockMesh,
    element: &ElementStiffness,
    density_kg_m3: f64,
    freedoms: &[Freedom],
) -> f64 {
    by_elements(mesh, element, density_kg_m3, freedoms).min(by_patches(mesh, element, density_kg_m3))
}

/// Upper bound of the largest angular frequency \[rad/s\] of point masses joined by springs with these entries of K. It comes from
/// Gershgorin's discs of M⁻¹K: ω² ≤ `max_i` Σ_j |K_ij|/m_i over all degrees of freedom that are not fixed. Ties can
/// only lower ω.
pub fn omega_max_bound_of_springs(
    entries: impl Iterator<Item = (usize, usize, f64)>,
    masses_kg: &[f64],
    freedoms: &[Freedom],
) -> f64 {
    let moves = |dof: usize| freedoms[dof] != Freedom::Fixed;
    let mut sums = vec![0.0; freedoms.len()];
    for (row, column, k) in entries {
        if moves(row) && moves(column) {
            sums[row] += k.abs();
        }
    }
    let disc = |(dof, sum): (usize, f64)| sum / masses_kg[dof / 3];
    sums.into_iter().enumerate().map(disc).fold(0.0, f64::max).sqrt()
}

fn by_elements(
    mesh: &BlockMesh,
    element: &ElementStiffness,
    density_kg_m3: f64,
    freedoms: &[Freedom],
) -> f64 {
    let [hx, hy, hz] = mesh.element_size_m();
    let corner_mass = density_kg_m3 * hx * hy * hz / 8.0;
    let patterns: BTreeSet<[u8; 24]> = mesh
        .element_positions()
        .map(|[i, j, k]| {
            let nodes = mesh.element_nodes(i, j, k);
            pattern(&std::array::from_fn(|d| freedoms[3 * nodes[d / 3] + d % 3]))
        })
        .collect();
    patterns.iter().map(|p| reduced_omega_squared(element, corner_mass, p)).fold(0.0, f64::max).sqrt()
}

/// Cuts the block into patches of two elements a side, with one patch of three where the count is odd.
fn by_patches(mesh: &BlockMesh, element: &ElementStiffness, density_kg_m3: f64) -> f64 {
    let h = mesh.element_size_m();
    let sides = mesh.elements().map(|n| match n {
        1 => vec![1],
        3 => vec![3],
        n if n % 2 == 0 => vec![2],
        _ => vec![2, 3],
    });
    let mut omega_max: f64 = 0.0;
    for &nx in &sides[0] {
        for &ny in &sides[1] {
            for &nz in &sides[2] {
                let counts = [nx, ny, nz];
                let size = std::array::from_fn(|axis| counts[axis] as f64 * h[axis]);
                let patch = BlockMesh::new(size, counts);
                omega_max = omega_max.max(free_omega_max(&patch, element, density_kg_m3));
            }
        }
    }
    omega_max
}

/// Largest angular frequency \[rad/s\] of a free block by dense eigenvalues; for small patches.
fn free_omega_max(patch: &BlockMesh, element: &ElementStiffness, density_kg_m3: f64) -> f64 {
    let masses = patch.lumped_masses_kg(density_kg_m3);
    let size = 3 * masses.len();
    let mut k = DMatrix::<f64>::zeros(size, size);
    for [i, j, l] in patch.element_positions() {
        let nodes = patch.element_nodes(i, j, l);
        for row in 0..24 {
            for col in 0..24 {
                k[(3 * nodes[row / 3] + row % 3, 3 * nodes[col / 3] + col % 3)] += element[(row, col)];
            }
        }
    }
    for r in 0..size {
        for c in 0..size {
            k[(r, c)] /= (masses[r / 3] * masses[c / 3]).sqrt();
        }
    }
    k.symmetric_eigenvalues().max().sqrt()
}

/// Marks a fixed degree of freedom in a pattern.
const FIXED: u8 = u8::MAX;

/// Numbers the independent motions of one element in order of appearance.
fn pattern(freedoms: &[Freedom; 24]) -> [u8; 24] {
    let mut numbers = [FIXED; 24];
    let mut next = 0;
    for d in 0..24 {
        numbers[d] = match freedoms[d] {
            Freedom::Fixed => FIXED,
            Freedom::Tied(_) => match (0..d).find(|&e| freedoms[e] == freedoms[d]) {
                Some(e) => numbers[e],
                None => take(&mut next),
            },
            Freedom::Free | Freedom::Carried => take(&mut next),
        };
    }
    numbers
}

fn take(next: &mut u8) -> u8 {
    *next += 1;
    *next - 1
}

/// Largest eigenvalue ω² \[rad²/s²\] of one element that is reduced to its independent motions.
fn reduced_omega_squared(element: &ElementStiffness, corner_mass: f64, pattern: &[u8; 24]) -> f64 {
    let size = pattern.iter().filter(|&&n| n != FIXED).max().map_or(0, |&n| usize::from(n) + 1);
    if size == 0 {
        return 0.0;
    }
    let mut k = DMatrix::<f64>::zeros(size, size);
    let mut mass = vec![0.0; size];
    for (row, &r) in pattern.iter().enumerate() {
        if r == FIXED {
            continue;
        }
        mass[usize::from(r)] += corner_mass;
        for (col, &c) in pattern.iter().enumerate() {
            if c != FIXED {
                k[(usize::from(r), usize::from(c))] += element[(row, col)];
            }
        }
    }
    for r in 0..size {
        for c in 0..size {
            k[(r, c)] /= (mass[r] * mass[c]).sqrt();
        }
    }
    k.symmetric_eigenvalues().max()
}

#[cfg(test)]
mod tests {
    use super::super::operator::{Operator, TensorOperator};
    use super::*;
    use crate::solver::body::hexahedron::stiffness;
    use crate::solver::field::Field;
    use crate::solver::material::Material;

    /// Protects: the bound is above the true ω_max of the assembled block, which power iteration finds from below,
    /// and at most a quarter above it. The blocks have odd, even and single element counts, and one is nearly
    /// incompressible.
    #[test]
    fn bounds_the_assembled_block_from_above() {
        for (elements, poisson_ratio) in
            [([6, 8, 5], 0.3), ([5, 3, 7], 0.0), ([1, 4, 2], 0.45), ([4, 4, 1], -0.3), ([1, 1, 1], 0.3)]
        {
            let material = Material { young_modulus_pa: 1e9, poisson_ratio, density_kg_m3: 2500.0 };
            let mesh = BlockMesh::new([0.012, 0.015, 0.010], elements);
            let element = stiffness(&material, mesh.element_size_m());
            let freedoms = vec![Freedom::Free; 3 * mesh.node_count()];
            let bound = omega_max_bound(&mesh, &element, material.density_kg_m3, &freedoms);

            let operator = Operator::Tensor(TensorOperator::new(&mesh, &material));
            let mut scratch = operator.scratch(mesh.layout(), 1);
            let masses = mesh.lumped_masses_kg(material.density_kg_m3);
            let start: Vec<f64> = (0..3 * masses.len()).map(|i| ((i * 7919) % 101) as f64 - 50.0).collect();
            let mut x = Field::<1>::from_values(mesh.layout(), &start);
            let mut y = Field::zeros(mesh.layout());
            let mut from_below = 0.0;
            for _ in 0..2000 {
                operator.tangent(&x, &mut y, &mut scratch);
                let (mut xkx, mut xmx) = (0.0, 0.0);
                for i in 0..x.len() {
                    xkx += x[i] * y[i];
                    xmx += x[i] * x[i] * masses[i / 3];
                }
                from_below = (xkx / xmx).sqrt();
                let scale = 1.0 / (xmx.sqrt() * from_below * from_below);
                for i in 0..x.len() {
                    x[i] = y[i] / masses[i / 3] * scale;
                }
            }
            let ratio = bound / from_below;
            // The bound may be below the true value only by the rounding of the eigenvalues. It is at most as high
            // as that of single elements, a quarter above the true value.
            assert!(ratio > 1.0 - 1e-12 && ratio < 1.25, "{elements:?}, ν = {poisson_ratio}: {ratio}");
        }
    }
}

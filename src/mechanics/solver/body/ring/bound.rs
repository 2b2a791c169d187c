//! A rigorous upper bound of the ring's largest frequency.

use super::mesh::RingMesh;
use super::operator::Elements;
use super::sector::SectorElement;
use nalgebra::DMatrix;
use std::ops::Range;

/// Upper bound of ω_max² \[rad²/s²\] of the lumped ring.
///
/// By Rayleigh's quotient ω_max² of a sum of parts is at most the largest ω² of a part. Fixed nodes can only lower
/// it. The parts are patches of two elements a side (one or three at the end of an odd count), whose bound is
/// closer than that of single elements. A patch is evaluated only if its single elements have an ω² above the bound
/// so far.
pub(super) fn omega_max_squared(mesh: &RingMesh, elements: &Elements) -> f64 {
    let [_, rows, planes] = mesh.nodes_per_axis();
    let sectors = mesh.sectors_rad();
    let mut alone: Vec<f64> = Vec::new();
    for element in elements.all() {
        let nodes: [usize; 8] = std::array::from_fn(|corner| corner);
        alone.push(largest([(element, nodes)].into_iter(), 8));
    }
    let mut patches: Vec<Patch> = Vec::new();
    for columns in parts(sectors.len()) {
        let angles = sectors[columns].to_vec();
        if patches.iter().any(|known| known.angles_rad == angles) {
            continue;
        }
        for layers in parts(planes - 1) {
            for rings in parts(rows - 1) {
                let mut patch =
                    Patch { alone: 0.0, angles_rad: angles.clone(), rings, layers: layers.clone() };
                let members = patch.places().map(|[a, i, k]| alone[elements.index(angles[a], i, k)]);
                patch.alone = members.fold(0.0, f64::max);
                patches.push(patch);
            }
        }
    }
    patches.sort_by(|a, b| b.alone.total_cmp(&a.alone));
    let mut bound = 0.0_f64;
    for patch in &patches {
        if patch.alone <= bound {
            break;
        }
        bound = bound.max(patch.joined(elements));
    }
    bound
}

/// Ranges of two. If the count is odd, the last range has three, or the only one has one.
fn parts(count: usize) -> Vec<Range<usize>> {
    let mut parts: Vec<_> = (0..count / 2).map(|n| 2 * n..2 * n + 2).collect();
    match parts.last_mut() {
        Some(last) => last.end = count,
        None => parts.push(0..count),
    }
    parts
}

/// A patch of neighbouring elements.
struct Patch {
    /// Largest ω² of the single elements.
    alone: f64,
    angles_rad: Vec<f64>,
    rings: Range<usize>,
    layers: Range<usize>,
}

impl Patch {
    /// The elements: sector of the patch, radius, depth.
    fn places(&self) -> impl Iterator<Item = [usize; 3]> + '_ {
        let rings =
            move |a| self.rings.clone().flat_map(move |i| self.layers.clone().map(move |k| [a, i, k]));
        (0..self.angles_rad.len()).flat_map(rings)
    }

    /// Largest ω² of the joined elements.
    fn joined(&self, elements: &Elements) -> f64 {
        let (columns, across) = (self.angles_rad.len() + 1, self.rings.len() + 1);
        let members = self.places().map(|[a, i, k]| {
            let (inside, below) = (i - self.rings.start, k - self.layers.start);
            // Corner bits: outer radius, later angle, upper plane.
            let node = |corner: usize| {
                let (j, i, k) = (a + (corner >> 1 & 1), inside + (corner & 1), below + 1 - (corner >> 2));
                j + columns * (i + across * k)
            };
            (&elements.all()[elements.index(self.angles_rad[a], i, k)], std::array::from_fn(node))
        });
        largest(members, columns * across * (self.layers.len() + 1))
    }
}

/// Largest ω² of elements that are joined at these node numbers.
fn largest<'a>(members: impl Iterator<Item = (&'a SectorElement, [usize; 8])>, nodes: usize) -> f64 {
    let mut k = DMatrix::<f64>::zeros(3 * nodes, 3 * nodes);
    let mut masses = vec![0.0; nodes];
    for (element, at) in members {
        for a in 0..8 {
            masses[at[a]] += element.masses_kg[a];
            for b in 0..8 {
                for c in 0..3 {
                    for d in 0..3 {
                        k[(3 * at[a] + c, 3 * at[b] + d)] += element.stiffness[(3 * a + c, 3 * b + d)];
                    }
                }
            }
        }
    }
    let scaled = DMatrix::from_fn(3 * nodes, 3 * nodes, |row, col| {
        k[(row, col)] / (masses[row / 3] * masses[col / 3]).sqrt()
    });
    scaled.symmetric_eigenvalues().max()
}

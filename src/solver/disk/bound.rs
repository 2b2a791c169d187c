//! A rigorous bound of the ring's largest frequency.

use super::mesh::RingMesh;
use super::operator::Elements;
use super::sector::SectorElement;
use nalgebra::DMatrix;
use std::ops::Range;

/// Upper bound of ω_max² [rad²/s²] of the lumped ring.
///
/// By Rayleigh's quotient ω_max² of a sum of parts is at most the largest ω² of a part, and what is held can only
/// lower it. The parts are patches of two elements a side (one or three at the end of an odd count), which come
/// nearer than single elements; a patch is looked at only if its elements could make it the worst.
pub(super) fn omega_max_squared(mesh: &RingMesh, elements: &Elements) -> f64 {
    let [_, rows, planes] = mesh.nodes_per_axis();
    let sectors = mesh.sectors_rad();
    let mut alone: Vec<f64> = Vec::new();
    for element in elements.all() {
        let nodes: [usize; 8] = std::array::from_fn(|corner| corner);
        alone.push(largest([(element, nodes)].into_iter(), 8));
    }
    let mut patches: Vec<(f64, Vec<f64>, Range<usize>, Range<usize>)> = Vec::new();
    for columns in parts(sectors.len()) {
        let angles = sectors[columns].to_vec();
        if patches.iter().any(|(_, known, _, _)| *known == angles) {
            continue;
        }
        for layers in parts(planes - 1) {
            for rings in parts(rows - 1) {
                let worst = each(&angles, &rings, &layers)
                    .map(|[a, i, k]| alone[elements.index(angles[a], i, k)])
                    .fold(0.0, f64::max);
                patches.push((worst, angles.clone(), rings, layers.clone()));
            }
        }
    }
    patches.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut bound = 0.0_f64;
    for (worst, angles, rings, layers) in &patches {
        if *worst <= bound {
            break;
        }
        let (columns, across) = (angles.len() + 1, rings.len() + 1);
        let members = each(angles, rings, layers).map(|[a, i, k]| {
            let (i0, k0) = (i - rings.start, k - layers.start);
            // Corner bits: outer radius, later angle, upper plane.
            let node = |corner: usize| {
                let (j, i, k) = (a + (corner >> 1 & 1), i0 + (corner & 1), k0 + 1 - (corner >> 2));
                j + columns * (i + across * k)
            };
            (&elements.all()[elements.index(angles[a], i, k)], std::array::from_fn(node))
        });
        bound = bound.max(largest(members, columns * across * (layers.len() + 1)));
    }
    bound
}

/// Ranges of two, the last of one or three if the count is odd.
fn parts(count: usize) -> Vec<Range<usize>> {
    let mut parts: Vec<_> = (0..count / 2).map(|n| 2 * n..2 * n + 2).collect();
    match parts.last_mut() {
        Some(last) => last.end = count,
        None => parts.push(0..count),
    }
    parts
}

fn each<'a>(
    angles: &'a [f64],
    rings: &'a Range<usize>,
    layers: &'a Range<usize>,
) -> impl Iterator<Item = [usize; 3]> + 'a {
    (0..angles.len()).flat_map(move |a| rings.clone().flat_map(move |i| layers.clone().map(move |k| [a, i, k])))
}

/// Largest ω² of elements that are joined at these nodes.
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

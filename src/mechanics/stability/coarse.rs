//! Modes of a coarse mesh, from which the basis of a fine mesh begins.

use super::space::Space;
use super::space::block_of;
use crate::solver::Model;
use crate::solver::body::Freedom;
use crate::solver::body::hexahedron;
use crate::solver::body::pin::BlockMesh;
use crate::solver::body::pin::operator::AssembledOperator;
use crate::solver::support::Support;
use faer::{Mat, Side};
use std::collections::BTreeMap;

/// Largest number of elements of a coarse mesh: a dense eigenvalue problem of its displacements takes a third of a second.
const MOST_ELEMENTS: f64 = 240.0;

/// The coarse mesh: the pin's own mesh if it is small.
pub fn coarse_mesh(fine: &BlockMesh) -> BlockMesh {
    let elements: usize = fine.elements().iter().product();
    let factor = libm::cbrt(MOST_ELEMENTS / elements as f64).min(1.0);
    let count = |n: usize| ((n as f64 * factor).round() as usize).clamp(1, n);
    BlockMesh::new(fine.size_m(), fine.elements().map(count))
}

/// Modes of the pin with all slave nodes held in z, on the fine mesh: interpolated from a coarse one.
pub struct CoarseModes {
    /// Vectors of three components per node of the fine mesh, lowest frequency first.
    pub vectors: Vec<Vec<f64>>,
    /// Squares of their angular frequencies \[1/s²\].
    pub omega_squared: Vec<f64>,
    /// Whether these are all modes of the fine mesh itself.
    pub is_complete: bool,
    /// Whether these are modes of the fine mesh itself.
    pub is_exact: bool,
}

/// Computes up to `most` modes, or all if the fine mesh has at most `complete` of them. With `is_locked_sideways` no slave
/// node moves across the disk's velocity.
pub fn modes(
    model: &Model,
    space: &Space,
    is_locked_sideways: bool,
    most: usize,
    complete: usize,
) -> CoarseModes {
    let fine = block_of(model);
    let mesh = coarse_mesh(fine);
    let is_exact = mesh == *fine;
    let nearest: Vec<usize> = (0..mesh.node_count()).map(|node| nearest_node(&mesh, fine, node)).collect();
    // The unknown of each displacement, and its share in it.
    let mut unknowns: Vec<Option<(usize, f64)>> = vec![None; 3 * mesh.node_count()];
    let mut count = 0;
    let mut groups = BTreeMap::new();
    for node in 0..mesh.node_count() {
        for c in 0..3 {
            let is_held = c == 2 && mesh.bottom_nodes().contains(&node);
            unknowns[3 * node + c] = match model.pin().freedoms()[3 * nearest[node] + c] {
                Freedom::Fixed => None,
                _ if is_held => None,
                Freedom::Tied(group) => Some((*groups.entry(group).or_insert_with(|| next(&mut count)), 1.0)),
                Freedom::Free | Freedom::Carried => Some((next(&mut count), 1.0)),
            };
        }
        if is_locked_sideways && mesh.bottom_nodes().contains(&node) {
            // One unknown along the disk's velocity takes the place of x and y.
            if let [Some((along, _)), Some(_)] = [unknowns[3 * node], unknowns[3 * node + 1]] {
                let [dx, dy] = space.sliding()[nearest[node]].forward;
                unknowns[3 * node] = Some((along, dx));
                unknowns[3 * node + 1] = Some((along, dy));
                count -= 1;
            }
        }
    }
    let material = model.pin().material();
    let mut mass = vec![0.0; count];
    for (node, nodal) in mesh.lumped_masses_kg(material.density_kg_m3).iter().enumerate() {
        for (index, share) in unknowns[3 * node..3 * node + 3].iter().flatten() {
            mass[*index] += nodal * share * share;
        }
    }
    let mut springs_n_m = vec![0.0; count];
    let ties = model.supports().iter().filter(|support| support.tie().is_some());
    for (group, support) in ties.enumerate() {
        if let (Support::Held(held), Some(&index)) = (support, groups.get(&group)) {
            mass[index] += held.mass_kg;
            springs_n_m[index] = held.stiffness_n_m;
        }
    }
    let element = hexahedron::stiffness(material, mesh.element_size_m());
    let operator = AssembledOperator::of_block(&mesh, &element);
    let mut scaled = Mat::<f64>::zeros(count, count);
    for (row, unknown) in operator.rows().iter().zip(&unknowns) {
        let Some((i, own)) = *unknown else { continue };
        for &(column, value) in row {
            if let Some((j, share)) = unknowns[column] {
                scaled[(i, j)] += own * share * value / (mass[i] * mass[j]).sqrt();
            }
        }
    }
    for (i, spring_n_m) in springs_n_m.into_iter().enumerate() {
        scaled[(i, i)] += spring_n_m / mass[i];
    }
    let is_complete = is_exact && !is_locked_sideways && count <= complete;
    let wanted = if is_complete { count } else { most.min(count) };
    let eigen = scaled.self_adjoint_eigen(Side::Lower).expect("a symmetric matrix of finite numbers");
    let vector = |mode: usize| -> Vec<f64> {
        let value = |unknown: &Option<(usize, f64)>| {
            unknown.map_or(0.0, |(index, share)| share * eigen.U()[(index, mode)] / mass[index].sqrt())
        };
        let own: Vec<f64> = unknowns.iter().map(value).collect();
        if is_exact { own } else { interpolate(&mesh, fine, &own) }
    };
    CoarseModes {
        vectors: (0..wanted).map(vector).collect(),
        omega_squared: (0..wanted).map(|mode| eigen.S()[mode]).collect(),
        is_complete,
        is_exact,
    }
}

fn next(count: &mut usize) -> usize {
    *count += 1;
    *count - 1
}

/// The node of `to` that is nearest to a node of `from`; of two, the lower.
fn nearest_node(from: &BlockMesh, to: &BlockMesh, node: usize) -> usize {
    let grid = from.grid_position(node);
    let [i, j, k] = std::array::from_fn(|axis| {
        let at = grid[axis] as f64 * to.elements()[axis] as f64 / from.elements()[axis] as f64;
        (at - 1e-9).round().max(0.0) as usize
    });
    to.node(i, j, k)
}

/// Values of three components at the nodes of `to` from those at the nodes of `from`, linear in each element.
fn interpolate(from: &BlockMesh, to: &BlockMesh, values: &[f64]) -> Vec<f64> {
    let places: [Vec<(usize, f64)>; 3] = std::array::from_fn(|axis| {
        let (coarse, fine) = (from.elements()[axis], to.elements()[axis]);
        let place = |node: usize| {
            let at = node as f64 * coarse as f64 / fine as f64;
            let cell = (at as usize).min(coarse - 1);
            (cell, at - cell as f64)
        };
        (0..=fine).map(place).collect()
    });
    let mut interpolated = Vec::with_capacity(3 * to.node_count());
    for node in 0..to.node_count() {
        let grid = to.grid_position(node);
        let [(i, x), (j, y), (k, z)] = std::array::from_fn(|axis| places[axis][grid[axis]]);
        let corners = from.element_nodes(i, j, k);
        for c in 0..3 {
            let mut sum = 0.0;
            for (corner, at) in corners.iter().enumerate() {
                let weight = |part: f64, bit: usize| if corner >> bit & 1 == 0 { 1.0 - part } else { part };
                sum += weight(x, 0) * weight(y, 1) * weight(z, 2) * values[3 * at + c];
            }
            interpolated.push(sum);
        }
    }
    interpolated
}

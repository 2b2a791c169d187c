//! Meshes of any hexahedra.

use super::BlockMesh;
use crate::solver::body::hexahedron::corner_jacobians;
use crate::solver::error::SolverError;
use crate::solver::field::Layout;
use crate::spec::Element;
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet, VecDeque};

/// A hexahedron.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hexahedron {
    /// Its nodes, numbered as in [`hexahedron`](crate::solver::body::hexahedron).
    pub nodes: [usize; 8],
    /// Number of its material.
    pub material: usize,
}

/// The parts from which a mesh is made, with nodes in any order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MeshParts {
    /// Coordinates \[m\] in the frame of the pin: x and y from its axis, z from its base.
    pub coordinates_m: Vec<[f64; 3]>,
    /// The elements.
    pub elements: Vec<Hexahedron>,
    /// Their names in messages. Without them, they are numbered from 0.
    pub names: Vec<u64>,
    /// Quadrilaterals of the contact face, with their corners in order around them.
    pub contact: Vec<[usize; 4]>,
    /// Quadrilaterals of the face that carries the load.
    pub top: Vec<[usize; 4]>,
    /// Nodes that the clamp holds. `None`: they follow from the clamp of the scene.
    pub clamped: Option<Vec<usize>>,
    /// Number of elements in x, y and z, if the mesh has such directions.
    pub divisions: Option<[usize; 3]>,
    /// What all elements are.
    pub element: Element,
}

impl MeshParts {
    /// The name of an element in messages.
    fn name(&self, index: usize) -> u64 {
        self.names.get(index).copied().unwrap_or(index as u64)
    }

    /// The parts of a block, all of material 0.
    pub fn of_block(mesh: &BlockMesh) -> Self {
        let [nx, ny, nz] = mesh.elements();
        let face = |k: usize| {
            let corners = move |i, j| {
                [
                    mesh.node(i, j, k),
                    mesh.node(i + 1, j, k),
                    mesh.node(i + 1, j + 1, k),
                    mesh.node(i, j + 1, k),
                ]
            };
            (0..ny).flat_map(|j| (0..nx).map(move |i| corners(i, j))).collect()
        };
        Self {
            coordinates_m: (0..mesh.node_count()).map(|node| mesh.coordinates_m(node)).collect(),
            elements: mesh
                .element_positions()
                .map(|[i, j, k]| Hexahedron { nodes: mesh.element_nodes(i, j, k), material: 0 })
                .collect(),
            contact: face(0),
            top: face(nz),
            divisions: Some(mesh.elements()),
            ..Self::default()
        }
    }
}

/// How a pin is tilted: first by `y_rad` about y, then by `x_rad` about x.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tilt {
    /// Angle \[rad\] about x. A positive angle lifts the trailing end.
    pub x_rad: f64,
    /// Angle \[rad\] about y. A positive angle lifts the inner side.
    pub y_rad: f64,
}

impl Tilt {
    /// Turns a vector of the pin's frame.
    #[must_use]
    pub fn turned(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        if *self == Self::default() {
            return [x, y, z];
        }
        let (sin_x, cos_x) = libm::sincos(self.x_rad);
        let (sin_y, cos_y) = libm::sincos(self.y_rad);
        let [x, z] = [cos_y * x + sin_y * z, cos_y * z - sin_y * x];
        [x, cos_x * y - sin_x * z, sin_x * y + cos_x * z]
    }
}

/// A mesh of any hexahedra. The nodes of the contact face come first. The others follow by their distance from it, counted in
/// elements, so that neighbours are near each other in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct GeneralMesh {
    coordinates_m: Vec<[f64; 3]>,
    own_coordinates_m: Vec<[f64; 3]>,
    tilt: Tilt,
    size_m: [f64; 3],
    elements: Vec<Hexahedron>,
    contact: Vec<[usize; 4]>,
    contact_areas_m2: Vec<f64>,
    top_nodes: Vec<usize>,
    top_areas_m2: Vec<f64>,
    clamped: Option<Vec<usize>>,
    worst_jacobian: f64,
    divisions: Option<[usize; 3]>,
    names: Vec<u64>,
    /// What all elements are.
    pub(in crate::solver::body::pin) element: Element,
}

impl GeneralMesh {
    /// A mesh of these parts. Nodes that no element has are left out. The lowest node of the tilted contact face is at z = 0.
    ///
    /// # Errors
    /// If a coordinate is not finite; if an element is inverted, flat, repeated, or not connected with the contact face; if a face is
    /// empty or not on the surface; if the contact face does not look down, or a node is below it.
    pub fn new(parts: &MeshParts, tilt: Tilt) -> Result<Self, SolverError> {
        let refused = |what: String| Err(SolverError::Mesh(what));
        for (what, faces) in [("contact", &parts.contact), ("load", &parts.top)] {
            if faces.is_empty() {
                return refused(format!("the {what} face has no quadrilateral"));
            }
        }
        let worst_jacobian = check_elements(parts)?;
        let new = renumbered(parts)?;
        let node_count = new.iter().flatten().count();
        let mut own_coordinates_m = vec![[0.0; 3]; node_count];
        for (old, new) in new.iter().enumerate() {
            if let Some(new) = *new {
                own_coordinates_m[new] = parts.coordinates_m[old];
            }
        }
        let number = |old: usize| {
            new.get(old)
                .copied()
                .flatten()
                .ok_or_else(|| SolverError::Mesh(format!("node {old} of a face is in no element")))
        };
        let faces = |faces: &[[usize; 4]]| -> Result<Vec<[usize; 4]>, SolverError> {
            faces
                .iter()
                .map(|[a, b, c, d]| Ok([number(*a)?, number(*b)?, number(*c)?, number(*d)?]))
                .collect()
        };
        let (contact, top) = (faces(&parts.contact)?, faces(&parts.top)?);
        let surface = Surface::of(parts)?;
        surface.check("contact", &parts.contact, parts)?;
        surface.check("load", &parts.top, parts)?;
        surface.check_looks_down(parts, tilt)?;
        let contact_areas_m2: Vec<f64> = areas_m2(&own_coordinates_m, &contact).into_values().collect();
        let (top_nodes, top_areas_m2): (Vec<_>, Vec<_>) =
            areas_m2(&own_coordinates_m, &top).into_iter().unzip();
        if top_nodes.iter().any(|&node| node < contact_areas_m2.len()) {
            return refused("a node is both on the contact face and on the load's face".to_owned());
        }
        let clamped = match &parts.clamped {
            None => None,
            Some(nodes) => {
                let mut nodes = nodes.iter().map(|&node| number(node)).collect::<Result<Vec<_>, _>>()?;
                nodes.sort_unstable();
                nodes.dedup();
                Some(nodes)
            }
        };
        let mut coordinates_m: Vec<_> = own_coordinates_m.iter().map(|x| tilt.turned(*x)).collect();
        let lowest =
            coordinates_m[..contact_areas_m2.len()].iter().map(|x| x[2]).fold(f64::INFINITY, f64::min);
        for x in &mut coordinates_m {
            x[2] -= lowest;
        }
        let height_m = coordinates_m.iter().map(|x| x[2]).fold(0.0, f64::max);
        if let Some(below) = coordinates_m.iter().find(|x| x[2] < -1.0e-9 * height_m) {
            return refused(format!(
                "a node of the pin is {:.4} mm below its contact face; the disk is below the pin, and the contact face is its lowest \
                 part",
                -1e3 * below[2]
            ));
        }
        let size_m = std::array::from_fn(|axis| {
            let along = || own_coordinates_m.iter().map(move |x: &[f64; 3]| x[axis]);
            along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
        });
        let elements = parts
            .elements
            .iter()
            .map(|element| Hexahedron {
                nodes: element.nodes.map(|node| new[node].unwrap_or_default()),
                material: element.material,
            })
            .collect();
        Ok(Self {
            coordinates_m,
            own_coordinates_m,
            tilt,
            size_m,
            elements,
            contact,
            contact_areas_m2,
            top_nodes,
            top_areas_m2,
            clamped,
            worst_jacobian,
            divisions: parts.divisions,
            element: parts.element,
            names: parts.names.clone(),
        })
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.coordinates_m.len()
    }

    /// The layout of a field on all nodes. The contact face is a line and a plane.
    pub fn layout(&self) -> Layout {
        Layout { nodes_per_line: self.contact_areas_m2.len(), lines_per_plane: 1, nodes: self.node_count() }
    }

    /// Coordinates \[m\] of a node: x and y from the pin's axis, z from the disk.
    pub fn coordinates_m(&self, node: usize) -> [f64; 3] {
        self.coordinates_m[node]
    }

    /// Coordinates \[m\] of a node in the frame of the pin.
    pub fn own_coordinates_m(&self, node: usize) -> [f64; 3] {
        self.own_coordinates_m[node]
    }

    /// How the pin is tilted.
    pub fn tilt(&self) -> Tilt {
        self.tilt
    }

    /// Extent \[m\] in x, y and z in the frame of the pin.
    pub fn size_m(&self) -> [f64; 3] {
        self.size_m
    }

    /// Number of elements in x, y and z, if the mesh has such directions.
    pub fn divisions(&self) -> Option<[usize; 3]> {
        self.divisions
    }

    /// The elements.
    pub fn elements(&self) -> &[Hexahedron] {
        &self.elements
    }

    /// The name of an element in messages.
    pub fn name(&self, index: usize) -> u64 {
        self.names.get(index).copied().unwrap_or(index as u64)
    }

    /// The corners \[m\] of an element.
    pub fn corners_m(&self, element: &Hexahedron) -> [Vector3<f64>; 8] {
        element.nodes.map(|node| Vector3::from(self.coordinates_m[node]))
    }

    /// Quadrilaterals of the contact face.
    pub fn contact_faces(&self) -> &[[usize; 4]] {
        &self.contact
    }

    /// Tributary areas \[m²\] of the nodes of the contact face.
    pub fn contact_areas_m2(&self) -> &[f64] {
        &self.contact_areas_m2
    }

    /// Nodes of the face that carries the load, in ascending order.
    pub fn top_nodes(&self) -> &[usize] {
        &self.top_nodes
    }

    /// Nodes of the faces that are neither between two elements nor on the contact face or the face that carries the load, in ascending
    /// order.
    pub fn side_nodes(&self) -> Vec<usize> {
        let mut counts: HashMap<[usize; 4], usize> = HashMap::new();
        for element in &self.elements {
            for face in FACES {
                *counts.entry(sorted(face.map(|corner| element.nodes[corner]))).or_default() += 1;
            }
        }
        let is_top = |node: &usize| self.top_nodes.binary_search(node).is_ok();
        let is_side = |face: &[usize; 4]| {
            !face.iter().all(|node| *node < self.contact_areas_m2.len()) && !face.iter().all(is_top)
        };
        let faces = counts.into_iter().filter(|(face, count)| *count == 1 && is_side(face));
        let nodes: BTreeSet<usize> = faces.flat_map(|(face, _)| face).collect();
        nodes.into_iter().collect()
    }

    /// Their tributary areas \[m²\].
    pub fn top_areas_m2(&self) -> &[f64] {
        &self.top_areas_m2
    }

    /// Nodes that the clamp holds, if the mesh says which.
    pub fn clamped(&self) -> Option<&[usize]> {
        self.clamped.as_deref()
    }

    /// The smallest Jacobian at a corner of an element over the product of the lengths of the edges that meet there; 1 for
    /// boxes.
    pub fn worst_jacobian(&self) -> f64 {
        self.worst_jacobian
    }

    /// Nodes of the contact face at its front and at its rear. Of several nodes the one nearest to the axis is taken.
    pub fn edge_centres(&self) -> [usize; 2] {
        let face = 0..self.contact_areas_m2.len();
        let near = 1e-9 * self.size_m[1];
        [1.0, -1.0].map(|sign| {
            let at = |node: &usize| sign * self.own_coordinates_m[*node][1];
            let end = face.clone().map(|node| at(&node)).fold(f64::INFINITY, f64::min);
            let from_axis = |node: &usize| self.own_coordinates_m[*node][0].abs();
            let at_end = face.clone().filter(|node| at(node) <= end + near);
            at_end.min_by(|a, b| from_axis(a).total_cmp(&from_axis(b))).unwrap_or_default()
        })
    }
}

/// Checks coordinates and elements. Returns the worst Jacobian.
fn check_elements(parts: &MeshParts) -> Result<f64, SolverError> {
    let count = parts.coordinates_m.len();
    if let Some(node) = parts.coordinates_m.iter().position(|x| !x.iter().all(|x| x.is_finite())) {
        return Err(SolverError::Mesh(format!("node {node} has a coordinate that is not a number")));
    }
    let mut worst_jacobian = f64::INFINITY;
    for (index, element) in parts.elements.iter().enumerate() {
        let number = parts.name(index);
        if element.nodes.iter().any(|&node| node >= count) {
            return Err(SolverError::Mesh(format!("element {number} has a node that does not exist")));
        }
        let corners = element.nodes.map(|node| Vector3::from(parts.coordinates_m[node]));
        let worst = corner_jacobians(&corners).into_iter().fold(f64::INFINITY, f64::min);
        if worst <= 0.0 || worst.is_nan() {
            let [x, y, z] = parts.coordinates_m[element.nodes[0]].map(|x| x * 1e3);
            return Err(SolverError::Mesh(format!(
                "element {number} near x = {x:.4} mm, y = {y:.4} mm, z = {z:.4} mm has a Jacobian of {worst:.3} at a \
                 corner, relative to its edges; it must be above 0"
            )));
        }
        worst_jacobian = worst_jacobian.min(worst);
    }
    Ok(worst_jacobian)
}

/// The faces of a hexahedron by its nodes.
const FACES: [[usize; 4]; 6] =
    [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 4, 5], [2, 3, 6, 7], [0, 2, 4, 6], [1, 3, 5, 7]];

/// The faces of the elements by their sorted nodes: how many elements have each, and the first of them.
struct Surface(HashMap<[usize; 4], (usize, usize)>);

impl Surface {
    fn of(parts: &MeshParts) -> Result<Self, SolverError> {
        let mut elements = HashMap::new();
        let mut faces = HashMap::new();
        for (index, element) in parts.elements.iter().enumerate() {
            let mut nodes = element.nodes;
            nodes.sort_unstable();
            if let Some(first) = elements.insert(nodes, index) {
                let [first, second] = [first, index].map(|index| parts.name(index));
                return Err(SolverError::Mesh(format!("elements {first} and {second} have the same nodes")));
            }
            for face in FACES {
                let (count, _) =
                    faces.entry(sorted(face.map(|corner| element.nodes[corner]))).or_insert((0, index));
                *count += 1;
                if *count > 2 {
                    let number = parts.name(index);
                    return Err(SolverError::Mesh(format!(
                        "a face of element {number} is also one of two other elements; at most two may share a face"
                    )));
                }
            }
        }
        Ok(Self(faces))
    }

    /// Checks that quadrilaterals are on the surface of the elements, and none twice.
    fn check(&self, what: &str, quadrilaterals: &[[usize; 4]], parts: &MeshParts) -> Result<(), SolverError> {
        let mut seen = HashSet::new();
        for face in quadrilaterals {
            let [x, y, z] = parts.coordinates_m[face[0]].map(|x| 1e3 * x);
            let place = format!(
                "the quadrilateral near x = {x:.4} mm, y = {y:.4} mm, z = {z:.4} mm of the {what} face"
            );
            if !seen.insert(sorted(*face)) {
                return Err(SolverError::Mesh(format!("{place} is repeated")));
            }
            match self.0.get(&sorted(*face)) {
                Some((1, _)) => {}
                Some(_) => return Err(SolverError::Mesh(format!("{place} is between two elements"))),
                None => return Err(SolverError::Mesh(format!("{place} is no face of an element"))),
            }
        }
        Ok(())
    }

    /// Checks that the outside of the contact face, which has been checked, is below it.
    fn check_looks_down(&self, parts: &MeshParts, tilt: Tilt) -> Result<(), SolverError> {
        for face in &parts.contact {
            let corners = face.map(|node| Vector3::from(tilt.turned(parts.coordinates_m[node])));
            let normal = (corners[2] - corners[0]).cross(&(corners[3] - corners[1]));
            let nodes = self.0.get(&sorted(*face)).map(|(_, element)| parts.elements[*element].nodes);
            let centre: Vector3<f64> = nodes
                .iter()
                .flatten()
                .map(|&node| Vector3::from(tilt.turned(parts.coordinates_m[node])))
                .sum();
            let outwards = corners.iter().sum::<Vector3<f64>>() / 4.0 - centre / 8.0;
            if normal.z * normal.dot(&outwards).signum() >= 0.0 {
                let [x, y, z] = parts.coordinates_m[face[0]].map(|x| 1e3 * x);
                return Err(SolverError::Mesh(format!(
                    "the contact face near x = {x:.4} mm, y = {y:.4} mm, z = {z:.4} mm does not look down: the disk is below the pin, \
                     and z points from the disk into the pin"
                )));
            }
        }
        Ok(())
    }
}

fn sorted(mut face: [usize; 4]) -> [usize; 4] {
    face.sort_unstable();
    face
}

/// The new number of each node: contact nodes first, the others by breadth-first search.
fn renumbered(parts: &MeshParts) -> Result<Vec<Option<usize>>, SolverError> {
    let count = parts.coordinates_m.len();
    let mut elements_of = vec![Vec::new(); count];
    for (number, element) in parts.elements.iter().enumerate() {
        for &node in &element.nodes {
            elements_of[node].push(number);
        }
    }
    let mut contact: Vec<usize> = parts.contact.iter().flatten().copied().collect();
    contact.sort_unstable();
    contact.dedup();
    if let Some(&node) = contact.iter().find(|&&node| node >= count || elements_of[node].is_empty()) {
        return Err(SolverError::Mesh(format!("node {node} of the contact face is in no element")));
    }
    let mut new = vec![None; count];
    for (number, &node) in contact.iter().enumerate() {
        new[node] = Some(number);
    }
    let mut next = contact.len();
    let mut queue: VecDeque<usize> = contact.into();
    while let Some(node) = queue.pop_front() {
        let mut neighbours: Vec<usize> =
            elements_of[node].iter().flat_map(|&element| parts.elements[element].nodes).collect();
        neighbours.sort_unstable();
        for neighbour in neighbours {
            if new[neighbour].is_none() {
                new[neighbour] = Some(next);
                next += 1;
                queue.push_back(neighbour);
            }
        }
    }
    match parts.elements.iter().position(|element| new[element.nodes[0]].is_none()) {
        None => Ok(new),
        Some(index) => Err(SolverError::Mesh(format!(
            "element {} is not connected with the contact face by elements with common nodes",
            parts.name(index)
        ))),
    }
}

/// The tributary area \[m²\] of each node of some quadrilaterals, by 2 × 2 Gauss points.
fn areas_m2(coordinates_m: &[[f64; 3]], faces: &[[usize; 4]]) -> BTreeMap<usize, f64> {
    let mut areas = BTreeMap::new();
    let g = 1.0 / 3.0_f64.sqrt();
    for face in faces {
        let x = face.map(|node| Vector3::from(coordinates_m[node]));
        for [xi, eta] in [[-g, -g], [g, -g], [g, g], [-g, g]] {
            let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let sum = |weight: &dyn Fn([f64; 2]) -> f64| -> Vector3<f64> {
                x.iter().zip(signs).map(|(x, sign)| x * weight(sign)).sum()
            };
            let along_xi = sum(&|[a, b]: [f64; 2]| 0.25 * a * (1.0 + b * eta));
            let along_eta = sum(&|[a, b]: [f64; 2]| 0.25 * b * (1.0 + a * xi));
            let area = along_xi.cross(&along_eta).norm();
            for (&node, [a, b]) in face.iter().zip(signs) {
                *areas.entry(node).or_insert(0.0) += area * 0.25 * (1.0 + a * xi) * (1.0 + b * eta);
            }
        }
    }
    areas
}

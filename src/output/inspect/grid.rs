//! Lines of nodes on the contact face.

use crate::solver::body::pin::{BlockMesh, PinMesh};

/// The contact face as a grid. On a block it is that of its nodes. On other meshes the nodes are sorted into strips that are as wide as
/// a node's mean distance from its neighbours.
#[derive(Debug, Clone)]
pub struct FaceGrid {
    /// Number of strips less one, in x and in y.
    pub elements: [usize; 2],
    /// The strips of each slave node, in x and in y.
    place: Vec<[usize; 2]>,
    /// Slave nodes from front to rear.
    from_front: Vec<usize>,
    /// Width \[m\] of a strip in x and in y.
    pub width_m: [f64; 2],
}

impl FaceGrid {
    pub fn new(mesh: &PinMesh) -> Self {
        let slaves = mesh.bottom_nodes();
        let [lx, ly, _] = mesh.size_m();
        let (elements, place) = match mesh.block() {
            Some(block) => of_block(block),
            None => of_strips(mesh),
        };
        let mut from_front: Vec<usize> = slaves.collect();
        from_front.sort_by(|a, b| mesh.own_coordinates_m(*a)[1].total_cmp(&mesh.own_coordinates_m(*b)[1]));
        let width_m = [lx / elements[0] as f64, ly / elements[1] as f64];
        Self { elements, place, from_front, width_m }
    }

    /// The strips of a slave node, in x and in y.
    pub fn place(&self, slave: usize) -> [usize; 2] {
        self.place[slave]
    }

    /// Slave nodes of strip `i` in x, from front to rear.
    pub fn along(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        self.from_front.iter().copied().filter(move |&slave| self.place[slave][0] == i)
    }

    /// Slave nodes of strip `j` in y.
    pub fn across(&self, j: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.place.len()).filter(move |&slave| self.place[slave][1] == j)
    }

    /// Slave nodes of the middle strip in x, from front to rear.
    pub fn middle(&self) -> impl Iterator<Item = usize> + '_ {
        self.along(self.elements[0] / 2)
    }
}

fn of_block(block: &BlockMesh) -> ([usize; 2], Vec<[usize; 2]>) {
    let [nx, ny, _] = block.elements();
    let place = |slave| {
        let [i, j, _] = block.grid_position(slave);
        [i, j]
    };
    ([nx, ny], block.bottom_nodes().map(place).collect())
}

fn of_strips(mesh: &PinMesh) -> ([usize; 2], Vec<[usize; 2]>) {
    let positions: Vec<[f64; 3]> = mesh.bottom_nodes().map(|slave| mesh.own_coordinates_m(slave)).collect();
    let area_m2: f64 = mesh.contact_areas_m2().iter().sum();
    let distance_m = (area_m2 / positions.len() as f64).sqrt();
    let ends = [0, 1].map(|axis| {
        let along = || positions.iter().map(move |x| x[axis]);
        [along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max)]
    });
    let elements = ends.map(|[low, high]| (((high - low) / distance_m).round() as usize).max(1));
    let strip = |x: &[f64; 3], axis: usize| {
        let [low, high] = ends[axis];
        let share = (x[axis] - low) / (high - low);
        ((share * elements[axis] as f64).round() as usize).min(elements[axis])
    };
    (elements, positions.iter().map(|x| [strip(x, 0), strip(x, 1)]).collect())
}

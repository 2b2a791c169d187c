//! The structured hexahedral mesh of a block.

use crate::solver::field::Layout;

/// A block of the size lx × ly × lz with nx × ny × nz equal hexahedra. x and y are centred on 0, and z begins at 0.
///
/// Node (i, j, k) has the index `i + (nx+1)·(j + (ny+1)·k)`. The contact face is k = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockMesh {
    elements: [usize; 3],
    size_m: [f64; 3],
}

impl BlockMesh {
    /// A block of `size_m` with `elements` in x, y and z.
    ///
    /// # Panics
    /// If an element count is zero or a size is not positive. Callers check their input first.
    pub fn new(size_m: [f64; 3], elements: [usize; 3]) -> Self {
        assert!(elements.iter().all(|&n| n > 0), "a mesh needs at least one element per direction");
        assert!(size_m.iter().all(|&l| l > 0.0), "a block needs positive edge lengths");
        Self { elements, size_m }
    }

    /// Number of elements in x, y and z.
    pub fn elements(&self) -> [usize; 3] {
        self.elements
    }

    /// Edge lengths \[m\].
    pub fn size_m(&self) -> [f64; 3] {
        self.size_m
    }

    /// Edge lengths \[m\] of one element.
    pub fn element_size_m(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.size_m[axis] / self.elements[axis] as f64)
    }

    /// Number of nodes in x, y and z.
    pub fn nodes_per_axis(&self) -> [usize; 3] {
        self.elements.map(|n| n + 1)
    }

    /// Total number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes_per_axis().iter().product()
    }

    /// The layout of a field on all nodes: lines along x.
    pub fn layout(&self) -> Layout {
        let [mx, my, mz] = self.nodes_per_axis();
        Layout { nodes_per_line: mx, lines_per_plane: my, nodes: mx * my * mz }
    }

    /// Index of node (i, j, k).
    pub fn node(&self, i: usize, j: usize, k: usize) -> usize {
        let [mx, my, _] = self.nodes_per_axis();
        i + mx * (j + my * k)
    }

    /// (i, j, k) of a node index.
    pub fn grid_position(&self, node: usize) -> [usize; 3] {
        let [mx, my, _] = self.nodes_per_axis();
        [node % mx, node / mx % my, node / (mx * my)]
    }

    /// Coordinates \[m\] of a node: x and y from the block's axis, z from the contact face.
    pub fn coordinates_m(&self, node: usize) -> [f64; 3] {
        let h = self.element_size_m();
        let grid = self.grid_position(node);
        let along = |axis: usize| grid[axis] as f64 * h[axis];
        [along(0) - self.size_m[0] / 2.0, along(1) - self.size_m[1] / 2.0, along(2)]
    }

    /// The eight nodes of element (i, j, k), numbered x fastest, then y, then z.
    pub fn element_nodes(&self, i: usize, j: usize, k: usize) -> [usize; 8] {
        std::array::from_fn(|a| self.node(i + (a & 1), j + (a >> 1 & 1), k + (a >> 2)))
    }

    /// All elements as (i, j, k).
    pub fn element_positions(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [nx, ny, nz] = self.elements;
        (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])))
    }

    /// Row-sum lumped nodal masses \[kg\] for the density ρ.
    pub fn lumped_masses_kg(&self, density_kg_m3: f64) -> Vec<f64> {
        let [hx, hy, hz] = self.element_size_m();
        let corner = density_kg_m3 * hx * hy * hz / 8.0;
        (0..self.node_count()).map(|node| corner * self.adjacent_cells(node, 3)).collect()
    }

    /// Tributary area \[m²\] of a node of the contact or top face: ¼, ½ or 1 element face.
    pub fn tributary_area_m2(&self, node: usize) -> f64 {
        let [hx, hy, _] = self.element_size_m();
        hx * hy / 4.0 * self.adjacent_cells(node, 2)
    }

    /// Nodes of the face k = 0 (the contact face) in index order.
    pub fn bottom_nodes(&self) -> std::ops::Range<usize> {
        let [mx, my, _] = self.nodes_per_axis();
        0..mx * my
    }

    /// Nodes of the face k = nz (the top) in index order.
    pub fn top_nodes(&self) -> std::ops::Range<usize> {
        let [mx, my, mz] = self.nodes_per_axis();
        mx * my * (mz - 1)..mx * my * mz
    }

    /// Number of cells that meet at a node, counted over the first `axes` directions.
    fn adjacent_cells(&self, node: usize, axes: usize) -> f64 {
        let grid = self.grid_position(node);
        (0..axes).map(|a| if grid[a] == 0 || grid[a] == self.elements[a] { 1.0 } else { 2.0 }).product()
    }
}

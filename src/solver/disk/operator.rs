//! The ring's stiffness: y = K x.
//!
//! A node's row of K depends on its radius, its depth and the angles of the two sectors that it joins; columns of
//! nodes between the same angles form a class and share their rows. Vectors run along θ, where neighbours are one
//! node away as in the pin's lines; the ends of a closed ring are each other's neighbours.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::mesh::RingMesh;
use super::sector::{self, SectorElement};
use crate::solver::field::{Block, Field, Row, WIDTH, blocks_per_line};
use crate::solver::material::Material;
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// The elements of every distinct sector.
#[derive(Debug, Clone)]
pub(super) struct Elements {
    angles_rad: Vec<f64>,
    all: Vec<SectorElement>,
    layers: usize,
    rows: usize,
}

impl Elements {
    pub fn new(mesh: &RingMesh, material: &Material) -> Self {
        let mut angles_rad: Vec<f64> = Vec::new();
        for &angle in mesh.sectors_rad() {
            if !angles_rad.contains(&angle) {
                angles_rad.push(angle);
            }
        }
        let [_, rows, planes] = mesh.nodes_per_axis();
        let (rows, layers) = (rows - 1, planes - 1);
        let mut all = Vec::new();
        for &angle in &angles_rad {
            for k in 0..layers {
                all.extend((0..rows).map(|i| sector::element(mesh, material, i, k, angle)));
            }
        }
        Self { angles_rad, all, layers, rows }
    }

    /// All distinct ones.
    pub fn all(&self) -> &[SectorElement] {
        &self.all
    }

    fn at(&self, angle_rad: f64, i: usize, k: usize) -> &SectorElement {
        let angle = self.angles_rad.iter().position(|known| *known == angle_rad).expect("a known sector");
        &self.all[(angle * self.layers + k) * self.rows + i]
    }
}

/// A row's blocks: neighbouring line (depth and radius −1, 0, 1) → column −1, 0, 1 → component of x → of y.
type NodeRow = [[[[f64; 3]; 3]; 3]; 9];

/// K of a ring.
#[derive(Debug, Clone)]
pub struct RingOperator {
    /// Nodes in θ, r and z.
    nodes: [usize; 3],
    closed: bool,
    /// Class of every column.
    classes: Vec<usize>,
    /// Class → depth → radius.
    rows: Vec<NodeRow>,
}

impl RingOperator {
    /// K of a mesh and the lumped masses [kg] of its nodes.
    pub(super) fn new(mesh: &RingMesh, elements: &Elements) -> (Self, Vec<f64>) {
        let nodes = mesh.nodes_per_axis();
        let [columns, rows, planes] = nodes;
        let beside: Vec<[Option<f64>; 2]> = (0..columns).map(|j| sectors_beside(mesh, j)).collect();
        let mut kinds: Vec<[Option<f64>; 2]> = Vec::new();
        let mut classes = Vec::new();
        for sectors in &beside {
            let known = kinds.iter().position(|kind| kind == sectors);
            classes.push(known.unwrap_or(kinds.len()));
            if known.is_none() {
                kinds.push(*sectors);
            }
        }
        let mut found = Vec::new();
        let mut masses = Vec::new();
        for kind in &kinds {
            for k in 0..planes {
                for i in 0..rows {
                    let (row, mass_kg) = node_row(nodes, elements, kind, i, k);
                    found.push(row);
                    masses.push(mass_kg);
                }
            }
        }
        let mass = |node: usize| {
            let [j, i, k] = mesh.grid_position(node);
            masses[(classes[j] * planes + k) * rows + i]
        };
        let masses_kg = (0..mesh.node_count()).map(mass).collect();
        (Self { nodes, closed: mesh.is_closed(), classes, rows: found }, masses_kg)
    }

    /// K of a mesh of a material, for looking at it, and the lumped masses [kg].
    pub fn of_mesh(mesh: &RingMesh, material: &Material) -> (Self, Vec<f64>) {
        Self::new(mesh, &Elements::new(mesh, material))
    }

    /// Classes of columns, column by column: equal numbers have equal rows.
    pub fn classes(&self) -> &[usize] {
        &self.classes
    }

    /// Computes `y = K x` for `L` lanes.
    pub fn product<const L: usize>(&self, x: &Field<L>, y: &mut Field<L>, scratch: &mut RingScratch<L>) {
        dispatch!(Level::new(), simd => self.product_in(simd, x, y, scratch));
    }

    /// Computes `y = K x` for `L` lanes and returns x·y.
    pub fn form<const L: usize>(
        &self,
        x: &Field<L>,
        y: &mut Field<L>,
        scratch: &mut RingScratch<L>,
    ) -> [f64; L] {
        self.product(x, y, scratch);
        x.dot(y)
    }

    #[inline(always)]
    fn product_in<S: Simd, const L: usize>(
        &self,
        simd: S,
        x: &Field<L>,
        y: &mut Field<L>,
        scratch: &mut RingScratch<L>,
    ) {
        let [columns, rows, planes] = self.nodes;
        self.stage(simd, x, scratch);
        let blocks = blocks_per_line::<L>(columns);
        for k in 0..planes {
            for i in 0..rows {
                for along in 0..blocks {
                    let around = Around { scratch, nodes: self.nodes, i, k, along };
                    let mut sums = [f64x8::splat(simd, 0.0); 3];
                    let kinds = &scratch.kinds[along];
                    for (nth, kind) in kinds.iter().enumerate() {
                        let row = &self.rows[(kind.class * planes + k) * rows + i];
                        let found = around.sum(simd, row);
                        if nth == 0 {
                            sums = found;
                        } else {
                            let here = f64x8::from_slice(simd, &kind.slots.0).simd_gt(f64x8::splat(simd, 0.0));
                            for c in 0..3 {
                                sums[c] = here.select(found[c], sums[c]);
                            }
                        }
                    }
                    let line = i + rows * k;
                    let out: &mut Block = &mut y.blocks_mut()[line * blocks + along];
                    for c in 0..3 {
                        sums[c].store_slice(&mut out.0[c]);
                    }
                }
            }
        }
    }

    /// Lays out x with a vector before and after each line, which hold the neighbours of its ends.
    #[inline(always)]
    fn stage<S: Simd, const L: usize>(&self, simd: S, x: &Field<L>, scratch: &mut RingScratch<L>) {
        let [columns, _, _] = self.nodes;
        let (pitch, numbers) = (scratch.pitch, columns * L);
        let blocks = x.blocks_per_line();
        for (line, from) in x.blocks().chunks_exact(blocks).enumerate() {
            let to = &mut scratch.staged[3 * line * pitch..3 * (line + 1) * pitch];
            for c in 0..3 {
                let to = &mut to[c * pitch..(c + 1) * pitch];
                for (along, block) in from.iter().enumerate() {
                    let at = WIDTH * (along + 1);
                    f64x8::from_slice(simd, &block.0[c]).store_slice(&mut to[at..at + WIDTH]);
                }
                if self.closed {
                    to.copy_within(WIDTH + numbers - L..WIDTH + numbers, WIDTH - L);
                    to.copy_within(WIDTH..WIDTH + L, WIDTH + numbers);
                }
            }
        }
    }
}

/// The lines around a block.
struct Around<'a, const L: usize> {
    scratch: &'a RingScratch<L>,
    nodes: [usize; 3],
    i: usize,
    k: usize,
    along: usize,
}

impl<const L: usize> Around<'_, L> {
    /// A row times what is around the block.
    #[inline(always)]
    fn sum<S: Simd>(&self, simd: S, row: &NodeRow) -> [f64x8<S>; 3] {
        let [_, rows, planes] = self.nodes;
        let pitch = self.scratch.pitch;
        let mut sums = [f64x8::splat(simd, 0.0); 3];
        for k in self.k.saturating_sub(1)..(self.k + 2).min(planes) {
            for i in self.i.saturating_sub(1)..(self.i + 2).min(rows) {
                let neighbour = &row[(k + 1 - self.k) * 3 + (i + 1 - self.i)];
                let start = 3 * (i + rows * k) * pitch + WIDTH * (self.along + 1);
                let mut part = [f64x8::splat(simd, 0.0); 3];
                for d in 0..3 {
                    let line = &self.scratch.staged[start + d * pitch - WIDTH..start + d * pitch + 2 * WIDTH];
                    for (column, from) in [WIDTH - L, WIDTH, WIDTH + L].into_iter().enumerate() {
                        let x = f64x8::from_slice(simd, &line[from..from + WIDTH]);
                        let factors = &neighbour[column][d];
                        part[0] += f64x8::splat(simd, factors[0]) * x;
                        part[1] += f64x8::splat(simd, factors[1]) * x;
                        part[2] += f64x8::splat(simd, factors[2]) * x;
                    }
                }
                for c in 0..3 {
                    sums[c] += part[c];
                }
            }
        }
        sums
    }
}

/// Scratch of a product.
#[derive(Debug, Clone)]
pub struct RingScratch<const L: usize> {
    /// x: line → component → a vector, the nodes in whole vectors, a vector.
    staged: Vec<f64>,
    /// Numbers of a component of a line in it.
    pitch: usize,
    /// The classes in each block along a line.
    kinds: Vec<Vec<Kind>>,
}

/// A class in a block, and 1 in the slots that belong to it.
#[derive(Debug, Clone)]
struct Kind {
    class: usize,
    slots: Row,
}

impl<const L: usize> RingScratch<L> {
    /// Scratch for products with an operator.
    pub fn new(operator: &RingOperator) -> Self {
        let [columns, rows, planes] = operator.nodes;
        let blocks = blocks_per_line::<L>(columns);
        let mut kinds: Vec<Vec<Kind>> = vec![Vec::new(); blocks];
        for along in 0..columns * L {
            let class = operator.classes[along / L];
            let kinds = &mut kinds[along / WIDTH];
            let at = kinds.iter().position(|kind| kind.class == class).unwrap_or_else(|| {
                kinds.push(Kind { class, slots: Row::default() });
                kinds.len() - 1
            });
            kinds[at].slots.0[along % WIDTH] = 1.0;
        }
        let pitch = WIDTH * (blocks + 2);
        Self { staged: vec![0.0; 3 * rows * planes * pitch], pitch, kinds }
    }
}

/// Angles of the sectors before and after a column.
fn sectors_beside(mesh: &RingMesh, j: usize) -> [Option<f64>; 2] {
    let sectors = mesh.sectors_rad();
    let before = match j {
        0 if mesh.is_closed() => sectors.last(),
        0 => None,
        _ => sectors.get(j - 1),
    };
    [before.copied(), sectors.get(j).copied()]
}

/// A node's row of K and its mass [kg].
fn node_row(
    nodes: [usize; 3],
    elements: &Elements,
    beside: &[Option<f64>; 2],
    i: usize,
    k: usize,
) -> (NodeRow, f64) {
    let [_, rows, planes] = nodes;
    let mut row: NodeRow = Default::default();
    let mut mass_kg = 0.0;
    // In the order of the elements' own places, so that K_ab and K_ba are the same sums.
    for (side, angle) in beside.iter().enumerate() {
        let Some(angle) = *angle else { continue };
        for layer in k.saturating_sub(1)..(k + 1).min(planes - 1) {
            for ring in i.saturating_sub(1)..(i + 1).min(rows - 1) {
                let element = elements.at(angle, ring, layer);
                // Corner bits: outer radius, later angle, upper plane.
                let own = (i - ring) | (1 - side) << 1 | usize::from(k == layer) << 2;
                mass_kg += element.masses_kg[own];
                for corner in 0..8 {
                    let depth = layer + 1 - (corner >> 2) + 1 - k;
                    let radius = ring + (corner & 1) + 1 - i;
                    let column = side + (corner >> 1 & 1);
                    for c in 0..3 {
                        for d in 0..3 {
                            row[depth * 3 + radius][column][d][c] +=
                                element.stiffness[(3 * own + c, 3 * corner + d)];
                        }
                    }
                }
            }
        }
    }
    (row, mass_kg)
}

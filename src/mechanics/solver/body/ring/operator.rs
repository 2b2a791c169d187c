//! The ring's stiffness: y = K x.
//!
//! A node's row of K depends on its radius, its depth and the angles of the two adjacent sectors. Columns of nodes
//! between the same angles form a class and share their rows. Vectors run along θ, where neighbours are one node
//! away, as in the pin's lines. The two ends of a line of a closed ring are neighbours.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::mesh::RingMesh;
use super::sector::{self, SectorElement};
use crate::solver::field::{Block, Field, Row, WIDTH, blocks_per_line};
use crate::solver::material::Material;
use crate::solver::simd::dispatch;
use crate::spec::Element;
use fearless_simd::{Simd, f64x8, prelude::*};

/// The elements of every distinct sector angle.
#[derive(Debug, Clone)]
pub(super) struct Elements {
    angles_rad: Vec<f64>,
    all: Vec<SectorElement>,
    layers: usize,
    rows: usize,
}

impl Elements {
    pub fn new(mesh: &RingMesh, material: &Material, kind: Element) -> Self {
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
                all.extend((0..rows).map(|i| sector::element(mesh, material, kind, i, k, angle)));
            }
        }
        Self { angles_rad, all, layers, rows }
    }

    /// All distinct elements.
    pub fn all(&self) -> &[SectorElement] {
        &self.all
    }

    /// Index in [`Elements::all`] of the element between the radii i and i + 1 and the depths k and k + 1 of a
    /// sector.
    pub fn index(&self, angle_rad: f64, i: usize, k: usize) -> usize {
        let angle = self.angles_rad.iter().position(|known| *known == angle_rad).expect("a known sector");
        (angle * self.layers + k) * self.rows + i
    }

    fn at(&self, angle_rad: f64, i: usize, k: usize) -> &SectorElement {
        &self.all[self.index(angle_rad, i, k)]
    }
}

/// The blocks of a row of K: neighbouring line (depth and radius −1, 0, 1) → column −1, 0, 1 → component of x →
/// component of y.
type NodeRow = [[[[f64; 3]; 3]; 3]; 9];

/// The row of a node between equal sectors. The row is mirror-symmetric, so 14 numbers a line are enough.
/// [`Around::even_sum`] reads them in this order.
type EvenRow = [[f64; 14]; 9];

/// K of a ring.
#[derive(Debug, Clone)]
pub struct RingOperator {
    /// Nodes in θ, r and z.
    nodes: [usize; 3],
    closed: bool,
    /// Class of every column.
    classes: Vec<usize>,
    /// Whether the two sectors of a class are equal.
    even: Vec<bool>,
    /// Class → depth → radius.
    rows: Vec<NodeRow>,
    /// Class → depth → radius. Only the rows of even classes are used.
    even_rows: Vec<EvenRow>,
}

impl RingOperator {
    /// K of a mesh, and the lumped masses \[kg\] of its nodes.
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
        let operator = Self {
            nodes,
            closed: mesh.is_closed(),
            classes,
            even: kinds.iter().map(|[before, after]| before.is_some() && before == after).collect(),
            even_rows: found.iter().map(even_row).collect(),
            rows: found,
        };
        (operator, masses_kg)
    }

    /// K of a mesh of one material, and the lumped masses \[kg\] of its nodes; for inspection and tests.
    pub fn of_mesh(mesh: &RingMesh, material: &Material) -> (Self, Vec<f64>) {
        Self::new(mesh, &Elements::new(mesh, material, Element::Full))
    }

    /// Class of every column. Columns of the same class have equal rows of K.
    pub fn classes(&self) -> &[usize] {
        &self.classes
    }

    /// The entries (3·node + component, value \[N/m\]) of one row of K, for assembled systems.
    pub fn row(&self, row: usize) -> Vec<(usize, f64)> {
        let [columns, rows, planes] = self.nodes;
        let (node, component) = (row / 3, row % 3);
        let (j, i, k) = (node % columns, node / columns % rows, node / (columns * rows));
        let blocks = &self.rows[(self.classes[j] * planes + k) * rows + i];
        let inside = |at: usize, step: usize, end: usize| (at + step).checked_sub(1).filter(|at| *at < end);
        let mut entries = Vec::with_capacity(81);
        for line in 0..9 {
            let Some((depth, radius)) = inside(k, line / 3, planes).zip(inside(i, line % 3, rows)) else {
                continue;
            };
            for step in 0..3 {
                let column = if self.closed {
                    Some((j + columns + step - 1) % columns)
                } else {
                    inside(j, step, columns)
                };
                let Some(column) = column else { continue };
                let other = column + columns * (radius + rows * depth);
                entries.extend((0..3).map(|d| (3 * other + d, blocks[line][step][d][component])));
            }
        }
        entries
    }

    /// Computes `y = K x` for `L` lanes.
    pub fn product<const L: usize>(&self, x: &Field<L>, y: &mut Field<L>, scratch: &mut RingScratch<L>) {
        dispatch!(simd => self.product_in(simd, x, y, scratch));
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
        let blocks = blocks_per_line::<f64>(columns, L);
        for k in 0..planes {
            for i in 0..rows {
                for along in 0..blocks {
                    let around = Around { scratch, nodes: self.nodes, i, k, along };
                    let mut sums = [f64x8::splat(simd, 0.0); 3];
                    let kinds = &scratch.kinds[along];
                    for (nth, kind) in kinds.iter().enumerate() {
                        let row = (kind.class * planes + k) * rows + i;
                        let found = if self.even[kind.class] {
                            around.even_sum(simd, &self.even_rows[row])
                        } else {
                            around.sum(simd, &self.rows[row])
                        };
                        if nth == 0 {
                            sums = found;
                        } else {
                            let here =
                                f64x8::from_slice(simd, &kind.slots.0).simd_gt(f64x8::splat(simd, 0.0));
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

    /// Stores x with one more vector before and after each line. These hold the neighbours of its ends.
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
        let mut sums = [f64x8::splat(simd, 0.0); 3];
        for (neighbour, line) in self.lines() {
            let factors = &row[neighbour];
            let mut part = [f64x8::splat(simd, 0.0); 3];
            for d in 0..3 {
                let window = self.window(line, d);
                for (column, from) in [WIDTH - L, WIDTH, WIDTH + L].into_iter().enumerate() {
                    let x = f64x8::from_slice(simd, &window[from..from + WIDTH]);
                    for c in 0..3 {
                        part[c] += f64x8::splat(simd, factors[column][d][c]) * x;
                    }
                }
            }
            for c in 0..3 {
                sums[c] += part[c];
            }
        }
        sums
    }

    /// The same for a node between equal sectors. Components that change their sign in the mirror image depend on
    /// differences of the neighbours, the others on sums.
    #[inline(always)]
    fn even_sum<S: Simd>(&self, simd: S, row: &EvenRow) -> [f64x8<S>; 3] {
        let zero = f64x8::splat(simd, 0.0);
        let mut sums = [zero; 3];
        for (neighbour, line) in self.lines() {
            let f = &row[neighbour];
            let (mut here, mut both, mut rise) = ([zero; 3], [zero; 3], [zero; 3]);
            for d in 0..3 {
                let window = self.window(line, d);
                let low = f64x8::from_slice(simd, &window[WIDTH - L..2 * WIDTH - L]);
                let high = f64x8::from_slice(simd, &window[WIDTH + L..2 * WIDTH + L]);
                here[d] = f64x8::from_slice(simd, &window[WIDTH..2 * WIDTH]);
                both[d] = low + high;
                rise[d] = high - low;
            }
            let [r, t, z] = here;
            sums[0] += (f64x8::splat(simd, f[0]) * r + f64x8::splat(simd, f[1]) * z)
                + (f64x8::splat(simd, f[2]) * both[0] + f64x8::splat(simd, f[3]) * both[2])
                + f64x8::splat(simd, f[4]) * rise[1];
            sums[1] += (f64x8::splat(simd, f[5]) * t + f64x8::splat(simd, f[6]) * both[1])
                + (f64x8::splat(simd, f[7]) * rise[0] + f64x8::splat(simd, f[8]) * rise[2]);
            sums[2] += (f64x8::splat(simd, f[9]) * r + f64x8::splat(simd, f[10]) * z)
                + (f64x8::splat(simd, f[11]) * both[0] + f64x8::splat(simd, f[12]) * both[2])
                + f64x8::splat(simd, f[13]) * rise[1];
        }
        sums
    }

    /// The neighbouring lines that exist: number among nine, and index of the block's window in `staged`.
    #[inline(always)]
    fn lines(&self) -> impl Iterator<Item = (usize, usize)> {
        let [_, rows, planes] = self.nodes;
        let (i, k, pitch, along) = (self.i, self.k, self.scratch.pitch, self.along);
        (k.saturating_sub(1)..(k + 2).min(planes)).flat_map(move |depth| {
            (i.saturating_sub(1)..(i + 2).min(rows)).map(move |radius| {
                ((depth + 1 - k) * 3 + (radius + 1 - i), 3 * (radius + rows * depth) * pitch + WIDTH * along)
            })
        })
    }

    /// A block of one component of a line with the vectors before and after it.
    #[inline(always)]
    fn window(&self, line: usize, component: usize) -> &[f64; 3 * WIDTH] {
        self.scratch.staged[line + component * self.scratch.pitch..]
            .first_chunk()
            .expect("a line ends with a vector")
    }
}

/// The row of a node between equal sectors, in its short form.
fn even_row(row: &NodeRow) -> EvenRow {
    std::array::from_fn(|line| {
        let here = |c: usize, d: usize| row[line][1][d][c];
        let after = |c: usize, d: usize| row[line][2][d][c];
        [
            here(0, 0),
            here(0, 2),
            after(0, 0),
            after(0, 2),
            after(0, 1),
            here(1, 1),
            after(1, 1),
            after(1, 0),
            after(1, 2),
            here(2, 0),
            here(2, 2),
            after(2, 0),
            after(2, 2),
            after(2, 1),
        ]
    })
}

/// Scratch of a product.
#[derive(Debug, Clone)]
pub struct RingScratch<const L: usize> {
    /// x: line → component → a vector, the nodes in whole vectors, a vector.
    staged: Vec<f64>,
    /// Number of values per component of a line in `staged`.
    pitch: usize,
    /// The classes in each block along a line.
    kinds: Vec<Vec<Kind>>,
}

/// A class that occurs in a block, with 1 in the slots that belong to it.
#[derive(Debug, Clone)]
struct Kind {
    class: usize,
    slots: Row,
}

impl<const L: usize> RingScratch<L> {
    /// Scratch for products with an operator.
    pub fn new(operator: &RingOperator) -> Self {
        let [columns, rows, planes] = operator.nodes;
        let blocks = blocks_per_line::<f64>(columns, L);
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

/// A node's row of K and its mass \[kg\].
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
    // The elements are added in the order of their positions, so that K_ab and K_ba are the same sums.
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

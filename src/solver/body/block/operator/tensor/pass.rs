//! One sweep over the mesh that gives K x block by block.
//!
//! The sweep goes plane by plane. It first computes the plane's x and stores it in lines with a zero node on either
//! side. Then it goes along y through each column of blocks. The x-sums of three consecutive lines stay in
//! registers and give the y-sums. The y-sums give the plane's contributions to itself and to its two neighbours.
//! After that the plane below is complete.
//!
//! Vectors run along x and lanes, and no sum runs along them. Every number goes through the same operations in the
//! same order (plain multiply and add, never fused), whatever the vector width and the lane count. Only the sign of
//! a zero sum may differ, because blocks without an end of a line leave out the terms of the ends.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::TensorOperator;
use crate::solver::body::block::BlockMesh;
use crate::solver::field::{Row, WIDTH, blocks_per_line};
use fearless_simd::{Simd, f64x8, prelude::*};

/// Position of a block.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct BlockIndex {
    /// Plane of nodes, from the contact face upwards.
    pub plane: usize,
    /// Line of nodes, y faster than z.
    pub line: usize,
    /// Block along the line.
    pub along: usize,
    /// Index of the block in its field.
    pub at: usize,
}

/// The input and the output of a product, block by block.
pub(in crate::solver) trait Pass<S: Simd> {
    /// The three components of x in block `at`.
    fn input(&self, simd: S, at: usize) -> [f64x8<S>; 3];
    /// Takes the three components of K x in a block. The inputs of its plane and of those below are not read again,
    /// so it may overwrite them. Planes come in their order, the blocks of a plane column by column.
    fn output(&mut self, simd: S, index: BlockIndex, kx: [f64x8<S>; 3]);
}

/// Scratch of a pass.
#[derive(Debug)]
pub struct Scratch<const L: usize> {
    /// x of the current plane: line → component → a vector that ends with a zero node, the nodes, a vector of
    /// zeros.
    staged: Vec<f64>,
    /// Number of values per component of a line in `staged`.
    pitch: usize,
    /// Partial sums: block along the line → line.
    columns: Vec<PlaneSums>,
    ends: Vec<Ends>,
    /// Room for x·Kx by columns.
    forms: Vec<Row>,
}

#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct PlaneSums {
    /// Sum of the plane before, without the contribution of the current plane.
    before: [[f64; WIDTH]; 3],
    /// Contribution of the plane before to the current plane.
    ahead: [[f64; WIDTH]; 3],
}

/// Diagonal entries along x in a block: of Ŝ (`centre`), of M̂ (`double`), and of B̂ (`outward`).
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct Ends {
    centre: [f64; WIDTH],
    double: [f64; WIDTH],
    outward: [f64; WIDTH],
}

impl Ends {
    /// Whether the block holds an end of the line.
    fn any(&self) -> bool {
        self.outward.iter().any(|b| *b != 0.0)
    }
}

/// Number of bytes of a cache line. Vectors begin at its boundaries.
const ALIGNMENT: usize = 64;

impl<const L: usize> Scratch<L> {
    /// Scratch for products on `mesh`.
    pub fn new(mesh: &BlockMesh) -> Self {
        let [mx, my, _] = mesh.nodes_per_axis();
        let blocks = blocks_per_line::<L>(mx);
        let mut ends =
            vec![Ends { centre: [2.0; WIDTH], double: [4.0; WIDTH], outward: [0.0; WIDTH] }; blocks];
        for along in 0..mx * L {
            let (block, slot, node) = (along / WIDTH, along % WIDTH, along / L);
            let centre = if node == 0 || node + 1 == mx { 1.0 } else { 2.0 };
            ends[block].centre[slot] = centre;
            ends[block].double[slot] = 2.0 * centre;
            ends[block].outward[slot] = outward(node, mx);
        }
        let pitch = WIDTH * (blocks + 2);
        Self {
            staged: vec![0.0; 3 * my * pitch + WIDTH],
            pitch,
            columns: vec![PlaneSums::default(); blocks * my],
            ends,
            forms: vec![Row::default(); blocks],
        }
    }

    /// Takes the room for x·Kx, set to zero. [`Scratch::give_forms`] returns it.
    pub(super) fn take_forms(&mut self) -> Vec<Row> {
        let mut forms = std::mem::take(&mut self.forms);
        forms.fill(Row::default());
        forms
    }

    pub(super) fn give_forms(&mut self, forms: Vec<Row>) {
        self.forms = forms;
    }
}

impl<const L: usize> Clone for Scratch<L> {
    /// Makes fresh scratch. The offset of the copy to its cache line differs, so its zero nodes have other indices.
    fn clone(&self) -> Self {
        Self {
            staged: vec![0.0; self.staged.len()],
            pitch: self.pitch,
            columns: vec![PlaneSums::default(); self.columns.len()],
            ends: self.ends.clone(),
            forms: self.forms.clone(),
        }
    }
}

/// Diagonal of B̂: −1 at the low end, 1 at the high end, 0 between.
fn outward(index: usize, nodes: usize) -> f64 {
    if index == 0 {
        -1.0
    } else if index + 1 == nodes {
        1.0
    } else {
        0.0
    }
}

/// x-sums of a block of a line, for each component: M̂x (`m`), Ŝx (`s`), and the Â and B̂ terms of the couplings
/// (`a`).
#[derive(Clone, Copy)]
struct LineSums<S: Simd> {
    m: [f64x8<S>; 3],
    s: [f64x8<S>; 3],
    a: [f64x8<S>; 3],
}

/// A column of blocks of a plane.
struct Column<'a, const L: usize> {
    staged: &'a [f64],
    pitch: usize,
    along: usize,
    ends: &'a Ends,
}

/// A vector of a line with the vectors before and after it.
type Window = [f64; 3 * WIDTH];

impl<const L: usize> Column<'_, L> {
    /// The windows of one component, line by line.
    #[inline(always)]
    fn windows(&self, c: usize) -> impl Iterator<Item = &Window> {
        let start = c * self.pitch + WIDTH * self.along;
        self.staged[start..].chunks(3 * self.pitch).map_while(<[f64]>::first_chunk)
    }

    /// B̂x of the block of line `j`, component `c`.
    #[inline(always)]
    fn outward<S: Simd>(&self, simd: S, j: usize, c: usize) -> f64x8<S> {
        let start = (3 * j + c) * self.pitch + WIDTH * (self.along + 1);
        let here = f64x8::from_slice(simd, &self.staged[start..start + WIDTH]);
        f64x8::from_slice(simd, &self.ends.outward) * here
    }
}

#[inline(always)]
fn here<S: Simd>(simd: S, window: &Window) -> f64x8<S> {
    f64x8::from_slice(simd, &window[WIDTH..2 * WIDTH])
}

impl TensorOperator {
    /// One pass over the mesh.
    #[inline(always)]
    pub(in crate::solver) fn pass<S: Simd, const L: usize>(
        &self,
        simd: S,
        pass: &mut impl Pass<S>,
        scratch: &mut Scratch<L>,
    ) {
        let [_, my, mz] = self.nodes;
        let blocks = scratch.ends.len();
        for k in 0..mz {
            self.stage(simd, pass, k, scratch);
            for along in 0..blocks {
                match (outward(k, mz) != 0.0, scratch.ends[along].any()) {
                    (false, false) => self.march::<S, L, false, false>(simd, pass, k, along, scratch),
                    (true, false) => self.march::<S, L, true, false>(simd, pass, k, along, scratch),
                    (false, true) => self.march::<S, L, false, true>(simd, pass, k, along, scratch),
                    (true, true) => self.march::<S, L, true, true>(simd, pass, k, along, scratch),
                }
            }
        }
        for (along, column) in scratch.columns.chunks_exact(my).enumerate() {
            for (j, sums) in column.iter().enumerate() {
                let line = j + my * (mz - 1);
                let index = BlockIndex { plane: mz - 1, line, along, at: line * blocks + along };
                pass.output(simd, index, load_all(simd, &sums.before));
            }
        }
    }

    /// Stores x of plane `k` in `staged`.
    #[inline(always)]
    fn stage<S: Simd, const L: usize>(
        &self,
        simd: S,
        pass: &impl Pass<S>,
        k: usize,
        scratch: &mut Scratch<L>,
    ) {
        let my = self.nodes[1];
        let blocks = scratch.ends.len();
        let first = scratch.staged.as_ptr().align_offset(ALIGNMENT);
        let staged = &mut scratch.staged[first..];
        for j in 0..my {
            let at = (j + my * k) * blocks;
            let line = &mut staged[3 * j * scratch.pitch..3 * (j + 1) * scratch.pitch];
            for along in 0..blocks {
                let x = pass.input(simd, at + along);
                for c in 0..3 {
                    let start = c * scratch.pitch + WIDTH * (along + 1);
                    x[c].store_slice(&mut line[start..start + WIDTH]);
                }
            }
        }
    }

    /// Forms the sums over y and z of a column of blocks of plane `k`, and completes that column of plane `k` − 1.
    #[inline(always)]
    fn march<S: Simd, const L: usize, const Z: bool, const ENDS: bool>(
        &self,
        simd: S,
        pass: &mut impl Pass<S>,
        k: usize,
        along: usize,
        scratch: &mut Scratch<L>,
    ) {
        let [_, my, mz] = self.nodes;
        let blocks = scratch.ends.len();
        let first = scratch.staged.as_ptr().align_offset(ALIGNMENT);
        let staged = &scratch.staged[first..];
        let column = Column::<L> { staged, pitch: scratch.pitch, along, ends: &scratch.ends[along] };
        let sums = &mut scratch.columns[along * my..(along + 1) * my];
        let zero = [f64x8::splat(simd, 0.0); 3];
        let none = LineSums { m: zero, s: zero, a: zero };
        let out_z = outward(k, mz);
        let mut windows = column.windows(0).zip(column.windows(1)).zip(column.windows(2));
        let mut lines = [none; 3];
        if let Some(((x, y), z)) = windows.next() {
            lines[1] = self.sum_along_x::<S, L, ENDS>(simd, column.ends, [x, y, z]);
        }
        for (j, sums) in sums.iter_mut().enumerate() {
            if let Some(((x, y), z)) = windows.next() {
                lines[2] = self.sum_along_x::<S, L, ENDS>(simd, column.ends, [x, y, z]);
            }
            let below = if j == 0 || j + 1 == my {
                self.combine::<S, L, true, Z, ENDS>(simd, &column, j, out_z, &lines, sums)
            } else {
                self.combine::<S, L, false, Z, ENDS>(simd, &column, j, out_z, &lines, sums)
            };
            if k > 0 {
                let line = j + my * (k - 1);
                pass.output(simd, BlockIndex { plane: k - 1, line, along, at: line * blocks + along }, below);
            }
            lines = [lines[1], lines[2], none];
        }
    }

    #[inline(always)]
    fn sum_along_x<S: Simd, const L: usize, const ENDS: bool>(
        &self,
        simd: S,
        ends: &Ends,
        windows: [&Window; 3],
    ) -> LineSums<S> {
        let zero = [f64x8::splat(simd, 0.0); 3];
        let mut sums = LineSums { m: zero, s: zero, a: zero };
        let skew = [self.skew[0], self.skew[0], self.skew[1]];
        let edge = [self.edge[0], -self.edge[0], -self.edge[1]];
        for c in 0..3 {
            let window = windows[c];
            let low = f64x8::from_slice(simd, &window[WIDTH - L..2 * WIDTH - L]);
            let here = here(simd, window);
            let high = f64x8::from_slice(simd, &window[WIDTH + L..2 * WIDTH + L]);
            let both = low + high;
            sums.a[c] = f64x8::splat(simd, skew[c]) * (low - high);
            let (single, double) = if ENDS {
                sums.a[c] += f64x8::splat(simd, edge[c]) * (f64x8::from_slice(simd, &ends.outward) * here);
                (f64x8::from_slice(simd, &ends.centre) * here, f64x8::from_slice(simd, &ends.double) * here)
            } else {
                (f64x8::splat(simd, self.powers[1]) * here, f64x8::splat(simd, self.powers[2]) * here)
            };
            sums.m[c] = double + both;
            sums.s[c] = single - both;
        }
        sums
    }

    /// Adds the contributions of line `j` of a plane to the plane itself and to its neighbours, from the x-sums of
    /// the lines j − 1, j, j + 1. The code is compiled for a line on a face in y or not (`Y`), a plane on a face in
    /// z or not (`Z`), and a block with an end in x or not (`ENDS`). Returns the completed K x of the plane before.
    #[inline(always)]
    fn combine<S: Simd, const L: usize, const Y: bool, const Z: bool, const ENDS: bool>(
        &self,
        simd: S,
        column: &Column<'_, L>,
        j: usize,
        out_z: f64,
        lines: &[LineSums<S>; 3],
        plane: &mut PlaneSums,
    ) -> [f64x8<S>; 3] {
        let [low, here, high] = lines;
        let my = self.nodes[1];
        let zero = f64x8::splat(simd, 0.0);
        let [single_y, double_y] = self.centre::<S, Y>(simd);
        let [single_z, double_z] = self.centre::<S, Z>(simd);
        let skew_yz = f64x8::splat(simd, self.skew[2]);
        let out_y = outward(j, my);
        let mut p = [zero; 3];
        let mut b = [zero; 3];
        for c in 0..3 {
            let both = low.m[c] + high.m[c];
            let sy_m = single_y * here.m[c] - both;
            let my_m = double_y * here.m[c] + both;
            let my_s = double_y * here.s[c] + (low.s[c] + high.s[c]);
            p[c] = f64x8::splat(simd, self.own[c][0]) * my_s + f64x8::splat(simd, self.own[c][1]) * sy_m;
            b[c] = f64x8::splat(simd, self.own[c][2]) * my_m;
        }
        p[0] += low.a[1] - high.a[1];
        p[1] += low.a[0] - high.a[0];
        let ratio = f64x8::splat(simd, self.skew[1] / self.skew[0]);
        let from_x = ratio * spread(double_y, low.a[0], here.a[0], high.a[0]);
        let mut from_y = skew_yz * (low.m[1] - high.m[1]);
        let mut e =
            [spread(double_y, low.a[2], here.a[2], high.a[2]), skew_yz * (low.m[2] - high.m[2]), zero];
        if Y {
            let share = f64x8::splat(simd, out_y * self.share);
            p[0] -= share * here.a[1];
            p[1] += share * here.a[0];
            if ENDS {
                let corner = f64x8::splat(simd, out_y * self.corner[0]);
                p[0] += corner * column.outward(simd, j, 1);
                p[1] += corner * column.outward(simd, j, 0);
            }
            let edge = f64x8::splat(simd, out_y * self.edge[2]);
            from_y += edge * here.m[1];
            e[1] -= edge * here.m[2];
        }
        e[2] = from_x + from_y;
        let mut centre = [zero; 3];
        for c in 0..3 {
            centre[c] = double_z * p[c] + single_z * b[c];
        }
        if Z {
            let share = f64x8::splat(simd, out_z * self.share);
            centre[0] -= share * e[0];
            centre[1] -= share * e[1];
            centre[2] += share * e[2];
            if ENDS {
                let corner = f64x8::splat(simd, out_z * self.corner[1]);
                centre[0] += corner * self.spread_outward::<S, L>(simd, column, j, 2, double_y);
                centre[2] += corner * self.spread_outward::<S, L>(simd, column, j, 0, double_y);
            }
            if Y {
                let corner = f64x8::splat(simd, out_z * out_y * self.corner[2]);
                centre[1] += corner * here.m[2];
                centre[2] += corner * here.m[1];
            }
        }
        // The first plane reads zeros from `ahead`, because the last plane of a pass stores zeros there.
        let before = load_all(simd, &plane.before);
        let ahead = load_all(simd, &plane.ahead);
        let is_last = Z && out_z > 0.0;
        let mut below = [zero; 3];
        for c in 0..3 {
            let level = p[c] - b[c];
            below[c] = before[c] + (level - e[c]);
            (centre[c] + ahead[c]).store_slice(&mut plane.before[c]);
            let next = if is_last { zero } else { level + e[c] };
            next.store_slice(&mut plane.ahead[c]);
        }
        below
    }

    /// Diagonal entries of Ŝ and M̂ in a direction, for a node on a face or inside.
    #[inline(always)]
    fn centre<S: Simd, const FACE: bool>(&self, simd: S) -> [f64x8<S>; 2] {
        let first = usize::from(!FACE);
        [f64x8::splat(simd, self.powers[first]), f64x8::splat(simd, self.powers[first + 1])]
    }

    /// M̂y B̂x of one component.
    #[inline(always)]
    fn spread_outward<S: Simd, const L: usize>(
        &self,
        simd: S,
        column: &Column<'_, L>,
        j: usize,
        c: usize,
        double_y: f64x8<S>,
    ) -> f64x8<S> {
        let zero = f64x8::splat(simd, 0.0);
        let low = if j > 0 { column.outward(simd, j - 1, c) } else { zero };
        let high = if j + 1 < self.nodes[1] { column.outward(simd, j + 1, c) } else { zero };
        spread(double_y, low, column.outward(simd, j, c), high)
    }
}

/// Loads three rows as vectors. `map` on the array would compile to a call, across which vectors do not stay in
/// registers.
#[inline(always)]
pub(crate) fn load_all<S: Simd>(simd: S, rows: &[[f64; WIDTH]; 3]) -> [f64x8<S>; 3] {
    [f64x8::from_slice(simd, &rows[0]), f64x8::from_slice(simd, &rows[1]), f64x8::from_slice(simd, &rows[2])]
}

/// centre·here + (low + high).
#[inline(always)]
fn spread<S: Simd>(centre: f64x8<S>, low: f64x8<S>, here: f64x8<S>, high: f64x8<S>) -> f64x8<S> {
    centre * here + (low + high)
}

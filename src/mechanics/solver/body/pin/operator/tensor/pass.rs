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
use crate::solver::body::pin::operator::{BlockIndex, Pass};
use crate::solver::field::{Layout, blocks_per_line};
use crate::solver::number::Number;
use crate::solver::simd::{load, load_all, splat};
use fearless_simd::{Simd, prelude::*};

/// Scratch of a pass.
#[derive(Debug)]
pub(in crate::solver) struct TensorScratch<R: Number> {
    /// Number of lanes. It is no constant of the code, which is compiled once for all lane counts.
    lanes: usize,
    /// x of the current plane: line → component → a vector that ends with a zero node, the nodes, a vector of
    /// zeros.
    staged: Vec<R>,
    /// Number of values per component of a line in `staged`.
    pitch: usize,
    /// Partial sums: block along the line → line.
    columns: Vec<PlaneSums<R>>,
    ends: Vec<Ends<R>>,
}

#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct PlaneSums<R: Number> {
    /// Sum of the plane before, without the contribution of the current plane.
    before: [R::Row; 3],
    /// Contribution of the plane before to the current plane, which is not in its sum yet.
    ahead: [R::Row; 3],
}

/// Diagonal entries along x in a block: of Ŝ (`centre`), of M̂ (`double`), and of B̂ (`outward`).
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct Ends<R: Number> {
    centre: R::Row,
    double: R::Row,
    outward: R::Row,
}

impl<R: Number> Ends<R> {
    /// Whether the block holds an end of the line.
    fn any(&self) -> bool {
        self.outward.as_ref().iter().any(|b| *b != R::default())
    }
}

/// Number of bytes of a cache line. Vectors begin at its boundaries.
const ALIGNMENT: usize = 64;

impl<R: Number> TensorScratch<R> {
    /// Scratch for products of fields with `lanes` lanes.
    pub fn new(layout: Layout, lanes: usize) -> Self {
        let Layout { nodes_per_line: mx, lines_per_plane: my, .. } = layout;
        let blocks = blocks_per_line::<R>(mx, lanes);
        let mut inside = Ends::<R>::default();
        inside.centre.as_mut().fill(R::from_f64(2.0));
        inside.double.as_mut().fill(R::from_f64(4.0));
        let mut ends = vec![inside; blocks];
        for along in 0..mx * lanes {
            let (block, slot, node) = (along / R::WIDTH, along % R::WIDTH, along / lanes);
            let centre = if node == 0 || node + 1 == mx { 1.0 } else { 2.0 };
            ends[block].centre[slot] = R::from_f64(centre);
            ends[block].double[slot] = R::from_f64(2.0 * centre);
            ends[block].outward[slot] = R::from_f64(outward(node, mx));
        }
        let pitch = R::WIDTH * (blocks + 2);
        Self {
            lanes,
            staged: vec![R::default(); 3 * my * pitch + R::WIDTH],
            pitch,
            columns: vec![PlaneSums::default(); blocks * my],
            ends,
        }
    }
}

impl<R: Number> Clone for TensorScratch<R> {
    /// Makes fresh scratch. The offset of the copy to its cache line differs, so its zero nodes have other indices.
    fn clone(&self) -> Self {
        Self {
            lanes: self.lanes,
            staged: vec![R::default(); self.staged.len()],
            pitch: self.pitch,
            columns: vec![PlaneSums::default(); self.columns.len()],
            ends: self.ends.clone(),
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
struct LineSums<V> {
    m: [V; 3],
    s: [V; 3],
    a: [V; 3],
}

/// A column of blocks of a plane.
struct Column<'a, R: Number> {
    /// Number of lanes, at most the width of a vector.
    lanes: usize,
    staged: &'a [R],
    pitch: usize,
    along: usize,
    ends: &'a Ends<R>,
}

impl<R: Number> Column<'_, R> {
    /// The windows of one component, line by line: a vector with the vectors before and after it.
    #[inline(always)]
    fn windows(&self, c: usize) -> impl Iterator<Item = &[R]> {
        let start = c * self.pitch + R::WIDTH * self.along;
        self.staged[start..].chunks(3 * self.pitch).map_while(|line| line.get(..3 * R::WIDTH))
    }

    /// B̂x of the block of line `j`, component `c`.
    #[inline(always)]
    fn outward<S: Simd>(&self, simd: S, j: usize, c: usize) -> R::Vector<S> {
        let start = (3 * j + c) * self.pitch + R::WIDTH * (self.along + 1);
        let here = R::Vector::<S>::from_slice(simd, &self.staged[start..start + R::WIDTH]);
        load::<R, S>(simd, &self.ends.outward) * here
    }
}

impl TensorOperator {
    /// One pass over the mesh.
    #[inline(always)]
    pub(in crate::solver::body::pin::operator) fn pass<S: Simd, R: Number>(
        &self,
        simd: S,
        pass: &mut impl Pass<S, R>,
        scratch: &mut TensorScratch<R>,
    ) {
        Coefficients::of(self).pass(simd, pass, scratch);
    }
}

/// The coefficients of a [`TensorOperator`] in the numbers of the fields. To round them where they are used would take as
/// long as the products.
struct Coefficients<R: Number> {
    nodes: [usize; 3],
    own: [[R; 3]; 3],
    skew: [R; 3],
    /// The second over the first coefficient in `skew`.
    skew_ratio: R,
    /// `edge` of the couplings in the x-sums of each component.
    edge_along_x: [R; 3],
    /// `edge` of the coupling yz.
    edge_yz: R,
    share: R,
    corner: [R; 3],
    powers: [R; 3],
}

impl<R: Number> Coefficients<R> {
    fn of(operator: &TensorOperator) -> Self {
        let TensorOperator { nodes, own, skew, edge, share, corner, powers, .. } = operator;
        Self {
            nodes: *nodes,
            own: own.map(|row| row.map(R::from_f64)),
            skew: skew.map(R::from_f64),
            skew_ratio: R::from_f64(skew[1] / skew[0]),
            edge_along_x: [edge[0], -edge[0], -edge[1]].map(R::from_f64),
            edge_yz: R::from_f64(edge[2]),
            share: R::from_f64(*share),
            corner: corner.map(R::from_f64),
            powers: powers.map(R::from_f64),
        }
    }

    #[inline(always)]
    fn pass<S: Simd>(&self, simd: S, pass: &mut impl Pass<S, R>, scratch: &mut TensorScratch<R>) {
        let [_, my, mz] = self.nodes;
        let blocks = scratch.ends.len();
        for k in 0..mz {
            self.stage(simd, pass, k, scratch);
            for along in 0..blocks {
                match (outward(k, mz) != 0.0, scratch.ends[along].any()) {
                    (false, false) => self.march::<S, false, false>(simd, pass, k, along, scratch),
                    (true, false) => self.march::<S, true, false>(simd, pass, k, along, scratch),
                    (false, true) => self.march::<S, false, true>(simd, pass, k, along, scratch),
                    (true, true) => self.march::<S, true, true>(simd, pass, k, along, scratch),
                }
            }
        }
        for (along, column) in scratch.columns.chunks_exact(my).enumerate() {
            for (j, sums) in column.iter().enumerate() {
                let line = j + my * (mz - 1);
                let index = BlockIndex { plane: mz - 1, line, along, at: line * blocks + along };
                pass.output(simd, index, load_all::<R, S>(simd, &sums.before));
            }
        }
    }

    /// Stores x of plane `k` in `staged`.
    #[inline(always)]
    fn stage<S: Simd>(&self, simd: S, pass: &impl Pass<S, R>, k: usize, scratch: &mut TensorScratch<R>) {
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
                    let start = c * scratch.pitch + R::WIDTH * (along + 1);
                    x[c].store_slice(&mut line[start..start + R::WIDTH]);
                }
            }
        }
    }

    /// Forms the sums over y and z of a column of blocks of plane `k`, and completes that column of plane `k` − 1.
    #[inline(always)]
    fn march<S: Simd, const Z: bool, const ENDS: bool>(
        &self,
        simd: S,
        pass: &mut impl Pass<S, R>,
        k: usize,
        along: usize,
        scratch: &mut TensorScratch<R>,
    ) {
        let [_, my, mz] = self.nodes;
        let blocks = scratch.ends.len();
        let first = scratch.staged.as_ptr().align_offset(ALIGNMENT);
        let staged = &scratch.staged[first..];
        let column = Column {
            // The bound lets the compiler leave out checks of every window.
            lanes: scratch.lanes.min(R::WIDTH),
            staged,
            pitch: scratch.pitch,
            along,
            ends: &scratch.ends[along],
        };
        let sums = &mut scratch.columns[along * my..(along + 1) * my];
        let zero = [splat::<R, S>(simd, 0.0); 3];
        let none = LineSums { m: zero, s: zero, a: zero };
        let out_z = outward(k, mz);
        let mut windows = column.windows(0).zip(column.windows(1)).zip(column.windows(2));
        let mut lines = [none; 3];
        if let Some(((x, y), z)) = windows.next() {
            lines[1] = self.sum_along_x::<S, ENDS>(simd, &column, [x, y, z]);
        }
        for (j, sums) in sums.iter_mut().enumerate() {
            if let Some(((x, y), z)) = windows.next() {
                lines[2] = self.sum_along_x::<S, ENDS>(simd, &column, [x, y, z]);
            }
            let below = if j == 0 || j + 1 == my {
                self.combine::<S, true, Z, ENDS>(simd, &column, j, out_z, &lines, sums)
            } else {
                self.combine::<S, false, Z, ENDS>(simd, &column, j, out_z, &lines, sums)
            };
            if k > 0 {
                let line = j + my * (k - 1);
                pass.output(simd, BlockIndex { plane: k - 1, line, along, at: line * blocks + along }, below);
            }
            lines = [lines[1], lines[2], none];
        }
    }

    #[inline(always)]
    fn sum_along_x<S: Simd, const ENDS: bool>(
        &self,
        simd: S,
        column: &Column<'_, R>,
        windows: [&[R]; 3],
    ) -> LineSums<R::Vector<S>> {
        let all = |value: R| R::Vector::<S>::splat(simd, value);
        let zero = [splat::<R, S>(simd, 0.0); 3];
        let mut sums = LineSums { m: zero, s: zero, a: zero };
        let skew = [self.skew[0], self.skew[0], self.skew[1]];
        for c in 0..3 {
            let from = |start: usize| R::Vector::<S>::from_slice(simd, &windows[c][start..start + R::WIDTH]);
            let low = from(R::WIDTH - column.lanes);
            let here = from(R::WIDTH);
            let high = from(R::WIDTH + column.lanes);
            let both = low + high;
            sums.a[c] = all(skew[c]) * (low - high);
            let (single, double) = if ENDS {
                let ends = column.ends;
                sums.a[c] += all(self.edge_along_x[c]) * (load::<R, S>(simd, &ends.outward) * here);
                (load::<R, S>(simd, &ends.centre) * here, load::<R, S>(simd, &ends.double) * here)
            } else {
                (all(self.powers[1]) * here, all(self.powers[2]) * here)
            };
            sums.m[c] = double + both;
            sums.s[c] = single - both;
        }
        sums
    }

    /// Adds the contributions of line `j` of plane k to the planes k − 1, k and k + 1, and returns the completed K x of line `j` of
    /// plane k − 1. Four lines and four planes, when k = 2 and j = 1:
    ///
    /// ```text
    ///              line 0     1     2    3
    ///     plane 3       ·     ◇     ·    ·     ◇ gets a contribution, which waits in `ahead`
    ///     plane 2      low  here  high   ·     the lines of which x is read
    ///     plane 1       ■     ◆     □    □     □ has a sum without plane 2, in `before`; ◆ is completed now
    ///     plane 0       ■     ■     ■    ■     ■ is complete and given to the pass
    /// ```
    ///
    /// Every term of K is a matrix in z times one in y times one in x. The x-sums are in `lines`. Here come the sums over y, which
    /// are collected by their matrix in z:
    ///
    /// ```text
    ///     p   all terms with M̂z: Ŝx M̂y and M̂x Ŝy of each component (K_xx, K_yy, K_zz), and the coupling xy
    ///     b   all terms with Ŝz: M̂x M̂y of each component
    ///     e   all terms with Âz: the couplings xz and yz
    ///         z is coupled to x by `from_x`, and to y by `from_y`; x and y are coupled to z in e[0] and e[1]
    /// ```
    ///
    /// So a column of the matrices in z says what the plane gives to which plane:
    ///
    /// ```text
    ///                    M̂z       Ŝz       Âz    B̂z
    ///     plane k + 1    1·p     −1·b     +1·e           `ahead` = (p − b) + e
    ///     plane k        4·p      2·b            ±e      `centre`; on a face 2·p and 1·b, and e by B̂z
    ///     plane k − 1    1·p     −1·b     −1·e           `below` = `before` + (p − b) − e
    /// ```
    ///
    /// B̂ is zero except at the two ends of a direction. With it a coupling has the `share` of its term with Â, turned outwards (`turned`),
    /// and a `corner` where two faces meet. The code is compiled for a line on a face in y or not (`Y`), a plane on a face in z or
    /// not (`Z`), and a block with an end in x or not (`ENDS`), so that it does without these terms inside.
    #[inline(always)]
    fn combine<S: Simd, const Y: bool, const Z: bool, const ENDS: bool>(
        &self,
        simd: S,
        column: &Column<'_, R>,
        j: usize,
        out_z: f64,
        lines: &[LineSums<R::Vector<S>>; 3],
        plane: &mut PlaneSums<R>,
    ) -> [R::Vector<S>; 3] {
        let all = |value: R| R::Vector::<S>::splat(simd, value);
        let [low, here, high] = lines;
        let my = self.nodes[1];
        let zero = splat::<R, S>(simd, 0.0);
        let [single_y, double_y] = self.centre::<S, Y>(simd);
        let [single_z, double_z] = self.centre::<S, Z>(simd);
        let skew_yz = all(self.skew[2]);
        let out_y = outward(j, my);
        let turned = |by: f64, value: R| splat::<R, S>(simd, by) * all(value);
        let mut p = [zero; 3];
        let mut b = [zero; 3];
        for c in 0..3 {
            let both = low.m[c] + high.m[c];
            let sy_m = single_y * here.m[c] - both;
            let my_m = double_y * here.m[c] + both;
            let my_s = double_y * here.s[c] + (low.s[c] + high.s[c]);
            p[c] = all(self.own[c][0]) * my_s + all(self.own[c][1]) * sy_m;
            b[c] = all(self.own[c][2]) * my_m;
        }
        p[0] += low.a[1] - high.a[1];
        p[1] += low.a[0] - high.a[0];
        let ratio = all(self.skew_ratio);
        let from_x = ratio * spread::<R, S>(double_y, low.a[0], here.a[0], high.a[0]);
        let mut from_y = skew_yz * (low.m[1] - high.m[1]);
        let mut e = [
            spread::<R, S>(double_y, low.a[2], here.a[2], high.a[2]),
            skew_yz * (low.m[2] - high.m[2]),
            zero,
        ];
        if Y {
            let share = turned(out_y, self.share);
            p[0] -= share * here.a[1];
            p[1] += share * here.a[0];
            if ENDS {
                let corner = turned(out_y, self.corner[0]);
                p[0] += corner * column.outward(simd, j, 1);
                p[1] += corner * column.outward(simd, j, 0);
            }
            let edge = turned(out_y, self.edge_yz);
            from_y += edge * here.m[1];
            e[1] -= edge * here.m[2];
        }
        e[2] = from_x + from_y;
        let mut centre = [zero; 3];
        for c in 0..3 {
            centre[c] = double_z * p[c] + single_z * b[c];
        }
        if Z {
            let share = turned(out_z, self.share);
            centre[0] -= share * e[0];
            centre[1] -= share * e[1];
            centre[2] += share * e[2];
            if ENDS {
                let corner = turned(out_z, self.corner[1]);
                centre[0] += corner * self.spread_outward::<S>(simd, column, j, 2, double_y);
                centre[2] += corner * self.spread_outward::<S>(simd, column, j, 0, double_y);
            }
            if Y {
                let corner = turned(out_z * out_y, self.corner[2]);
                centre[1] += corner * here.m[2];
                centre[2] += corner * here.m[1];
            }
        }
        // The first plane reads zeros from `ahead`, because the last plane of a pass stores zeros there.
        let before = load_all::<R, S>(simd, &plane.before);
        let ahead = load_all::<R, S>(simd, &plane.ahead);
        let is_last = Z && out_z > 0.0;
        let mut below = [zero; 3];
        for c in 0..3 {
            let level = p[c] - b[c];
            below[c] = before[c] + (level - e[c]);
            (centre[c] + ahead[c]).store_array(&mut plane.before[c]);
            let next = if is_last { zero } else { level + e[c] };
            next.store_array(&mut plane.ahead[c]);
        }
        below
    }

    /// Diagonal entries of Ŝ and M̂ in a direction, for a node on a face or inside.
    #[inline(always)]
    fn centre<S: Simd, const FACE: bool>(&self, simd: S) -> [R::Vector<S>; 2] {
        let first = usize::from(!FACE);
        [self.powers[first], self.powers[first + 1]].map(|power| R::Vector::<S>::splat(simd, power))
    }

    /// M̂y B̂x of one component.
    #[inline(always)]
    fn spread_outward<S: Simd>(
        &self,
        simd: S,
        column: &Column<'_, R>,
        j: usize,
        c: usize,
        double_y: R::Vector<S>,
    ) -> R::Vector<S> {
        let zero = splat::<R, S>(simd, 0.0);
        let low = if j > 0 { column.outward(simd, j - 1, c) } else { zero };
        let high = if j + 1 < self.nodes[1] { column.outward(simd, j + 1, c) } else { zero };
        spread::<R, S>(double_y, low, column.outward(simd, j, c), high)
    }
}

/// centre·here + (low + high).
#[inline(always)]
fn spread<R: Number, S: Simd>(
    centre: R::Vector<S>,
    low: R::Vector<S>,
    here: R::Vector<S>,
    high: R::Vector<S>,
) -> R::Vector<S> {
    centre * here + (low + high)
}

//! K of a uniform block as a sum of tensor products of one-dimensional matrices.
//!
//! On a uniform block of trilinear, fully integrated hexahedra every term of the elastic energy is a product of
//! one-dimensional integrals, boundaries included: with the mass M = ∫NᵢNⱼ, the stiffness S = ∫Nᵢ′Nⱼ′ and the
//! derivative D = ∫Nᵢ′Nⱼ of linear elements in each direction,
//!
//! ```text
//! K_xx = (λ+2G) Sx My Mz + G Mx Sy Mz + G Mx My Sz          (and cyclic)
//! K_xy = λ Dx Dyᵀ Mz + G Dxᵀ Dy Mz                          (and so on)
//! ```
//!
//! M = h/6 M̂ and S = Ŝ/h have the rows M̂ = (1, 4, 1), Ŝ = (−1, 2, −1), with 2 and 1 in the centre at the two
//! ends. D = (Â + B̂)/2 and Dᵀ = (−Â + B̂)/2 with Â = (1, 0, −1) and B̂ = −1, 0, …, 0, 1 on the diagonal, so
//!
//! ```text
//! K_xy = Mz/4 { Ây [−(λ+G)Âx − (λ−G)B̂x] + B̂y [(λ−G)Âx + (λ+G)B̂x] }
//! ```
//!
//! A product is one pass over the mesh, plane by plane: the x-sums of a line, then the y-sums of three
//! lines, then what a plane adds to itself and to both neighbours. About 110 operations a node, against 486
//! of the assembled rows. Vectors run along x and lanes; nothing is added up along them, and every number
//! goes through the same operations in the same order (plain multiply and add, never fused) whatever the
//! vector width and the lane count.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use crate::solver::field::{Block, Field, WIDTH, blocks_per_line};
use crate::solver::material::Material;
use crate::solver::mesh::BlockMesh;
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// K of a block of equal elements.
#[derive(Debug, Clone)]
pub struct TensorOperator {
    nodes: [usize; 3],
    /// Of K_cc: [Sx My Mz, Mx Sy Mz, Mx My Sz] for each component c.
    own: [[f64; 3]; 3],
    /// −(λ+G) of the coupling xy, xz, yz, with the third direction's scale.
    skew: [f64; 3],
    /// (λ−G) of the same.
    edge: [f64; 3],
    /// (λ−G)/(λ+G): a centre term B̂[…] is this share of the neighbour term Â[…], but for …
    share: f64,
    /// … 4λG/(λ+G) B̂B̂ where two faces meet, of the same.
    corner: [f64; 3],
}

/// Where a block is.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    /// Plane of nodes, from the contact face upwards.
    pub plane: usize,
    /// Line of nodes, y faster than z.
    pub line: usize,
    /// Block along the line.
    pub along: usize,
    /// Index of the block in its field.
    pub at: usize,
}

/// What goes into a product and what becomes of it, block by block.
pub trait Pass<S: Simd> {
    /// The three components of x in block `at`.
    fn input(&self, simd: S, at: usize) -> [f64x8<S>; 3];
    /// Takes the three components of K x in a block. Inputs of its plane and of those below are not read again.
    fn output(&mut self, simd: S, spot: Spot, kx: [f64x8<S>; 3]);
}

/// Scratch lines and planes of a pass.
#[derive(Debug, Clone)]
pub struct Scratch<const L: usize> {
    /// One line of each component with a zero node on either side.
    line: [Vec<f64>; 3],
    /// x-sums of three consecutive lines and a line of zeros.
    sums: [Vec<LineSums>; 4],
    /// What the plane before has so far, and what it adds to this one.
    plane: Vec<PlaneSums>,
    /// Factors of the centre along x: of Ŝ (half of M̂'s), and B̂.
    ends: Vec<Ends>,
}

/// x-sums of a block: M̂, Ŝ, Â-type and B̂ of each component.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct LineSums {
    m: [[f64; WIDTH]; 3],
    s: [[f64; WIDTH]; 3],
    a: [[f64; WIDTH]; 3],
    b: [[f64; WIDTH]; 3],
}

#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct PlaneSums {
    before: [[f64; WIDTH]; 3],
    ahead: [[f64; WIDTH]; 3],
}

#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct Ends {
    centre: [f64; WIDTH],
    outward: [f64; WIDTH],
}

impl<const L: usize> Scratch<L> {
    /// Scratch for products on `mesh`.
    pub fn new(mesh: &BlockMesh) -> Self {
        let [mx, my, _] = mesh.nodes_per_axis();
        let blocks = blocks_per_line::<L>(mx);
        let mut ends = vec![Ends::default(); blocks];
        for along in 0..mx * L {
            let (block, slot, node) = (along / WIDTH, along % WIDTH, along / L);
            ends[block].centre[slot] = if node == 0 || node + 1 == mx { 1.0 } else { 2.0 };
            ends[block].outward[slot] = outward(node, mx);
        }
        Self {
            line: std::array::from_fn(|_| vec![0.0; WIDTH * blocks + 2 * L]),
            sums: std::array::from_fn(|_| vec![LineSums::default(); blocks]),
            plane: vec![PlaneSums::default(); blocks * my],
            ends,
        }
    }
}

/// B̂: −1 at the low end, 1 at the high end.
fn outward(index: usize, nodes: usize) -> f64 {
    if index == 0 {
        -1.0
    } else if index + 1 == nodes {
        1.0
    } else {
        0.0
    }
}

/// The line of zeros in [`Scratch::sums`].
const ZEROS: usize = 3;

impl TensorOperator {
    /// K of `mesh` for a material.
    pub fn new(mesh: &BlockMesh, material: &Material) -> Self {
        let [hx, hy, hz] = mesh.element_size_m();
        let (lambda, g) = (material.lame_lambda_pa(), material.shear_modulus_pa());
        let directions = [hy * hz / (36.0 * hx), hx * hz / (36.0 * hy), hx * hy / (36.0 * hz)];
        let across = [hz / 24.0, hy / 24.0, hx / 24.0];
        Self {
            nodes: mesh.nodes_per_axis(),
            own: std::array::from_fn(|c| {
                std::array::from_fn(|d| directions[d] * if c == d { lambda + 2.0 * g } else { g })
            }),
            skew: across.map(|scale| -(lambda + g) * scale),
            edge: across.map(|scale| (lambda - g) * scale),
            share: (lambda - g) / (lambda + g),
            corner: across.map(|scale| 4.0 * lambda * g / (lambda + g) * scale),
        }
    }

    /// Computes `y = K x` for `L` lanes.
    pub fn product<const L: usize>(&self, x: &Field<L>, y: &mut Field<L>, scratch: &mut Scratch<L>) {
        let mut product = Product { x: x.blocks(), y: y.blocks_mut() };
        dispatch!(Level::new(), simd => self.pass(simd, &mut product, scratch));
    }

    /// One pass over the mesh.
    #[inline(always)]
    pub fn pass<S: Simd, const L: usize>(&self, simd: S, pass: &mut impl Pass<S>, scratch: &mut Scratch<L>) {
        let [_, my, mz] = self.nodes;
        for k in 0..mz {
            for j in 0..my {
                self.sum_along_x(simd, pass, [j, k], scratch);
                if j > 0 {
                    self.sum_across(simd, pass, [j - 1, k], scratch);
                }
            }
            self.sum_across(simd, pass, [my - 1, k], scratch);
        }
        let blocks = scratch.ends.len();
        for (i, plane) in scratch.plane.iter().enumerate() {
            let line = my * (mz - 1) + i / blocks;
            let spot = Spot { plane: mz - 1, line, along: i % blocks, at: line * blocks + i % blocks };
            pass.output(simd, spot, load_all(simd, &plane.before));
        }
    }

    /// M̂x, Ŝx, Âx and, where it is needed, B̂x of line `j` of plane `k`.
    #[inline(always)]
    fn sum_along_x<S: Simd, const L: usize>(
        &self,
        simd: S,
        pass: &impl Pass<S>,
        [j, k]: [usize; 2],
        scratch: &mut Scratch<L>,
    ) {
        let [_, my, mz] = self.nodes;
        let Scratch { line, sums, ends, .. } = scratch;
        let blocks = ends.len();
        let numbers = WIDTH * blocks;
        let first = (j + my * k) * blocks;
        for b in 0..blocks {
            let x = pass.input(simd, first + b);
            for c in 0..3 {
                x[c].store_slice(&mut line[c][L + WIDTH * b..L + WIDTH * (b + 1)]);
            }
        }
        let on_face = outward(j, my) != 0.0 || outward(k, mz) != 0.0;
        let sums = &mut sums[j % 3][..blocks];
        let skew = [self.skew[0], self.skew[0], self.skew[1]];
        let edge = [self.edge[0], -self.edge[0], -self.edge[1]];
        for c in 0..3 {
            let (skew, edge) = (f64x8::splat(simd, skew[c]), f64x8::splat(simd, edge[c]));
            let low = line[c][..numbers].as_chunks::<WIDTH>().0;
            let here = line[c][L..L + numbers].as_chunks::<WIDTH>().0;
            let high = line[c][2 * L..2 * L + numbers].as_chunks::<WIDTH>().0;
            for ((((low, here), high), ends), sums) in
                low.iter().zip(here).zip(high).zip(ends.iter()).zip(sums.iter_mut())
            {
                let (low, here, high) = (load(simd, low), load(simd, here), load(simd, high));
                let both = low + high;
                let centre = load(simd, &ends.centre) * here;
                let b = load(simd, &ends.outward) * here;
                ((centre + centre) + both).store_slice(&mut sums.m[c]);
                (centre - both).store_slice(&mut sums.s[c]);
                (skew * (low - high) + edge * b).store_slice(&mut sums.a[c]);
                if on_face {
                    b.store_slice(&mut sums.b[c]);
                }
            }
        }
    }

    /// The sums over y and z of line `j` of plane `k`; completes that line of plane `k` − 1.
    #[inline(always)]
    fn sum_across<S: Simd, const L: usize>(
        &self,
        simd: S,
        pass: &mut impl Pass<S>,
        [j, k]: [usize; 2],
        scratch: &mut Scratch<L>,
    ) {
        let [_, my, mz] = self.nodes;
        match (outward(j, my) != 0.0, outward(k, mz) != 0.0) {
            (false, false) => self.combine::<S, L, false, false>(simd, pass, [j, k], scratch),
            (true, false) => self.combine::<S, L, true, false>(simd, pass, [j, k], scratch),
            (false, true) => self.combine::<S, L, false, true>(simd, pass, [j, k], scratch),
            (true, true) => self.combine::<S, L, true, true>(simd, pass, [j, k], scratch),
        }
    }

    /// [`Self::sum_across`] for a line on a face in y (`Y`) or not, of a plane on a face in z (`Z`) or not.
    #[inline(always)]
    fn combine<S: Simd, const L: usize, const Y: bool, const Z: bool>(
        &self,
        simd: S,
        pass: &mut impl Pass<S>,
        [j, k]: [usize; 2],
        scratch: &mut Scratch<L>,
    ) {
        let [_, my, mz] = self.nodes;
        let Scratch { sums, plane, ends, .. } = scratch;
        let blocks = ends.len();
        let line_of =
            |present: bool, j: usize| if present { &sums[j % 3][..blocks] } else { &sums[ZEROS][..blocks] };
        let (low, here, high) = (line_of(j > 0, j + 2), line_of(true, j), line_of(j + 1 < my, j + 1));
        let plane = &mut plane[j * blocks..(j + 1) * blocks];
        let zero = f64x8::splat(simd, 0.0);
        let mut own = [[zero; 3]; 3];
        for c in 0..3 {
            for d in 0..3 {
                own[c][d] = f64x8::splat(simd, self.own[c][d]);
            }
        }
        let ratio = f64x8::splat(simd, self.skew[1] / self.skew[0]);
        let skew_yz = f64x8::splat(simd, self.skew[2]);
        let (centre_y, centre_z) =
            (f64x8::splat(simd, if Y { 1.0 } else { 2.0 }), f64x8::splat(simd, if Z { 1.0 } else { 2.0 }));
        let double_y = centre_y + centre_y;
        let (out_y, out_z) = (outward(j, my), outward(k, mz));
        for (along, (((low, here), high), plane)) in low.iter().zip(here).zip(high).zip(plane).enumerate() {
            let mut p = [zero; 3];
            let mut b = [zero; 3];
            for c in 0..3 {
                let centre = centre_y * load(simd, &here.m[c]);
                let both = load(simd, &low.m[c]) + load(simd, &high.m[c]);
                let sy_m = centre - both;
                let my_m = (centre + centre) + both;
                let my_s =
                    double_y * load(simd, &here.s[c]) + (load(simd, &low.s[c]) + load(simd, &high.s[c]));
                p[c] = own[c][0] * my_s + own[c][1] * sy_m;
                b[c] = own[c][2] * my_m;
            }
            p[0] += load(simd, &low.a[1]) - load(simd, &high.a[1]);
            p[1] += load(simd, &low.a[0]) - load(simd, &high.a[0]);
            let from_x = ratio * spread(simd, double_y, &low.a[0], &here.a[0], &high.a[0]);
            let mut from_y = skew_yz * (load(simd, &low.m[1]) - load(simd, &high.m[1]));
            let mut e = [
                spread(simd, double_y, &low.a[2], &here.a[2], &high.a[2]),
                skew_yz * (load(simd, &low.m[2]) - load(simd, &high.m[2])),
                zero,
            ];
            if Y {
                let (share, corner) =
                    (f64x8::splat(simd, out_y * self.share), f64x8::splat(simd, out_y * self.corner[0]));
                p[0] += corner * load(simd, &here.b[1]) - share * load(simd, &here.a[1]);
                p[1] += corner * load(simd, &here.b[0]) + share * load(simd, &here.a[0]);
                let edge = f64x8::splat(simd, out_y * self.edge[2]);
                from_y += edge * load(simd, &here.m[1]);
                e[1] -= edge * load(simd, &here.m[2]);
            }
            e[2] = from_x + from_y;
            let mut centre = [zero; 3];
            for c in 0..3 {
                let twice = centre_z * p[c];
                centre[c] = (twice + twice) + centre_z * b[c];
            }
            if Z {
                let (share, corner) =
                    (f64x8::splat(simd, out_z * self.share), f64x8::splat(simd, out_z * self.corner[1]));
                centre[0] +=
                    corner * spread(simd, double_y, &low.b[2], &here.b[2], &high.b[2]) - share * e[0];
                centre[1] -= share * e[1];
                centre[2] +=
                    corner * spread(simd, double_y, &low.b[0], &here.b[0], &high.b[0]) + share * e[2];
                if Y {
                    let corner = f64x8::splat(simd, out_z * out_y * self.corner[2]);
                    centre[1] += corner * load(simd, &here.m[2]);
                    centre[2] += corner * load(simd, &here.m[1]);
                }
            }
            let mut below = [zero; 3];
            for c in 0..3 {
                let level = p[c] - b[c];
                if k > 0 {
                    below[c] = load(simd, &plane.before[c]) + (level - e[c]);
                    centre[c] += load(simd, &plane.ahead[c]);
                }
                centre[c].store_slice(&mut plane.before[c]);
                (level + e[c]).store_slice(&mut plane.ahead[c]);
            }
            if k > 0 {
                let line = j + my * (k - 1);
                pass.output(simd, Spot { plane: k - 1, line, along, at: line * blocks + along }, below);
            }
        }
    }
}

/// A row of numbers as a vector.
#[inline(always)]
fn load<S: Simd>(simd: S, row: &[f64; WIDTH]) -> f64x8<S> {
    f64x8::from_slice(simd, row)
}

/// Three rows as vectors. (`map` on arrays is a call, which vectors do not survive.)
#[inline(always)]
pub fn load_all<S: Simd>(simd: S, rows: &[[f64; WIDTH]; 3]) -> [f64x8<S>; 3] {
    [load(simd, &rows[0]), load(simd, &rows[1]), load(simd, &rows[2])]
}

/// centre·here + (low + high).
#[inline(always)]
fn spread<S: Simd>(
    simd: S,
    centre: f64x8<S>,
    low: &[f64; WIDTH],
    here: &[f64; WIDTH],
    high: &[f64; WIDTH],
) -> f64x8<S> {
    centre * load(simd, here) + (load(simd, low) + load(simd, high))
}

struct Product<'a> {
    x: &'a [Block],
    y: &'a mut [Block],
}

impl<S: Simd> Pass<S> for Product<'_> {
    #[inline(always)]
    fn input(&self, simd: S, at: usize) -> [f64x8<S>; 3] {
        load_all(simd, &self.x[at].0)
    }

    #[inline(always)]
    fn output(&mut self, _: S, spot: Spot, kx: [f64x8<S>; 3]) {
        for c in 0..3 {
            kx[c].store_slice(&mut self.y[spot.at].0[c]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::AssembledOperator;
    use super::*;
    use crate::solver::element::stiffness;

    /// A deterministic, structureless field.
    fn values(n: usize, seed: u64) -> Vec<f64> {
        let mut s = seed;
        (0..n)
            .map(|_| {
                s = s.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (s >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
            })
            .collect()
    }

    fn product<const L: usize>(mesh: &BlockMesh, material: &Material, x: &[f64]) -> Field<L> {
        let mut y = Field::zeros(mesh);
        let x = Field::from_values(mesh, x);
        TensorOperator::new(mesh, material).product(&x, &mut y, &mut Scratch::new(mesh));
        y
    }

    /// Protects: the tensor form is the assembled K on every kind of node, down to one-element meshes,
    /// for every sign of λ − G.
    #[test]
    fn equals_element_by_element_assembly() {
        for poisson_ratio in [0.3, 0.0, 0.25, 0.45, -0.4] {
            let material = Material { young_modulus_pa: 1e9, poisson_ratio, density_kg_m3: 2500.0 };
            for elements in [[1, 1, 1], [1, 2, 3], [3, 1, 2], [2, 3, 1], [4, 3, 3], [8, 2, 5], [17, 3, 2]] {
                let mesh = BlockMesh::new([0.012, 0.015, 0.010], elements);
                let ke = stiffness(&material, mesh.element_size_m());
                let n = 3 * mesh.node_count();
                let x = values(n, 1);
                let mut reference = Field::<1>::zeros(&mesh);
                AssembledOperator::of_block(&mesh, &ke)
                    .product(&Field::from_values(&mesh, &x), &mut reference);
                let y = product::<1>(&mesh, &material, &x);
                // At most 8·24 terms of size |ke|·½ in the one form, 110 sums of such in the other.
                let bound = 400.0 * f64::EPSILON * ke.amax();
                for (i, b) in reference.values().enumerate() {
                    assert!(
                        (y[i] - b).abs() < bound,
                        "{elements:?} ν {poisson_ratio}: {i}: {} instead of {b}",
                        y[i]
                    );
                }
            }
        }
    }

    /// Protects: the same bits on every vector width that this machine has.
    #[test]
    fn vector_widths_agree_to_the_last_bit() {
        let material = Material { young_modulus_pa: 1e9, poisson_ratio: 0.3, density_kg_m3: 2500.0 };
        let mesh = BlockMesh::new([0.012, 0.015, 0.010], [9, 4, 3]);
        let operator = TensorOperator::new(&mesh, &material);
        let x = Field::<1>::from_values(&mesh, &values(3 * mesh.node_count(), 5));
        let at = |level: Level| {
            let mut y = Field::<1>::zeros(&mesh);
            let mut product = Product { x: x.blocks(), y: y.blocks_mut() };
            let mut scratch = Scratch::<1>::new(&mesh);
            dispatch!(level, simd => operator.pass(simd, &mut product, &mut scratch));
            y.values().map(f64::to_bits).collect::<Vec<_>>()
        };
        let best = at(Level::new());
        assert_eq!(at(Level::baseline()), best, "{:?} against {:?}", Level::baseline(), Level::new());
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        if let Some(avx2) = Level::new().as_avx2() {
            assert_eq!(at(avx2.level()), best, "AVX2 against {:?}", Level::new());
        }
    }

    /// Protects: a lane's bits do not depend on the lane count or on its companions.
    #[test]
    fn lanes_do_not_see_each_other() {
        fn compare<const L: usize>(mesh: &BlockMesh, material: &Material) {
            let n = 3 * mesh.node_count();
            let mut x = vec![0.0; L * n];
            for lane in 0..L {
                for (i, v) in values(n, lane as u64).into_iter().enumerate() {
                    x[L * i + lane] = v;
                }
            }
            let together = product::<L>(mesh, material, &x);
            for lane in 0..L {
                let alone = product::<1>(mesh, material, &values(n, lane as u64));
                assert!(
                    (0..n).all(|i| alone[i].to_bits() == together[L * i + lane].to_bits()),
                    "{lane} of {L}"
                );
            }
        }
        let material = Material { young_modulus_pa: 1e9, poisson_ratio: 0.3, density_kg_m3: 2500.0 };
        for elements in [[4, 5, 3], [12, 3, 2]] {
            let mesh = BlockMesh::new([0.012, 0.015, 0.010], elements);
            compare::<2>(&mesh, &material);
            compare::<4>(&mesh, &material);
            compare::<8>(&mesh, &material);
        }
    }
}

//! Moves the nodes: u_{n+1} and p_{n+1} from the internal forces at t_n.
//!
//! ```text
//! a_n = −K (u_n + β_R p_n)/m       u_{n+1} = u_n + Δt p_n + c Δt² a_n       p_{n+1} = p_n + d Δt a_n
//! ```
//!
//! Planes without constraints are moved as soon as the product with K has passed them, so that a step reads
//! and writes their fields once. Of the others the product is kept; they are moved when loads, supports and
//! ties have had their say.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::field::{Block, Field, WIDTH, blocks_per_line};
use super::model::Model;
use super::operator::{Pass, Scratch, Spot, TensorOperator, load_all};
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// What a step multiplies forces and velocities with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Factors {
    pub time_step_s: f64,
    pub beta_r_s: f64,
    /// Of a in `u_{n+1}` [s²].
    pub u_scale: f64,
    /// Of a in `p_{n+1}` [s].
    pub p_scale: f64,
}

/// What is fixed during a run.
#[derive(Debug, Clone)]
pub(super) struct Integration<const L: usize> {
    /// 1/m along a line, for lines inside, on a face in y, on a face in z and on both; 0 in the padding.
    inverse_mass: Vec<[f64; WIDTH]>,
    /// Where in it a line starts.
    line_starts: Vec<usize>,
    /// 1/m of every degree of freedom, 0 where it is fixed; used on the constrained planes.
    constrained_inverse_mass: Field<L>,
    constrained_planes: Vec<bool>,
    blocks_per_plane: usize,
}

impl<const L: usize> Integration<L> {
    pub fn new(model: &Model) -> Self {
        let mesh = model.mesh();
        let [mx, my, mz] = mesh.nodes_per_axis();
        let blocks = blocks_per_line::<L>(mx);
        // Lines of a kind have the same masses; (1, 1) is inside unless the block is one element thick.
        let kinds = [[1, 1], [0, 1], [1, 0], [0, 0]];
        let mut inverse_mass = vec![[0.0; WIDTH]; kinds.len() * blocks];
        for (kind, [j, k]) in kinds.into_iter().enumerate() {
            for along in 0..mx * L {
                let node = mesh.node(along / L, j, k);
                inverse_mass[kind * blocks + along / WIDTH][along % WIDTH] = 1.0 / model.masses_kg()[node];
            }
        }
        let on_face = |index: usize, nodes: usize| usize::from(index == 0 || index + 1 == nodes);
        let line_starts = (0..mz)
            .flat_map(|k| (0..my).map(move |j| (on_face(j, my) + 2 * on_face(k, mz)) * blocks))
            .collect();
        let mut constrained_inverse_mass = Field::<L>::zeros(mesh);
        for (dof, value) in model.inverse_mass().iter().enumerate() {
            let place = constrained_inverse_mass.place(dof / 3);
            *constrained_inverse_mass.at_mut(place, dof % 3) = [*value; L];
        }
        Self {
            inverse_mass,
            line_starts,
            constrained_inverse_mass,
            constrained_planes: model.constrained_planes().to_vec(),
            blocks_per_plane: blocks * my,
        }
    }

    /// The product with K; moves the planes without constraints, keeps the product on the others.
    pub fn advance_free_planes(
        &self,
        operator: &TensorOperator,
        factors: Factors,
        u: &mut Field<L>,
        p: &mut Field<L>,
        residual: &mut Field<L>,
        scratch: &mut Scratch<L>,
    ) {
        let mut advance = Advance {
            integration: self,
            factors,
            u: u.blocks_mut(),
            p: p.blocks_mut(),
            residual: residual.blocks_mut(),
        };
        dispatch!(Level::new(), simd => operator.pass(simd, &mut advance, scratch));
    }

    /// Moves the constrained planes by their residual, as if nothing were tied.
    pub fn advance_constrained_planes(
        &self,
        factors: Factors,
        u: &mut Field<L>,
        p: &mut Field<L>,
        residual: &Field<L>,
    ) {
        dispatch!(Level::new(), simd => self.advance_constrained(simd, factors, u, p, residual));
    }

    #[inline(always)]
    fn advance_constrained<S: Simd>(
        &self,
        simd: S,
        factors: Factors,
        u: &mut Field<L>,
        p: &mut Field<L>,
        residual: &Field<L>,
    ) {
        for (plane, _) in self.constrained_planes.iter().enumerate().filter(|(_, constrained)| **constrained)
        {
            let range = plane * self.blocks_per_plane..(plane + 1) * self.blocks_per_plane;
            let inverse = &self.constrained_inverse_mass.blocks()[range.clone()];
            let residual = &residual.blocks()[range.clone()];
            let moved = u.blocks_mut()[range.clone()].iter_mut().zip(&mut p.blocks_mut()[range]);
            for (((u, p), residual), inverse) in moved.zip(residual).zip(inverse) {
                for c in 0..3 {
                    let force = f64x8::from_slice(simd, &residual.0[c]);
                    advance(simd, factors, force, &inverse.0[c], &mut u.0[c], &mut p.0[c]);
                }
            }
        }
    }
}

/// u += Δt p + cΔt² a and p += dΔt a, a = −force/m.
#[inline(always)]
fn advance<S: Simd>(
    simd: S,
    factors: Factors,
    force: f64x8<S>,
    inverse_mass: &[f64; WIDTH],
    u: &mut [f64; WIDTH],
    p: &mut [f64; WIDTH],
) {
    let a = force * f64x8::from_slice(simd, inverse_mass);
    let before = f64x8::from_slice(simd, p);
    let moved = before * f64x8::splat(simd, factors.time_step_s) - a * f64x8::splat(simd, factors.u_scale);
    (f64x8::from_slice(simd, u) + moved).store_slice(u);
    (before - a * f64x8::splat(simd, factors.p_scale)).store_slice(p);
}

struct Advance<'a, const L: usize> {
    integration: &'a Integration<L>,
    factors: Factors,
    u: &'a mut [Block],
    p: &'a mut [Block],
    residual: &'a mut [Block],
}

impl<S: Simd, const L: usize> Pass<S> for Advance<'_, L> {
    #[inline(always)]
    fn input(&self, simd: S, at: usize) -> [f64x8<S>; 3] {
        let mut strained = load_all(simd, &self.u[at].0);
        if self.factors.beta_r_s != 0.0 {
            let beta_r = f64x8::splat(simd, self.factors.beta_r_s);
            let p = load_all(simd, &self.p[at].0);
            for c in 0..3 {
                strained[c] += beta_r * p[c];
            }
        }
        strained
    }

    #[inline(always)]
    fn output(&mut self, simd: S, spot: Spot, kx: [f64x8<S>; 3]) {
        if self.integration.constrained_planes[spot.plane] {
            for c in 0..3 {
                kx[c].store_slice(&mut self.residual[spot.at].0[c]);
            }
            return;
        }
        let inverse_mass =
            &self.integration.inverse_mass[self.integration.line_starts[spot.line] + spot.along];
        let (u, p) = (&mut self.u[spot.at].0, &mut self.p[spot.at].0);
        for c in 0..3 {
            advance(simd, self.factors, kx[c], inverse_mass, &mut u[c], &mut p[c]);
        }
    }
}

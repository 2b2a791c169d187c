//! Moves the nodes: u_{n+1} and p_{n+1} from the internal forces at t_n.
//!
//! ```text
//! a_n = −K (u_n + β_R p_n)/m       u_{n+1} = u_n + Δt p_n + c Δt² a_n       p_{n+1} = p_n + d Δt a_n
//! ```
//!
//! Planes without constraints are moved as soon as the product with K has passed them, so that a step reads
//! and writes their fields once. Of the others the product is kept; they are moved when loads, supports and
//! ties have had their say ([`supports`](super::supports)), the contact face by the contact solve.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::field::{Block, Field, WIDTH};
use super::line_table::LineTable;
use super::model::Model;
use super::operator::{Pass, Scratch, Spot, TensorOperator, load_all};
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// What a step multiplies forces and velocities with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Factors {
    pub time_step_s: f64,
    pub beta_r_s: f64,
    /// Of a in `u_{n+1}` [s²], slot by slot: a lane may be at its first step.
    pub u_scale: [f64; WIDTH],
    /// Of a in `p_{n+1}` [s].
    pub p_scale: [f64; WIDTH],
}

/// What is fixed during a run.
#[derive(Debug, Clone)]
pub(super) struct Integration<const L: usize> {
    inverse_mass: LineTable<L>,
    /// 1/m of every degree of freedom of a constrained plane, 0 where it is fixed, 1 where it is tied: of a tied
    /// one the residual is replaced by the group's acceleration.
    constrained_inverse_mass: Vec<Vec<Block>>,
    constrained_planes: Vec<bool>,
    blocks_per_plane: usize,
}

impl<const L: usize> Integration<L> {
    pub fn new(model: &Model) -> Self {
        let mesh = model.mesh();
        let mut per_dof = Field::<L>::zeros(mesh);
        let place = |dof: usize, value: f64, field: &mut Field<L>| {
            *field.at_mut(field.place(dof / 3), dof % 3) = [value; L];
        };
        for (dof, value) in model.inverse_mass().iter().enumerate() {
            place(dof, *value, &mut per_dof);
        }
        for &dof in model.ties().iter().flat_map(|tie| &tie.dofs) {
            place(dof, 1.0, &mut per_dof);
        }
        let blocks_per_plane = per_dof.blocks_per_line() * mesh.nodes_per_axis()[1];
        let planes = per_dof.blocks().chunks_exact(blocks_per_plane).zip(model.constrained_planes());
        Self {
            inverse_mass: LineTable::new(mesh, |node| 1.0 / model.masses_kg()[node]),
            constrained_inverse_mass: planes
                .map(|(plane, constrained)| if *constrained { plane.to_vec() } else { Vec::new() })
                .collect(),
            constrained_planes: model.constrained_planes().to_vec(),
            blocks_per_plane,
        }
    }

    /// 1/m of every degree of freedom of the contact face, 0 where it is fixed.
    pub fn face_inverse_mass(&self) -> &[Block] {
        &self.constrained_inverse_mass[0]
    }

    /// The product with K; moves the planes without constraints, keeps the product on the others.
    pub fn advance_free_planes(
        &self,
        operator: &TensorOperator,
        factors: &Factors,
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

    /// Moves the constrained planes above the contact face by their residual.
    pub fn advance_constrained_planes(
        &self,
        factors: &Factors,
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
        factors: &Factors,
        u: &mut Field<L>,
        p: &mut Field<L>,
        residual: &Field<L>,
    ) {
        for (plane, inverse) in self.constrained_inverse_mass.iter().enumerate().skip(1) {
            if inverse.is_empty() {
                continue;
            }
            let range = plane * self.blocks_per_plane..(plane + 1) * self.blocks_per_plane;
            let residual = &residual.blocks()[range.clone()];
            let moved = u.blocks_mut()[range.clone()].iter_mut().zip(&mut p.blocks_mut()[range]);
            for (((u, p), residual), inverse) in moved.zip(residual).zip(inverse) {
                for c in 0..3 {
                    let force = f64x8::from_slice(simd, &residual.0[c]);
                    let [next_u, next_p] = factors.moved(simd, force, &inverse.0[c], &u.0[c], &p.0[c]);
                    next_u.store_slice(&mut u.0[c]);
                    next_p.store_slice(&mut p.0[c]);
                }
            }
        }
    }
}

impl Factors {
    /// u + Δt p + cΔt² a and p + dΔt a, a = −force/m.
    #[inline(always)]
    pub fn moved<S: Simd>(
        &self,
        simd: S,
        force: f64x8<S>,
        inverse_mass: &[f64; WIDTH],
        u: &[f64; WIDTH],
        p: &[f64; WIDTH],
    ) -> [f64x8<S>; 2] {
        let a = force * f64x8::from_slice(simd, inverse_mass);
        let before = f64x8::from_slice(simd, p);
        let stroke =
            before * f64x8::splat(simd, self.time_step_s) - a * f64x8::from_slice(simd, &self.u_scale);
        [f64x8::from_slice(simd, u) + stroke, before - a * f64x8::from_slice(simd, &self.p_scale)]
    }
}

struct Advance<'a, const L: usize> {
    integration: &'a Integration<L>,
    factors: &'a Factors,
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
        let inverse_mass = self.integration.inverse_mass.row(spot.line, spot.along);
        let (u, p) = (&mut self.u[spot.at].0, &mut self.p[spot.at].0);
        for c in 0..3 {
            let [next_u, next_p] = self.factors.moved(simd, kx[c], inverse_mass, &u[c], &p[c]);
            next_u.store_slice(&mut u[c]);
            next_p.store_slice(&mut p[c]);
        }
    }
}

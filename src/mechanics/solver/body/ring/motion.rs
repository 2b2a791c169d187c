//! The state of an elastic disk, and how it is moved.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::body::RingBody;
use super::operator::RingScratch;
use super::response::column_at;
use super::stages::Stage;
use crate::solver::field::{Field, Row, WIDTH};
use crate::solver::lane::LaneState;
use crate::solver::scheme::StepFactors;
use crate::solver::simd::dispatch;
use fearless_simd::{Simd, f64x8, prelude::*};

/// The disk's state in every lane, in the frame that rotates with it. Vectors are radial, tangential, axial.
#[derive(Debug, Clone)]
pub struct RingState<const L: usize> {
    /// Displacements `u_n` \[m\].
    pub u: Field<L>,
    /// `p_n = v_{n−1} + ½Δt a_{n−1}` \[m/s\].
    pub p: Field<L>,
    /// B⁻¹p \[m/s\]; the momentum is M B⁻¹ p. `None` with one stage, where it equals p.
    pub unfiltered: Option<Field<L>>,
    pub(in crate::solver) workspace: RingWorkspace<L>,
}

/// Scratch memory. Nothing in it is carried from step to step.
#[derive(Debug, Clone)]
pub(in crate::solver) struct RingWorkspace<const L: usize> {
    /// 1/m \[1/kg\] of each block's nodes, 0 where a node is held and in the padding.
    inverse_mass: Vec<Row>,
    strained: Field<L>,
    moved: Field<L>,
    moved_before: Field<L>,
    stage: Field<L>,
    product: Field<L>,
    pub scratch: RingScratch<L>,
}

impl<const L: usize> RingState<L> {
    /// All lanes at rest.
    pub fn at_rest(body: &RingBody) -> Self {
        let field = || Field::zeros(body.mesh().layout());
        Self {
            u: field(),
            p: field(),
            unfiltered: (body.stages().count() > 1).then(field),
            workspace: RingWorkspace {
                inverse_mass: rows_of(body.inverse_mass(), &field()),
                strained: field(),
                moved: field(),
                moved_before: field(),
                stage: field(),
                product: field(),
                scratch: RingScratch::new(body.operator()),
            },
        }
    }

    /// B⁻¹p \[m/s\].
    pub fn momentum_velocity(&self) -> &Field<L> {
        self.unfiltered.as_ref().unwrap_or(&self.p)
    }

    /// Whether all numbers of a lane are finite.
    pub fn is_finite(&self, lane: usize) -> bool {
        [&self.u, &self.p].into_iter().all(|field| field.values().skip(lane).step_by(L).all(f64::is_finite))
    }

    /// Moves all lanes to t_{n+1} without contact.
    pub(in crate::solver) fn predict(&mut self, body: &RingBody, factors: &StepFactors) {
        let mut stages = body.stages().stages().iter();
        let work = &mut self.workspace;
        dispatch!(simd => strain(simd, factors.beta_r_s, &self.u, &self.p, &mut work.strained));
        body.operator().product(&work.strained, &mut work.product, &mut work.scratch);
        if let Some(first) = stages.next() {
            let unfiltered = self.unfiltered.as_mut();
            dispatch!(simd => work.first_stage(simd, first, factors, unfiltered));
        }
        for stage in stages {
            dispatch!(simd => work.add_moved(simd));
            body.operator().product(&work.stage, &mut work.product, &mut work.scratch);
            dispatch!(simd => work.next_stage(simd, stage));
        }
        dispatch!(simd => work.advance(simd, factors, &mut self.u, &mut self.p));
    }
}

/// A force on a node of the track.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct TrackForce {
    /// Index of the node in the mesh.
    pub node: usize,
    /// Its column in the mesh and in the track.
    pub column: usize,
    /// Its row in the track.
    pub row: usize,
    /// Force \[N\] in the node's own directions.
    pub force_n: [f64; 3],
}

impl<const L: usize> RingState<L> {
    /// Adds the motion of one lane due to a force on a node of the track, after the prediction. `u_scale` is cΔt²
    /// \[s²\], `p_scale` is dΔt \[s\].
    pub(in crate::solver) fn add_force(
        &mut self,
        body: &RingBody,
        lane: usize,
        source: &TrackForce,
        u_scale: f64,
        p_scale: f64,
    ) {
        let mesh = body.mesh();
        let [_, rows, planes] = mesh.nodes_per_axis();
        let reach = body.response().reach() as isize;
        let line = 2 * reach + 1;
        let row = (mesh.track().first_row + source.row) as isize;
        for (at, per_force) in body.response().of(source.column, source.row).iter().enumerate() {
            let at = at as isize;
            let (c, r, depth) = (at % line - reach, at / line % line - reach, (at / (line * line)) as usize);
            let Some(column) = column_at(mesh, source.column, c) else { continue };
            if !(0..rows as isize).contains(&(row + r)) || depth >= planes {
                continue;
            }
            let place = self.u.place(mesh.node(column, (row + r) as usize, depth));
            let increment = times(per_force, source.force_n);
            for c in 0..3 {
                self.u.at_mut(place, c)[lane] += u_scale * increment[c];
                self.p.at_mut(place, c)[lane] += p_scale * increment[c];
            }
        }
        if let Some(unfiltered) = &mut self.unfiltered {
            let place = unfiltered.place(source.node);
            let inverse_mass = body.inverse_mass()[source.node];
            for c in 0..3 {
                unfiltered.at_mut(place, c)[lane] += p_scale * (inverse_mass * source.force_n[c]);
            }
        }
    }
}

impl<const L: usize> LaneState for RingState<L> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        self.u.save_lane(lane, saved);
        self.p.save_lane(lane, saved);
        self.unfiltered.save_lane(lane, saved);
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        self.u.load_lane(lane, saved);
        self.p.load_lane(lane, saved);
        self.unfiltered.load_lane(lane, saved);
    }
}

/// A 3 × 3 matrix times a vector.
pub(in crate::solver) fn times(matrix: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| matrix[c][0] * x[0] + matrix[c][1] * x[1] + matrix[c][2] * x[2])
}

/// x = u + β_R p.
#[inline(always)]
fn strain<S: Simd, const L: usize>(
    simd: S,
    beta_r_s: f64,
    u: &Field<L>,
    p: &Field<L>,
    strained: &mut Field<L>,
) {
    let beta_r = f64x8::splat(simd, beta_r_s);
    for ((x, u), p) in strained.blocks_mut().iter_mut().zip(u.blocks()).zip(p.blocks()) {
        for c in 0..3 {
            let value = f64x8::from_slice(simd, &u.0[c]) + beta_r * f64x8::from_slice(simd, &p.0[c]);
            value.store_slice(&mut x.0[c]);
        }
    }
}

impl<const L: usize> RingWorkspace<L> {
    /// d = −σ A x, and the change −c′Δt A x of B⁻¹p in the step.
    #[inline(always)]
    fn first_stage<S: Simd>(
        &mut self,
        simd: S,
        stage: &Stage,
        factors: &StepFactors,
        mut unfiltered: Option<&mut Field<L>>,
    ) {
        let force_s2 = f64x8::splat(simd, stage.force_s2);
        let p_scale = f64x8::from_slice(simd, &factors.p_scale);
        for (at, inverse) in self.inverse_mass.iter().enumerate() {
            let inverse = f64x8::from_slice(simd, &inverse.0);
            for c in 0..3 {
                let a = f64x8::from_slice(simd, &self.product.blocks()[at].0[c]) * inverse;
                let moved = f64x8::splat(simd, 0.0) - force_s2 * a;
                moved.store_slice(&mut self.moved.blocks_mut()[at].0[c]);
                if let Some(field) = &mut unfiltered {
                    let row = &mut field.blocks_mut()[at].0[c];
                    (f64x8::from_slice(simd, row) - p_scale * a).store_slice(row);
                }
            }
        }
        for block in self.moved_before.blocks_mut() {
            block.0 = [[0.0; WIDTH]; 3];
        }
    }

    /// Computes the stage's displacements x + d.
    #[inline(always)]
    fn add_moved<S: Simd>(&mut self, simd: S) {
        let given = self.strained.blocks().iter().zip(self.moved.blocks());
        for (z, (x, d)) in self.stage.blocks_mut().iter_mut().zip(given) {
            for c in 0..3 {
                (f64x8::from_slice(simd, &x.0[c]) + f64x8::from_slice(simd, &d.0[c]))
                    .store_slice(&mut z.0[c]);
            }
        }
    }

    /// d ← α d − γ d_before − σ A (x + d).
    #[inline(always)]
    fn next_stage<S: Simd>(&mut self, simd: S, stage: &Stage) {
        let [own, before, force_s2] = [
            f64x8::splat(simd, stage.own),
            f64x8::splat(simd, stage.before),
            f64x8::splat(simd, stage.force_s2),
        ];
        for (at, inverse) in self.inverse_mass.iter().enumerate() {
            let inverse = f64x8::from_slice(simd, &inverse.0);
            for c in 0..3 {
                let a = f64x8::from_slice(simd, &self.product.blocks()[at].0[c]) * inverse;
                let last = &mut self.moved_before.blocks_mut()[at].0[c];
                let d = f64x8::from_slice(simd, &self.moved.blocks()[at].0[c]);
                (own * d - before * f64x8::from_slice(simd, last) - force_s2 * a).store_slice(last);
            }
        }
        std::mem::swap(&mut self.moved, &mut self.moved_before);
    }

    /// u ← u + Δt p + c Δt² a and p ← p + c′Δt a, with Δt² a = 2 d.
    #[inline(always)]
    fn advance<S: Simd>(&self, simd: S, factors: &StepFactors, u: &mut Field<L>, p: &mut Field<L>) {
        let dt = factors.time_step_s;
        let (per_step, dt) = (f64x8::splat(simd, 2.0 / (dt * dt)), f64x8::splat(simd, dt));
        let u_scale = f64x8::from_slice(simd, &factors.u_scale);
        let p_scale = f64x8::from_slice(simd, &factors.p_scale);
        for ((u, p), d) in u.blocks_mut().iter_mut().zip(p.blocks_mut()).zip(self.moved.blocks()) {
            for c in 0..3 {
                let a = f64x8::from_slice(simd, &d.0[c]) * per_step;
                let before = f64x8::from_slice(simd, &p.0[c]);
                (f64x8::from_slice(simd, &u.0[c]) + (before * dt + a * u_scale)).store_slice(&mut u.0[c]);
                (before + a * p_scale).store_slice(&mut p.0[c]);
            }
        }
    }
}

/// Nodal values in the blocks of a field, the same in all lanes.
pub(in crate::solver) fn rows_of<const L: usize>(values: &[f64], field: &Field<L>) -> Vec<Row> {
    let mut spread = field.clone();
    for (node, value) in values.iter().enumerate() {
        let place = spread.place(node);
        *spread.at_mut(place, 0) = [*value; L];
    }
    spread.blocks().iter().map(|block| Row(block.0[0])).collect()
}

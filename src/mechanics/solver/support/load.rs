//! The normal load.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::weights::{Weights, weights};
use crate::solver::body::pin::PinMesh;
use crate::solver::field::{Block, FieldOf, Layout, in_slots_of};
use crate::solver::number::Number;
use crate::solver::simd::{dispatch, load};
use fearless_simd::{Simd, prelude::*};

/// A nodal force per unit of the total load (dimensionless).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadShare {
    /// 3·node + component.
    pub dof: usize,
    /// Signed share of the total load.
    pub share: f64,
}

/// The shares of a total load of 1 in −z, distributed over the top face by tributary area.
pub fn normal_load(mesh: &PinMesh) -> Vec<LoadShare> {
    let area = mesh.top_area_m2();
    let shares = mesh.top_nodes().into_iter().zip(mesh.top_areas_m2());
    shares.map(|(node, node_area)| LoadShare { dof: 3 * node + 2, share: -node_area / area }).collect()
}

/// The distribution of the load in every lane.
#[derive(Debug, Clone)]
pub(in crate::solver) struct AppliedLoad<R: Number> {
    shares: Vec<Weights<R>>,
}

impl<R: Number> AppliedLoad<R> {
    /// For fields with `lanes` lanes.
    pub fn new(load: &[LoadShare], layout: Layout, lanes: usize) -> Self {
        let shares: Vec<_> = load.iter().map(|load| (load.dof, load.share)).collect();
        Self { shares: weights(layout, lanes, &shares) }
    }

    /// Subtracts the load \[N\] from the residual \[N\].
    pub fn act<const L: usize>(&self, load_n: &[f64; L], residual: &mut FieldOf<L, R>) {
        self.act_on(&in_slots_of::<R>(load_n), residual.blocks_mut());
    }

    fn act_on(&self, load_n: &R::Row, residual: &mut [Block<R>]) {
        dispatch!(simd => self.act_in(simd, load_n, residual));
    }

    #[inline(always)]
    fn act_in<S: Simd>(&self, simd: S, load_n: &R::Row, residual: &mut [Block<R>]) {
        let load_n = load::<R, S>(simd, load_n);
        for share in &self.shares {
            let first = share.plane * share.rows.len();
            for (block, per_load) in residual[first..].iter_mut().zip(&share.rows) {
                let row = &mut block.0[share.component];
                (load::<R, S>(simd, row) - load::<R, S>(simd, &per_load.0) * load_n).store_array(row);
            }
        }
    }

    /// Displacement \[m\] that is work-conjugate to the total load: Σ share·u.
    pub fn stroke_m<const L: usize>(&self, u: &FieldOf<L, R>) -> [f64; L] {
        let mut stroke = [0.0; L];
        for share in &self.shares {
            share.add_up(u.blocks(), &mut stroke);
        }
        stroke
    }
}

//! The normal load.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::weights::{Weights, weights};
use crate::solver::body::block::BlockMesh;
use crate::solver::field::{Field, in_slots};
use crate::solver::simd::dispatch;
use fearless_simd::{Simd, f64x8, prelude::*};

/// A nodal force per unit of the total load (dimensionless).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadShare {
    /// 3·node + component.
    pub dof: usize,
    /// Signed share of the total load.
    pub share: f64,
}

/// The shares of a total load of 1 in −z, distributed over the top face by tributary area.
pub fn normal_load(mesh: &BlockMesh) -> Vec<LoadShare> {
    let area = mesh.size_m()[0] * mesh.size_m()[1];
    mesh.top_nodes()
        .map(|node| LoadShare { dof: 3 * node + 2, share: -mesh.tributary_area_m2(node) / area })
        .collect()
}

/// The distribution of the load in every lane.
#[derive(Debug, Clone)]
pub(in crate::solver) struct AppliedLoad<const L: usize> {
    shares: Vec<Weights>,
}

impl<const L: usize> AppliedLoad<L> {
    pub fn new(load: &[LoadShare], mesh: &BlockMesh) -> Self {
        let shares: Vec<_> = load.iter().map(|load| (load.dof, load.share)).collect();
        Self { shares: weights::<L>(mesh, &shares) }
    }

    /// Subtracts the load \[N\] from the residual \[N\].
    pub fn act(&self, load_n: &[f64; L], residual: &mut Field<L>) {
        dispatch!(simd => self.act_in(simd, load_n, residual));
    }

    #[inline(always)]
    fn act_in<S: Simd>(&self, simd: S, load_n: &[f64; L], residual: &mut Field<L>) {
        let load_n = f64x8::from_slice(simd, &in_slots(load_n));
        for load in &self.shares {
            let first = load.plane * load.rows.len();
            for (block, share) in residual.blocks_mut()[first..].iter_mut().zip(&load.rows) {
                let row = &mut block.0[load.component];
                (f64x8::from_slice(simd, row) - f64x8::from_slice(simd, &share.0) * load_n).store_slice(row);
            }
        }
    }

    /// Displacement \[m\] that is work-conjugate to the total load: Σ share·u.
    pub fn stroke_m(&self, u: &Field<L>) -> [f64; L] {
        let mut stroke = [0.0; L];
        for load in &self.shares {
            dispatch!(simd => load.add_up(simd, u, &mut stroke));
        }
        stroke
    }
}

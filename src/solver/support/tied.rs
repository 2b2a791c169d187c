//! Nodes that share one displacement in one component.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::applied::{AppliedSupport, Supported};
use super::weights::{Weights, ones};
use crate::solver::body::block::BlockMesh;
use crate::solver::field::{Field, in_slots};
use crate::solver::simd::dispatch;
use fearless_simd::{Simd, f64x8, prelude::*};

/// Nodes that share one displacement in one component.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tied {
    /// The component: x = 0, y = 1, z = 2.
    pub component: usize,
    /// The nodes, at least one.
    pub nodes: Vec<usize>,
}

impl Tied {
    /// 3·node + component.
    pub fn dofs(&self) -> impl Iterator<Item = usize> + '_ {
        self.nodes.iter().map(|node| 3 * node + self.component)
    }
}

/// A tie in every lane.
#[derive(Debug, Clone)]
pub(super) struct AppliedTie<const L: usize> {
    members: Vec<Weights>,
    /// 1/(mass of the group) \[1/kg\].
    inverse_mass: f64,
}

impl<const L: usize> AppliedTie<L> {
    pub fn new(tied: &Tied, mesh: &BlockMesh, masses_kg: &[f64]) -> Self {
        Self {
            members: ones::<L>(mesh, &tied.dofs().collect::<Vec<_>>()),
            inverse_mass: 1.0 / tied.nodes.iter().map(|&node| masses_kg[node]).sum::<f64>(),
        }
    }

    /// Replaces the residual of every member by Σ residual/Σ mass, which is minus the acceleration of the group.
    /// Tied degrees of freedom have the inverse mass 1, so every member then moves with this acceleration.
    #[inline(always)]
    fn share<S: Simd>(&self, simd: S, residual: &mut Field<L>) {
        let mut sum = [0.0; L];
        for member in &self.members {
            member.add_up(simd, residual, &mut sum);
        }
        for total in &mut sum {
            *total *= self.inverse_mass;
        }
        let common = f64x8::from_slice(simd, &in_slots(&sum));
        for member in &self.members {
            let first = member.plane * member.rows.len();
            for (block, mask) in residual.blocks_mut()[first..].iter_mut().zip(&member.rows) {
                let row = &mut block.0[member.component];
                let tied = f64x8::from_slice(simd, &mask.0).simd_gt(f64x8::splat(simd, 0.0));
                tied.select(common, f64x8::from_slice(simd, row)).store_slice(row);
            }
        }
    }
}

impl<const L: usize> AppliedSupport<L> for AppliedTie<L> {
    fn act(&mut self, pin: &mut Supported<'_, L>, _reaction_n: &mut [[f64; L]; 3]) {
        dispatch!(simd => self.share(simd, pin.residual));
    }

    fn boxed(&self) -> Box<dyn AppliedSupport<L>> {
        Box::new(self.clone())
    }
}

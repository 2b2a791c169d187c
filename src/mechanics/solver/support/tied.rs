//! Nodes that share one displacement in one component.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::applied::{AppliedSupport, Supported};
use super::weights::{Weights, ones};
use crate::solver::field::{Block, Layout, in_slots_of};
use crate::solver::number::Number;
use crate::solver::simd::{dispatch, load, splat};
use fearless_simd::{Simd, prelude::*};

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
pub(super) struct AppliedTie<R: Number> {
    members: Vec<Weights<R>>,
    /// 1/(mass of the group) \[1/kg\].
    inverse_mass: f64,
}

impl<R: Number> AppliedTie<R> {
    /// For fields with `lanes` lanes. The group has a mass of `more_kg` besides that of its nodes.
    pub fn new(tied: &Tied, layout: Layout, lanes: usize, masses_kg: &[f64], more_kg: f64) -> Self {
        let nodes_kg: f64 = tied.nodes.iter().map(|&node| masses_kg[node]).sum();
        Self {
            members: ones(layout, lanes, &tied.dofs().collect::<Vec<_>>()),
            inverse_mass: 1.0 / (nodes_kg + more_kg),
        }
    }

    /// Replaces the residual of every member by Σ residual/Σ mass, which is minus the acceleration of the group.
    /// Tied degrees of freedom have the inverse mass 1, so every member then moves with this acceleration.
    ///
    /// `sums` are other forces \[N\] on the group at first, with the sign of a residual, and minus the acceleration at last.
    pub fn share(&self, residual: &mut [Block<R>], sums: &mut [f64]) {
        for member in &self.members {
            member.add_up(residual, sums);
        }
        for total in &mut *sums {
            *total *= self.inverse_mass;
        }
        let common = in_slots_of::<R>(sums);
        dispatch!(simd => self.set(simd, residual, &common));
    }

    #[inline(always)]
    fn set<S: Simd>(&self, simd: S, residual: &mut [Block<R>], common: &R::Row) {
        let common = load::<R, S>(simd, common);
        for member in &self.members {
            let first = member.plane * member.rows.len();
            for (block, mask) in residual[first..].iter_mut().zip(&member.rows) {
                let row = &mut block.0[member.component];
                let tied = load::<R, S>(simd, &mask.0).simd_gt(splat::<R, S>(simd, 0.0));
                tied.select(common, load::<R, S>(simd, row)).store_array(row);
            }
        }
    }
}

impl<const L: usize, R: Number> AppliedSupport<L, R> for AppliedTie<R> {
    fn act(&mut self, pin: &mut Supported<'_, L, R>, _reaction_n: &mut [[f64; L]; 3]) {
        self.share(pin.residual.blocks_mut(), &mut [0.0; L]);
    }

    fn boxed(&self) -> Box<dyn AppliedSupport<L, R>> {
        Box::new(self.clone())
    }
}

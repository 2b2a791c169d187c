//! Weights of the nodes of a plane, for sums and forces over these nodes.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use crate::solver::field::{Block, Layout, Row, add_slots, blocks_per_line};
use crate::solver::number::Number;
use crate::solver::simd::{dispatch, load, splat};
use fearless_simd::{Simd, prelude::*};

/// The weights of all nodes of one plane in one component, zero where nothing acts.
#[derive(Debug, Clone)]
pub(super) struct Weights<R: Number> {
    pub plane: usize,
    pub component: usize,
    pub rows: Vec<Row<R>>,
    /// Number of rows of a line.
    stride: usize,
}

impl<R: Number> Weights<R> {
    /// Adds Σ weight·field to the totals of the lanes.
    pub fn add_up(&self, field: &[Block<R>], totals: &mut [f64]) {
        dispatch!(simd => self.add_up_in(simd, field, totals));
    }

    #[inline(always)]
    fn add_up_in<S: Simd>(&self, simd: S, field: &[Block<R>], totals: &mut [f64]) {
        let blocks = &field[self.plane * self.rows.len()..(self.plane + 1) * self.rows.len()];
        for along in 0..self.stride {
            let column = blocks[along..]
                .iter()
                .step_by(self.stride)
                .zip(self.rows[along..].iter().step_by(self.stride));
            let mut sum = splat::<R, S>(simd, 0.0);
            for (block, weight) in column {
                sum += load::<R, S>(simd, &weight.0) * load::<R, S>(simd, &block.0[self.component]);
            }
            let row: &R::Row = sum.as_array();
            add_slots(totals, row.as_ref());
        }
    }
}

/// Sorts weighted degrees of freedom (3·node + component, weight) by plane and component, for fields with `lanes` lanes.
/// There is one entry for each plane and component with a weight. Planes are ordered from the contact face upwards.
pub(super) fn weights<R: Number>(layout: Layout, lanes: usize, dofs: &[(usize, f64)]) -> Vec<Weights<R>> {
    let Layout { nodes_per_line: mx, lines_per_plane: my, .. } = layout;
    let stride = blocks_per_line::<R>(mx, lanes);
    let mut found = Vec::new();
    for plane in 0..layout.planes() {
        for component in 0..3 {
            let mut rows = vec![Row::<R>::default(); stride * my];
            let mut any = false;
            for &(dof, weight) in dofs {
                let (node, line) = (dof / 3, dof / 3 / mx);
                if line / my == plane && dof % 3 == component {
                    let (line, along) = (line % my, node % mx * lanes);
                    let row = rows[line * stride + along / R::WIDTH].0.as_mut();
                    row[along % R::WIDTH..][..lanes].fill(R::from_f64(weight));
                    any = true;
                }
            }
            if any {
                found.push(Weights { plane, component, rows, stride });
            }
        }
    }
    found
}

/// The weight 1 on all these degrees of freedom.
pub(super) fn ones<R: Number>(layout: Layout, lanes: usize, dofs: &[usize]) -> Vec<Weights<R>> {
    weights(layout, lanes, &dofs.iter().map(|&dof| (dof, 1.0)).collect::<Vec<_>>())
}

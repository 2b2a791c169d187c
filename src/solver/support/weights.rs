//! Weights of the nodes of a plane, for sums and forces over these nodes.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use crate::solver::body::block::BlockMesh;
use crate::solver::field::{Field, Row, WIDTH, add_slots};
use fearless_simd::{Simd, f64x8, prelude::*};

/// The weights of all nodes of one plane in one component, zero where nothing acts.
#[derive(Debug, Clone)]
pub(super) struct Weights {
    pub plane: usize,
    pub component: usize,
    pub rows: Vec<Row>,
}

impl Weights {
    /// Adds Σ weight·field to the totals of the lanes.
    #[inline(always)]
    pub fn add_up<S: Simd, const L: usize>(&self, simd: S, field: &Field<L>, totals: &mut [f64; L]) {
        let stride = field.blocks_per_line();
        let blocks = &field.blocks()[self.plane * self.rows.len()..(self.plane + 1) * self.rows.len()];
        for along in 0..stride {
            let column =
                blocks[along..].iter().step_by(stride).zip(self.rows[along..].iter().step_by(stride));
            let mut sum = f64x8::splat(simd, 0.0);
            for (block, weight) in column {
                sum += f64x8::from_slice(simd, &weight.0) * f64x8::from_slice(simd, &block.0[self.component]);
            }
            let mut slots = [0.0; WIDTH];
            sum.store_slice(&mut slots);
            add_slots(totals, &slots);
        }
    }
}

/// Sorts weighted degrees of freedom (3·node + component, weight) by plane and component. There is one entry for
/// each plane and component with a weight. Planes are ordered from the contact face upwards.
pub(super) fn weights<const L: usize>(mesh: &BlockMesh, dofs: &[(usize, f64)]) -> Vec<Weights> {
    let [mx, my, mz] = mesh.nodes_per_axis();
    let mut found = Vec::new();
    for plane in 0..mz {
        for component in 0..3 {
            let mut field = Field::<L>::zeros(mesh.face_layout());
            let mut any = false;
            for &(dof, weight) in dofs {
                let node = dof / 3;
                if node / (mx * my) == plane && dof % 3 == component {
                    let place = field.place(node % (mx * my));
                    *field.at_mut(place, 0) = [weight; L];
                    any = true;
                }
            }
            if any {
                let rows = field.blocks().iter().map(|block| Row(block.0[0])).collect();
                found.push(Weights { plane, component, rows });
            }
        }
    }
    found
}

/// The weight 1 on all these degrees of freedom.
pub(super) fn ones<const L: usize>(mesh: &BlockMesh, dofs: &[usize]) -> Vec<Weights> {
    weights::<L>(mesh, &dofs.iter().map(|&dof| (dof, 1.0)).collect::<Vec<_>>())
}

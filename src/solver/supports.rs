//! Loads, supports and ties: what acts on the constrained planes besides internal forces and contact.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::field::{Field, Row, WIDTH, add_slots, in_slots};
use super::model::Model;
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// Where loads, supports and ties act.
#[derive(Debug, Clone)]
pub(super) struct Supports<const L: usize> {
    load: Vec<Weights>,
    fixed: Vec<Weights>,
    ties: Vec<Tied>,
}

/// A weight per node of one plane and component; zero where nothing acts.
#[derive(Debug, Clone)]
struct Weights {
    plane: usize,
    component: usize,
    rows: Vec<Row>,
}

#[derive(Debug, Clone)]
struct Tied {
    members: Vec<Weights>,
    inverse_mass: f64,
}

impl<const L: usize> Supports<L> {
    pub fn new(model: &Model) -> Self {
        let weights = |dofs: &[(usize, f64)]| weights::<L>(model, dofs);
        let ones = |dofs: &[usize]| weights(&dofs.iter().map(|&dof| (dof, 1.0)).collect::<Vec<_>>());
        Self {
            load: weights(&model.load().iter().map(|load| (load.dof, load.share)).collect::<Vec<_>>()),
            fixed: ones(model.fixed()),
            ties: model
                .ties()
                .iter()
                .map(|tie| Tied { members: ones(&tie.dofs), inverse_mass: tie.inverse_mass })
                .collect(),
        }
    }

    /// residual −= load, and of a tied degree of freedom the residual becomes minus the group's acceleration, as
    /// of a unit mass. Returns what the supports carry [N]: the residual of the fixed degrees of freedom.
    pub fn apply(&self, load_n: &[f64; L], residual: &mut Field<L>) -> [[f64; L]; 3] {
        dispatch!(Level::new(), simd => self.apply_in(simd, load_n, residual))
    }

    #[inline(always)]
    fn apply_in<S: Simd>(&self, simd: S, load_n: &[f64; L], residual: &mut Field<L>) -> [[f64; L]; 3] {
        let load_n = f64x8::from_slice(simd, &in_slots(load_n));
        for load in &self.load {
            let first = load.plane * load.rows.len();
            for (block, share) in residual.blocks_mut()[first..].iter_mut().zip(&load.rows) {
                let row = &mut block.0[load.component];
                (f64x8::from_slice(simd, row) - f64x8::from_slice(simd, &share.0) * load_n).store_slice(row);
            }
        }
        let mut reaction_n = [[0.0; L]; 3];
        for fixed in &self.fixed {
            fixed.add_up(simd, residual, &mut reaction_n[fixed.component]);
        }
        for tie in &self.ties {
            let mut sum = [0.0; L];
            for member in &tie.members {
                member.add_up(simd, residual, &mut sum);
            }
            for total in &mut sum {
                *total *= tie.inverse_mass;
            }
            let common = f64x8::from_slice(simd, &in_slots(&sum));
            for member in &tie.members {
                let first = member.plane * member.rows.len();
                for (block, mask) in residual.blocks_mut()[first..].iter_mut().zip(&member.rows) {
                    let row = &mut block.0[member.component];
                    let tied = f64x8::from_slice(simd, &mask.0).simd_gt(f64x8::splat(simd, 0.0));
                    tied.select(common, f64x8::from_slice(simd, row)).store_slice(row);
                }
            }
        }
        reaction_n
    }

    /// Displacement [m] on which a unit of the total load does work.
    pub fn load_stroke_m(&self, u: &Field<L>) -> [f64; L] {
        let mut stroke = [0.0; L];
        for load in &self.load {
            dispatch!(Level::new(), simd => load.add_up(simd, u, &mut stroke));
        }
        stroke
    }
}

impl Weights {
    /// Adds Σ weight·field to the totals.
    #[inline(always)]
    fn add_up<S: Simd, const L: usize>(&self, simd: S, field: &Field<L>, totals: &mut [f64; L]) {
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

/// One entry per plane and component that has a weight, planes from the contact face upwards.
fn weights<const L: usize>(model: &Model, dofs: &[(usize, f64)]) -> Vec<Weights> {
    let mesh = model.mesh();
    let [mx, my, mz] = mesh.nodes_per_axis();
    let mut found = Vec::new();
    for plane in 0..mz {
        for component in 0..3 {
            let mut field = Field::<L>::on_face(mesh);
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

//! Works of the contact forces of one step.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use crate::solver::contact::{Contacts, Status};
use crate::solver::field::{Block, Field, WIDTH, add_slots};
use crate::solver::model::Model;
use crate::solver::state::Drive;
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// The velocities of the target, with which its work is reckoned.
#[derive(Debug, Clone)]
pub(super) struct ContactWorks<const L: usize> {
    /// Velocity per unit of the drive's rate, x and y, of every slave node.
    motion: Field<L>,
}

/// What the forces of a step did over the increments after and before their time [J].
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_field_names, reason = "units are part of the names")]
pub(super) struct StepWorks<const L: usize> {
    pub drive_j: [f64; L],
    /// Work of the drive over the slopes of an elastic target.
    pub slope_after_j: [f64; L],
    pub slope_before_j: [f64; L],
    pub friction_after_j: [f64; L],
    pub friction_before_j: [f64; L],
    pub contact_loss_after_j: [f64; L],
    pub contact_loss_before_j: [f64; L],
}

impl<const L: usize> ContactWorks<L> {
    pub fn new(model: &Model) -> Self {
        let motion = model.on_slaves(|node| [node.surface_motion[0], node.surface_motion[1], 0.0]);
        Self { motion }
    }

    pub fn of_step(&self, model: &Model, drives: &[Drive; L], contacts: &Contacts<L>) -> StepWorks<L> {
        dispatch!(Level::new(), simd => self.of_step_in(simd, model, drives, contacts))
    }

    #[inline(always)]
    fn of_step_in<S: Simd>(
        &self,
        simd: S,
        model: &Model,
        drives: &[Drive; L],
        contacts: &Contacts<L>,
    ) -> StepWorks<L> {
        let stride = self.motion.blocks_per_line();
        let zero = f64x8::splat(simd, 0.0);
        let mut sums = [[0.0; L]; 5];
        for along in 0..stride {
            let mut totals = [zero; 5];
            for at in (along..self.motion.blocks().len()).step_by(stride) {
                let force = &contacts.force_n.blocks()[at];
                let now = work(simd, force, &contacts.increment_m.blocks()[at]);
                let before = work(simd, force, &contacts.previous_increment_m.blocks()[at]);
                let motion = &self.motion.blocks()[at];
                let slips = f64x8::from_slice(simd, &contacts.status.blocks()[at].0[Status::Slips as usize]);
                let slips = slips.simd_gt(zero);
                totals[0] += product(simd, force, motion, 0) + product(simd, force, motion, 1);
                // The tangential work of slipping nodes is friction; all else is lost in the contact.
                totals[1] -= slips.select(now[0], zero);
                totals[2] -= slips.select(before[0], zero);
                totals[3] -= slips.select(zero, now[0]) + now[1];
                totals[4] -= slips.select(zero, before[0]) + before[1];
            }
            for (sum, total) in sums.iter_mut().zip(totals) {
                let mut slots = [0.0; WIDTH];
                total.store_slice(&mut slots);
                add_slots(sum, &slots);
            }
        }
        for (drive_j, drive) in sums[0].iter_mut().zip(drives) {
            *drive_j *= drive.rate * model.time_step_s();
        }
        let [drive_j, friction_after_j, friction_before_j, contact_loss_after_j, contact_loss_before_j] =
            sums;
        let [slope_after_j, slope_before_j] = match &contacts.elastic {
            None => [[0.0; L]; 2],
            Some(elastic) => {
                [&elastic.yielding_m, &elastic.previous_yielding_m].map(|way| normal_work(contacts, way))
            }
        };
        StepWorks {
            drive_j,
            slope_after_j,
            slope_before_j,
            friction_after_j,
            friction_before_j,
            contact_loss_after_j,
            contact_loss_before_j,
        }
    }
}

/// Normal forces times an increment.
fn normal_work<const L: usize>(contacts: &Contacts<L>, way_m: &Field<L>) -> [f64; L] {
    let stride = way_m.blocks_per_line();
    let mut total = [0.0; L];
    for along in 0..stride {
        let mut slots = [0.0; WIDTH];
        let column = contacts.force_n.blocks()[along..].iter().zip(&way_m.blocks()[along..]).step_by(stride);
        for (force, way) in column {
            for i in 0..WIDTH {
                slots[i] += force.0[2][i] * way.0[2][i];
            }
        }
        add_slots(&mut total, &slots);
    }
    total
}

/// Force times increment: the tangential part, and the normal one.
#[inline(always)]
fn work<S: Simd>(simd: S, force: &Block, increment: &Block) -> [f64x8<S>; 2] {
    [
        product(simd, force, increment, 0) + product(simd, force, increment, 1),
        product(simd, force, increment, 2),
    ]
}

#[inline(always)]
fn product<S: Simd>(simd: S, a: &Block, b: &Block, component: usize) -> f64x8<S> {
    f64x8::from_slice(simd, &a.0[component]) * f64x8::from_slice(simd, &b.0[component])
}

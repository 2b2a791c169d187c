//! Work of the contact forces of one step.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::solve::TargetState;
use super::{Contacts, Interface, Status};
use crate::solver::drive::Drive;
use crate::solver::field::{Block, Field, WIDTH, add_slots};
use crate::solver::simd::dispatch;
use fearless_simd::{Simd, f64x8, prelude::*};

/// Computes the work of the contact forces.
#[derive(Debug, Clone)]
pub(in crate::solver) struct InterfaceWork<const L: usize> {
    /// Velocity of the target per unit of the drive's rate under every slave node, x and y.
    motion: Field<L>,
}

/// Work \[J\] of the forces at t_n over the increments after and before t_n.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_field_names, reason = "units are part of the names")]
pub(in crate::solver) struct StepWorks<const L: usize> {
    pub drive_j: [f64; L],
    /// Work of the drive on the slopes of an elastic target.
    pub slope_after_j: [f64; L],
    pub slope_before_j: [f64; L],
    pub friction_after_j: [f64; L],
    pub friction_before_j: [f64; L],
    pub contact_loss_after_j: [f64; L],
    pub contact_loss_before_j: [f64; L],
}

impl<const L: usize> InterfaceWork<L> {
    pub fn new(interface: &Interface) -> Self {
        let motion = interface.field(|node| [node.surface_motion[0], node.surface_motion[1], 0.0]);
        Self { motion }
    }

    /// The works of the step that gave these contacts and this target.
    pub fn of_step(
        &self,
        time_step_s: f64,
        drives: &[Drive; L],
        contacts: &Contacts<L>,
        target: &TargetState<L>,
    ) -> StepWorks<L> {
        let sums = dispatch!(simd => self.add_up(simd, contacts));
        let [mut drive_j, friction_after_j, friction_before_j, contact_loss_after_j, contact_loss_before_j] =
            sums;
        for (drive_j, drive) in drive_j.iter_mut().zip(drives) {
            *drive_j *= drive.rate * time_step_s;
        }
        let [slope_after_j, slope_before_j] = target.slope_works_j(contacts);
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

    #[inline(always)]
    fn add_up<S: Simd>(&self, simd: S, contacts: &Contacts<L>) -> [[f64; L]; 5] {
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
                // The tangential work of slipping nodes is friction. All other work is contact loss.
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
        sums
    }
}

/// Work of a force over an increment: its tangential part and its normal part.
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

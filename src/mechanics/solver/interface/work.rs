//! Work of the contact forces of one step.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::solve::{RunNumber, TargetState};
use super::{Contacts, Interface, NodesOnLayer, Status};
use crate::solver::field::{Block, FieldOf, add_slots};
use crate::solver::number::Number;
use crate::solver::simd::{dispatch, load, splat};
use fearless_simd::{Simd, prelude::*};

/// Computes the work of the contact forces.
#[derive(Debug, Clone)]
pub(in crate::solver) struct InterfaceWork<const L: usize, R: Number> {
    /// Velocity of the target per unit of the drive's rate under every slave node, x and y.
    motion: FieldOf<L, R>,
    layer: Option<NodesOnLayer>,
}

/// Work \[J\] of the forces at t_n over the increments after and before t_n.
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_field_names, reason = "units are part of the names")]
pub(in crate::solver) struct StepWorks<const L: usize> {
    pub drive_after_j: [f64; L],
    pub drive_before_j: [f64; L],
    /// Work of the drive on the slopes of an elastic target.
    pub slope_after_j: [f64; L],
    pub slope_before_j: [f64; L],
    pub friction_after_j: [f64; L],
    pub friction_before_j: [f64; L],
    pub contact_loss_after_j: [f64; L],
    pub contact_loss_before_j: [f64; L],
}

impl<const L: usize, R: RunNumber> InterfaceWork<L, R> {
    pub fn new(interface: &Interface) -> Self {
        let motion: FieldOf<L, R> =
            interface.field(|node| [node.surface_motion[0], node.surface_motion[1], 0.0]);
        let layer = interface
            .layer()
            .map(|layer| NodesOnLayer::new(*layer, interface.slaves(), |slave| motion.place(slave)));
        Self { motion, layer }
    }

    /// Energy \[J\] that a layer stores under the contact forces.
    pub fn stored_j(&self, contacts: &Contacts<L, R>) -> [f64; L] {
        self.layer.as_ref().map_or([0.0; L], |layer| layer.stored_j(contacts))
    }

    /// The works of the step that gave these contacts and this target. The rates of the target are those over the step and
    /// over the step before.
    pub fn of_step(
        &self,
        time_step_s: f64,
        [rates, last_rates]: [&[f64; L]; 2],
        contacts: &Contacts<L, R>,
        target: &TargetState<L, R>,
    ) -> StepWorks<L> {
        let mut sums = [[0.0; L]; SUMS];
        let face = FaceForces {
            stride: self.motion.blocks_per_line(),
            motion: self.motion.blocks(),
            force_n: contacts.force_n.blocks(),
            increment_m: contacts.increment_m.blocks(),
            previous_increment_m: contacts.previous_increment_m.blocks(),
            status: contacts.status.blocks(),
        };
        face.add_up(&mut sums.each_mut().map(<[f64; L]>::as_mut_slice));
        let [on_motion_n, friction_after_j, friction_before_j, contact_loss_after_j, contact_loss_before_j] =
            sums;
        let drive_j = |rates: &[f64; L]| std::array::from_fn(|l| on_motion_n[l] * (rates[l] * time_step_s));
        let [slope_after_j, slope_before_j] = target.slope_works_j(contacts);
        StepWorks {
            drive_after_j: drive_j(rates),
            drive_before_j: drive_j(last_rates),
            slope_after_j,
            slope_before_j,
            friction_after_j,
            friction_before_j,
            contact_loss_after_j,
            contact_loss_before_j,
        }
    }
}

/// Number of sums.
const SUMS: usize = 5;

/// The blocks of the contact face, for any number of lanes.
struct FaceForces<'a, R: Number> {
    stride: usize,
    motion: &'a [Block<R>],
    force_n: &'a [Block<R>],
    increment_m: &'a [Block<R>],
    previous_increment_m: &'a [Block<R>],
    status: &'a [Block<R>],
}

impl<R: Number> FaceForces<'_, R> {
    /// Adds the works to the sums of the lanes.
    fn add_up(&self, sums: &mut [&mut [f64]; SUMS]) {
        dispatch!(simd => self.add_up_in(simd, sums));
    }

    #[inline(always)]
    fn add_up_in<S: Simd>(&self, simd: S, sums: &mut [&mut [f64]; SUMS]) {
        let zero = splat::<R, S>(simd, 0.0);
        for along in 0..self.stride {
            let mut totals = [zero; SUMS];
            for at in (along..self.motion.len()).step_by(self.stride) {
                let force = &self.force_n[at];
                let now = work(simd, force, &self.increment_m[at]);
                let before = work(simd, force, &self.previous_increment_m[at]);
                let motion = &self.motion[at];
                let slips = load::<R, S>(simd, &self.status[at].0[Status::Slips as usize]).simd_gt(zero);
                totals[0] += product(simd, force, motion, 0) + product(simd, force, motion, 1);
                // The tangential work of slipping nodes is friction. All other work is contact loss.
                totals[1] -= slips.select(now[0], zero);
                totals[2] -= slips.select(before[0], zero);
                totals[3] -= slips.select(zero, now[0]) + now[1];
                totals[4] -= slips.select(zero, before[0]) + before[1];
            }
            for (sum, total) in sums.iter_mut().zip(&totals) {
                let row: &R::Row = total.as_array();
                add_slots(sum, row.as_ref());
            }
        }
    }
}

/// Work of a force over an increment: its tangential part and its normal part.
#[inline(always)]
fn work<R: Number, S: Simd>(simd: S, force: &Block<R>, increment: &Block<R>) -> [R::Vector<S>; 2] {
    [
        product(simd, force, increment, 0) + product(simd, force, increment, 1),
        product(simd, force, increment, 2),
    ]
}

#[inline(always)]
fn product<R: Number, S: Simd>(simd: S, a: &Block<R>, b: &Block<R>, component: usize) -> R::Vector<S> {
    load::<R, S>(simd, &a.0[component]) * load::<R, S>(simd, &b.0[component])
}

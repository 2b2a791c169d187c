//! The forward-increment solve on a rigid target, in closed form.
//!
//! On a rigid target c Δt² G M⁻¹ Gᵀ is diagonal (c is the scheme's factor of Δt²a in u_{n+1}), so
//! each slave node is solved by itself and one pass is exact:
//!
//! ```text
//! N = −m z*/(cΔt²)  if z* < 0       t_trial = −m δ*/(cΔt²),  δ* = u*_t − u_t − VΔt
//! ```
//!
//! The pass predicts a block of slave nodes and corrects it at once, so that a step reads and writes their
//! displacements once, as those of other nodes.
//!
//! A node that is held in a tangential direction in which the target moves slips there in any case: friction
//! opposes the whole slip, and the free direction is left with its part of the cone ([`coulomb::oppose`]). Such
//! nodes are rare and solved one by one.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::coulomb::{self, project};
use super::{Contacts, Face, Status};
use crate::solver::field::{Field, Place, in_slots};
use crate::solver::integrate::Factors;
use crate::solver::model::{Model, SlaveNode};
use crate::solver::state::Drive;
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// What is fixed during a run.
#[derive(Debug, Clone)]
pub(in crate::solver) struct RigidContact<const L: usize> {
    /// Per slave node: velocity of the target per unit of the drive's rate, x and y, and the mass; that of a node
    /// that the pass does not solve is zero.
    nodes: Field<L>,
    held: Vec<HeldNode<L>>,
}

/// A slave node with a fixed component.
#[derive(Debug, Clone)]
struct HeldNode<const L: usize> {
    place: Place,
    node: SlaveNode,
    /// Its displacements [m] at t_n.
    u_m: [[f64; L]; 3],
}

impl<const L: usize> RigidContact<L> {
    pub fn new(model: &Model) -> Self {
        let is_free = |node: &SlaveNode| node.mobile == [true; 3];
        let nodes: Field<L> = model.on_slaves(|node| {
            let [x, y] = node.surface_motion;
            [x, y, if is_free(node) { node.mass_kg } else { 0.0 }]
        });
        let held = model.slaves().iter().enumerate().filter(|(_, node)| !is_free(node));
        let held = held
            .map(|(slave, node)| HeldNode { place: nodes.place(slave), node: *node, u_m: [[0.0; L]; 3] })
            .collect();
        Self { nodes, held }
    }

    /// Moves the slave nodes; returns what supports carry of the contact forces on held ones [N].
    pub fn solve(
        &mut self,
        factors: &Factors,
        drives: &[Drive; L],
        face: &mut Face<'_, L>,
        contacts: &mut Contacts<L>,
    ) -> [[f64; L]; 3] {
        contacts.swap_increments();
        for held in &mut self.held {
            for c in 0..3 {
                held.u_m[c] = *face.u.at(held.place, c);
            }
        }
        if drives.iter().all(|drive| drive.mu == 0.0) {
            dispatch!(Level::new(), simd => self.pass::<_, false>(simd, factors, drives, face, contacts));
        } else {
            dispatch!(Level::new(), simd => self.pass::<_, true>(simd, factors, drives, face, contacts));
        }
        let mut carried_n = [[0.0; L]; 3];
        for held in &self.held {
            for lane in 0..L {
                held.solve(lane, factors, &drives[lane], face, contacts);
                for c in 0..2 {
                    if !held.node.mobile[c] {
                        carried_n[c][lane] += contacts.force_n.at(held.place, c)[lane];
                    }
                }
            }
        }
        carried_n
    }

    /// Predicts and corrects all nodes that are free to move; without `FRICTION` the law's square root and
    /// quotient, which would give zero, are left out.
    #[inline(always)]
    fn pass<S: Simd, const FRICTION: bool>(
        &self,
        simd: S,
        factors: &Factors,
        drives: &[Drive; L],
        face: &mut Face<'_, L>,
        contacts: &mut Contacts<L>,
    ) {
        let zero = f64x8::splat(simd, 0.0);
        let one = f64x8::splat(simd, 1.0);
        let mu = f64x8::from_slice(simd, &in_slots(&drives.map(|drive| drive.mu)));
        let travel = in_slots(&drives.map(|drive| drive.rate * factors.time_step_s));
        let travel = f64x8::from_slice(simd, &travel);
        let u_scale = f64x8::from_slice(simd, &factors.u_scale);
        let p_scale = f64x8::from_slice(simd, &factors.p_scale);
        let per_mass = one / u_scale;
        let count = self.nodes.blocks().len();
        let moving = face.u.blocks_mut()[..count].iter_mut().zip(&mut face.p.blocks_mut()[..count]);
        let given = self.nodes.blocks().iter().zip(&face.residual.blocks()[..count]).zip(face.inverse_mass);
        let found = (contacts.force_n.blocks_mut().iter_mut())
            .zip(contacts.increment_m.blocks_mut())
            .zip(contacts.status.blocks_mut());
        for (((u, p), ((node, residual), inverse_mass)), ((force, increment), status)) in
            moving.zip(given).zip(found)
        {
            let mut before = [zero; 3];
            let mut next_u = [zero; 3];
            let mut next_p = [zero; 3];
            for c in 0..3 {
                before[c] = f64x8::from_slice(simd, &u.0[c]);
                let residual = f64x8::from_slice(simd, &residual.0[c]);
                [next_u[c], next_p[c]] = factors.moved(simd, residual, &inverse_mass.0[c], &u.0[c], &p.0[c]);
            }
            let carried =
                [f64x8::from_slice(simd, &node.0[0]) * travel, f64x8::from_slice(simd, &node.0[1]) * travel];
            let mass = f64x8::from_slice(simd, &node.0[2]);
            let stiffness = mass * per_mass;
            let closed = next_u[2].simd_lt(zero) & mass.simd_gt(zero);
            let normal = closed.select(zero - next_u[2] * stiffness, zero);
            let slip = [(next_u[0] - before[0]) - carried[0], (next_u[1] - before[1]) - carried[1]];
            let (mut tangential, sticks) = if FRICTION {
                let trial = [zero - stiffness * slip[0], zero - stiffness * slip[1]];
                let friction = project(trial, normal, mu);
                (friction.force_n, friction.sticks & closed)
            } else {
                ([zero; 2], slip[0].simd_eq(zero) & slip[1].simd_eq(zero) & closed)
            };
            let inverse = f64x8::from_slice(simd, &inverse_mass.0[2]);
            // Constrained displacements are set, not corrected: a sticking node must not creep, nor a
            // closed one sink, by the rounding of its correction.
            for c in 0..2 {
                tangential[c] = closed.select(tangential[c], zero);
                let corrected =
                    if FRICTION { next_u[c] + (u_scale * inverse) * tangential[c] } else { next_u[c] };
                next_u[c] = sticks.select(before[c] + carried[c], corrected);
                if FRICTION {
                    next_p[c] += (p_scale * inverse) * tangential[c];
                }
                tangential[c].store_slice(&mut force.0[c]);
                ((next_u[c] - before[c]) - carried[c]).store_slice(&mut increment.0[c]);
            }
            next_u[2] = closed.select(zero, next_u[2]);
            next_p[2] += (p_scale * inverse) * normal;
            normal.store_slice(&mut force.0[2]);
            (next_u[2] - before[2]).store_slice(&mut increment.0[2]);
            for c in 0..3 {
                next_u[c].store_slice(&mut u.0[c]);
                next_p[c].store_slice(&mut p.0[c]);
            }
            let is_closed = closed.select(one, zero);
            next_u[2].store_slice(&mut status.0[Status::Gap as usize]);
            is_closed.store_slice(&mut status.0[Status::Closed as usize]);
            sticks.select(zero, is_closed).store_slice(&mut status.0[Status::Slips as usize]);
        }
    }
}

impl<const L: usize> HeldNode<L> {
    /// Corrects one lane of the node, which the pass has predicted.
    fn solve(
        &self,
        lane: usize,
        factors: &Factors,
        drive: &Drive,
        face: &mut Face<'_, L>,
        contacts: &mut Contacts<L>,
    ) {
        let place = self.place;
        // A slot's scales are those of its lane.
        let (u_scale, p_scale) = (factors.u_scale[lane], factors.p_scale[lane]);
        let stiffness = self.node.mass_kg * (1.0 / u_scale);
        let carried = self.node.surface_motion.map(|motion| motion * (drive.rate * factors.time_step_s));
        let z = face.u.at(place, 2)[lane];
        let mut force = [0.0; 3];
        let (mut closed, mut slips) = (false, false);
        if z < 0.0 && self.node.mobile[2] {
            closed = true;
            force[2] = -z * stiffness;
            let slip = [0, 1].map(|c| (face.u.at(place, c)[lane] - self.u_m[c][lane]) - carried[c]);
            ([force[0], force[1]], slips) = tangential(self.node.mobile, slip, stiffness, force[2], drive.mu);
            for c in (0..3).filter(|&c| self.node.mobile[c]) {
                let inverse = 1.0 / self.node.mass_kg;
                let u = &mut face.u.at_mut(place, c)[lane];
                *u = match c {
                    2 => 0.0,
                    _ if slips => *u + (u_scale * inverse) * force[c],
                    _ => self.u_m[c][lane] + carried[c],
                };
                face.p.at_mut(place, c)[lane] += (p_scale * inverse) * force[c];
            }
        }
        let end = [0, 1, 2].map(|c| face.u.at(place, c)[lane]);
        let target = [carried[0], carried[1], 0.0];
        for c in 0..3 {
            contacts.force_n.at_mut(place, c)[lane] = force[c];
            contacts.increment_m.at_mut(place, c)[lane] = (end[c] - self.u_m[c][lane]) - target[c];
        }
        let status = [end[2], f64::from(u8::from(closed)), f64::from(u8::from(slips))];
        for c in 0..3 {
            contacts.status.at_mut(place, c)[lane] = status[c];
        }
    }
}

/// Friction [N] on a closed node with the predicted `slip` [m], and whether it slips.
fn tangential(mobile: [bool; 3], slip: [f64; 2], stiffness: f64, normal_n: f64, mu: f64) -> ([f64; 2], bool) {
    let held_slip = |c: usize| !mobile[c] && slip[c] != 0.0;
    match (held_slip(0), held_slip(1)) {
        (false, false) => {
            let trial = [0, 1].map(|c| if mobile[c] { -stiffness * slip[c] } else { 0.0 });
            dispatch!(Level::new(), simd => {
                let all = |value| f64x8::splat(simd, value);
                let friction = project([all(trial[0]), all(trial[1])], all(normal_n), all(mu));
                ([friction.force_n[0][0], friction.force_n[1][0]], !friction.sticks.test(0))
            })
        }
        (true, false) if mobile[1] => (coulomb::oppose(slip[0], slip[1], stiffness, normal_n, mu), true),
        (false, true) if mobile[0] => {
            let [y, x] = coulomb::oppose(slip[1], slip[0], stiffness, normal_n, mu);
            ([x, y], true)
        }
        // Held in both: nothing to solve.
        _ => {
            let length = (slip[0] * slip[0] + slip[1] * slip[1]).sqrt();
            (slip.map(|s| -mu * normal_n * s / length), true)
        }
    }
}

//! Slave nodes with a fixed component, solved one by one.
//!
//! If a node is fixed in a tangential direction in which the target moves, it slips there in any case. Friction
//! opposes the whole slip vector, so the free direction gets only a part of the friction limit
//! ([`partially_held_friction`]). Such nodes are rare, and they are solved in f64 in both precisions.

use super::step_data::StepData;
use crate::solver::body::pin::Face;
use crate::solver::field::{FieldOf, LaneSlot};
use crate::solver::interface::LIMIT;
use crate::solver::interface::law::{AtNode, project};
use crate::solver::interface::{Contacts, SlaveNode, Status};
use crate::solver::number::Number;

/// A slave node with a fixed component.
#[derive(Debug, Clone)]
pub(super) struct HeldNode<const L: usize> {
    place: LaneSlot,
    node: SlaveNode,
    /// Initial gap \[m\]. See `DiagonalSolve`.
    initial_gap_m: [f64; L],
    /// Displacements \[m\] at t_n.
    u_m: [[f64; L]; 3],
    /// Whether the node slipped in the step before (0 or 1).
    slipped: [f64; L],
    /// Friction limit \[N\] of the step before.
    limit_n: [f64; L],
}

impl<const L: usize> HeldNode<L> {
    pub fn new(place: LaneSlot, node: SlaveNode) -> Self {
        let initial_gap_m = [node.initial_gap_m; L];
        Self { place, node, initial_gap_m, u_m: [[0.0; L]; 3], slipped: [0.0; L], limit_n: [0.0; L] }
    }

    /// Takes the initial gap from the first component of `gap_m`.
    pub fn set_gap<R: Number>(&mut self, gap_m: &FieldOf<L, R>) {
        self.initial_gap_m = gap_m.at(self.place, 0).map(R::to_f64);
    }

    /// Stores the values that the pass will overwrite.
    pub fn keep<R: Number>(&mut self, face: &Face<'_, L, R>, contacts: &Contacts<L, R>) {
        for c in 0..3 {
            self.u_m[c] = face.u.at(self.place, c).map(R::to_f64);
        }
        self.slipped = contacts.status.at(self.place, Status::Slips as usize).map(R::to_f64);
        self.limit_n = contacts.friction.at(self.place, LIMIT).map(R::to_f64);
    }

    /// Corrects the node in all lanes, after the pass has predicted it. Adds the contact forces \[N\] on its fixed
    /// components to `carried_n`.
    pub fn solve<R: Number>(
        &self,
        given: &StepData<'_, L, R>,
        face: &mut Face<'_, L, R>,
        contacts: &mut Contacts<L, R>,
        carried_n: &mut [[f64; L]; 3],
    ) {
        for lane in 0..L {
            self.solve_lane(lane, given, face, contacts);
            for c in 0..2 {
                if !self.node.mobile[c] {
                    carried_n[c][lane] += contacts.force_n.at(self.place, c)[lane].to_f64();
                }
            }
        }
    }

    fn solve_lane<R: Number>(
        &self,
        lane: usize,
        given: &StepData<'_, L, R>,
        face: &mut Face<'_, L, R>,
        contacts: &mut Contacts<L, R>,
    ) {
        let (factors, drive) = (given.factors, &given.drives[lane]);
        let place = self.place;
        // Slot `lane` of the scales belongs to that lane.
        let (u_scale, p_scale) = (factors.u_scale[lane].to_f64(), factors.p_scale[lane].to_f64());
        let stiffness = self.node.mass_kg * (1.0 / u_scale);
        let carried = self.node.surface_motion.map(|motion| motion * (drive.rate * factors.time_step_s));
        let initial_gap = self.initial_gap_m[lane];
        let predicted = [0, 1, 2].map(|c| face.u.at(place, c)[lane].to_f64());
        let gap = predicted[2] + initial_gap;
        let mut force = [0.0; 3];
        let mut limit = 0.0;
        let (mut closed, mut slips) = (false, false);
        if gap < 0.0 && self.node.mobile[2] {
            closed = true;
            force[2] = -gap * stiffness;
            let slip = [0, 1].map(|c| (predicted[c] - self.u_m[c][lane]) - carried[c]);
            let at_node = AtNode {
                normal_n: force[2],
                trial_n: slip.map(|s| -stiffness * s),
                stiffness_n_m: stiffness,
                last_increment_m: [0, 1].map(|c| contacts.previous_increment_m.at(place, c)[lane].to_f64()),
                last_slipped: self.slipped[lane],
                last_limit_n: self.limit_n[lane],
            };
            limit = drive.law.limit_n(&at_node, factors.time_step_s);
            ([force[0], force[1]], slips) = tangential(self.node.mobile, slip, stiffness, limit);
            for c in (0..3).filter(|&c| self.node.mobile[c]) {
                let inverse = 1.0 / self.node.mass_kg;
                let end = match c {
                    // Not −0 where there is no gap.
                    2 => 0.0 - initial_gap,
                    _ if slips => predicted[c] + (u_scale * inverse) * force[c],
                    _ => self.u_m[c][lane] + carried[c],
                };
                face.u.at_mut(place, c)[lane] = R::from_f64(end);
                let p = &mut face.p.at_mut(place, c)[lane];
                *p = R::from_f64(p.to_f64() + (p_scale * inverse) * force[c]);
            }
        }
        let end = [0, 1, 2].map(|c| face.u.at(place, c)[lane].to_f64());
        let target = [carried[0], carried[1], 0.0];
        for c in 0..3 {
            contacts.force_n.at_mut(place, c)[lane] = R::from_f64(force[c]);
            contacts.increment_m.at_mut(place, c)[lane] =
                R::from_f64((end[c] - self.u_m[c][lane]) - target[c]);
        }
        contacts.friction.at_mut(place, LIMIT)[lane] = R::from_f64(limit);
        let gap = if closed { 0.0 } else { gap };
        let status = [gap, f64::from(u8::from(closed)), f64::from(u8::from(slips))];
        for c in 0..3 {
            contacts.status.at_mut(place, c)[lane] = R::from_f64(status[c]);
        }
    }
}

/// Friction \[N\] on a closed node with the predicted `slip` \[m\], and whether the node slips.
fn tangential(mobile: [bool; 3], slip: [f64; 2], stiffness: f64, limit_n: f64) -> ([f64; 2], bool) {
    let held_slip = |c: usize| !mobile[c] && slip[c] != 0.0;
    match (held_slip(0), held_slip(1)) {
        (false, false) => {
            let trial = [0, 1].map(|c| if mobile[c] { -stiffness * slip[c] } else { 0.0 });
            let friction = project(trial, limit_n);
            (friction.force_n, !friction.sticks)
        }
        (true, false) if mobile[1] => (partially_held_friction(slip[0], slip[1], stiffness, limit_n), true),
        (false, true) if mobile[0] => {
            let [y, x] = partially_held_friction(slip[1], slip[0], stiffness, limit_n);
            ([x, y], true)
        }
        // No direction is free: the slip is given, and friction opposes it.
        _ => {
            let length = (slip[0] * slip[0] + slip[1] * slip[1]).sqrt();
            (slip.map(|s| -limit_n * s / length), true)
        }
    }
}

/// Friction \[N\] on a node with one fixed tangential direction, in which it slips by `given_m` ≠ 0. Without
/// friction it would slip by `free_m` in the other direction, where a force t changes the slip by
/// t/`stiffness_n_m`. The friction t = −R s/|s| has the size of the limit R and opposes the whole slip vector s.
/// Returns its components in the fixed and in the free direction.
///
/// The free slip δ is the root of g(δ) = δ + (R/k) δ/√(given² + δ²) − free. For free > 0 and δ ≥ 0, g increases and
/// is concave. So Newton's method, started between 0 and the root, converges from below without overshooting.
fn partially_held_friction(given_m: f64, free_m: f64, stiffness_n_m: f64, limit_n: f64) -> [f64; 2] {
    let (reach, aim) = (limit_n / stiffness_n_m, free_m.abs());
    // Two lower bounds of the root: δ/√(given² + δ²) is at most δ/|given| and at most 1.
    let mut slip = (aim / (1.0 + reach / given_m.abs())).max(aim - reach);
    loop {
        let length = (given_m * given_m + slip * slip).sqrt();
        let residual = slip + reach * slip / length - aim;
        let slope = 1.0 + reach * given_m * given_m / (length * length * length);
        let next = slip - residual / slope;
        // The iteration ends when rounding stops the increase, or at a number that is not finite.
        if next > slip {
            slip = next;
        } else {
            let scale = -limit_n / length;
            return [scale * given_m, scale * slip.copysign(free_m)];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the force on a partially held node lies on the cone and opposes the remaining slip, for all signs
    /// and ratios of the two slips.
    #[test]
    fn the_friction_of_a_partially_held_node_opposes_its_slip() {
        for given in [1e-9, -0.5, 1.0, 1e6_f64] {
            for free in [0.0, 1e-7, -0.3, 2.0, -1e5_f64] {
                for limit in [0.0, 0.4, 100.0] {
                    let stiffness = 3.0;
                    let force = partially_held_friction(given, free, stiffness, limit);
                    let slip: f64 = free + force[1] / stiffness;
                    let length = libm::hypot(given, slip);
                    // The sum free + t/k cancels, so the rounding error of the slip has the size of its terms.
                    let rounding =
                        8.0 * f64::EPSILON * (limit + limit * (free.abs() + limit / stiffness) / length);
                    let exact = [-limit * given / length, -limit * slip / length];
                    for c in 0..2 {
                        let error = (force[c] - exact[c]).abs();
                        assert!(error <= rounding, "{given}, {free}, {limit}: {force:?}, not {exact:?}");
                    }
                }
            }
        }
    }
}

//! The forward-increment solve on an elastic disk.
//!
//! Pin and disk are predicted to t_{n+1} without contact. A slave node s has the constraint row
//! G_s = (1, −N_1, …, −N_k) with the shape functions of the patch under it at t_{n+1}. The multiplier f is the
//! force on the pin. Its negative, distributed by the same shape functions, acts on the disk. The multipliers
//! satisfy
//!
//! ```text
//! g = g* + cΔt² (1/m_s + N C Nᵀ) f     g ≥ 0, N ≥ 0, g N = 0     |t| ≤ limit(N), slip opposes t
//! ```
//!
//! C = B M⁻¹ is the disk's response (`Response` in [`ring`](crate::solver::body::ring)). It couples slave nodes
//! that share target nodes, so the rows are solved by Gauss–Seidel ([`sweeps`](super::sweeps)). The solve begins
//! with the forces of the step before. It ends when no force changes by more than
//! [`TOLERANCE`](super::sweeps::TOLERANCE) of the largest.
//!
//! The gap is measured to the deformed target. Slip is the motion of the pin relative to the material point of the
//! disk that is under the node at t_{n+1}. So it has no jump where a node passes from one patch to the next. The
//! normal is that of the undeformed top face, because slopes are 10⁻⁶.

use super::step_data::StepData;
use super::sweeps::{ContactRow, LawInStep, Solves, TargetNode, TargetNodes};
use crate::solver::body::pin::{Face, move_nodes};
use crate::solver::body::ring::{RingBody, RingState};
use crate::solver::field::{Field, LaneSlot, WIDTH, add_slots};
use crate::solver::interface::LIMIT;
use crate::solver::interface::target::patch::{Grid, PatchCoord, Share};
use crate::solver::interface::{Contacts, Interface, Status};
use crate::solver::lane::LaneState;
use crate::spec::TargetSurface;
use std::sync::Arc;

/// The elastic disk under the pin, in every lane.
#[derive(Debug, Clone)]
pub struct RingTarget<const L: usize> {
    body: Arc<RingBody>,
    state: RingState<L>,
    /// Increment \[m\] of the disk's surface under each slave node over the step: x and y. In z it is the height of
    /// the surface at t_n under the node's position at t_{n+1}, minus that under its position at t_n.
    increment_m: Field<L>,
    /// The increment \[m\] over the step before. In z it uses the patches of this step, like
    /// [`Contacts::previous_increment_m`].
    previous_increment_m: Field<L>,
    solves: [Solves; L],
    solve: CoupledSolve<L>,
}

impl<const L: usize> RingTarget<L> {
    pub(super) fn new(interface: &Interface, body: &Arc<RingBody>) -> Self {
        Self {
            state: RingState::at_rest(body),
            increment_m: Field::zeros(interface.layout()),
            previous_increment_m: Field::zeros(interface.layout()),
            solves: [Solves::default(); L],
            solve: CoupledSolve::new(interface, body),
            body: Arc::clone(body),
        }
    }

    pub(super) fn body(&self) -> &RingBody {
        &self.body
    }

    pub(super) fn state(&self) -> &RingState<L> {
        &self.state
    }

    pub(super) fn increment_of(&self, slave: usize, lane: usize) -> [f64; 3] {
        let place = self.increment_m.place(slave);
        std::array::from_fn(|c| self.increment_m.at(place, c)[lane])
    }

    pub(super) fn solves_of(&self, lane: usize) -> &Solves {
        &self.solves[lane]
    }

    pub(super) fn works_on_slopes_j(&self, contacts: &Contacts<L>) -> [[f64; L]; 2] {
        [&self.increment_m, &self.previous_increment_m].map(|increment| normal_work(contacts, increment))
    }
}

impl<const L: usize> LaneState for RingTarget<L> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        self.increment_m.save_lane(lane, saved);
        self.previous_increment_m.save_lane(lane, saved);
        self.solves[lane].save(saved);
        self.state.save_lane(lane, saved);
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        self.increment_m.load_lane(lane, saved);
        self.previous_increment_m.load_lane(lane, saved);
        self.solves[lane] = Solves::load(saved);
        self.state.load_lane(lane, saved);
    }
}

/// The constants of the solve, and scratch memory. Nothing in it is carried from step to step.
#[derive(Debug, Clone)]
struct CoupledSolve<const L: usize> {
    grid: Grid,
    slaves: Vec<Slave>,
    /// Smallest and largest angle \[rad\] of a slave node.
    angles_rad: [f64; 2],
    /// Sine and cosine of the angles of the mesh's columns.
    directions: Vec<(f64, f64)>,
    /// The pin's contact face at t_n.
    face_before: Before<L>,
    /// The disk's top face at t_n.
    top_before: Before<L>,
    rows: Vec<ContactRow>,
    targets: TargetNodes,
}

/// Displacements \[m\] at t_n, and p_n \[m/s\], which is the velocity over the step before.
#[derive(Debug, Clone)]
struct Before<const L: usize> {
    u: Field<L>,
    p: Field<L>,
}

impl<const L: usize> Before<L> {
    fn new(field: Field<L>) -> Self {
        Self { u: field.clone(), p: field }
    }

    /// Copies the first blocks of `u` and `p`.
    fn keep(&mut self, u: &Field<L>, p: &Field<L>) {
        let count = self.u.blocks().len();
        self.u.blocks_mut().copy_from_slice(&u.blocks()[..count]);
        self.p.blocks_mut().copy_from_slice(&p.blocks()[..count]);
    }
}

/// A slave node on the disk.
#[derive(Debug, Clone, Copy)]
struct Slave {
    place: LaneSlot,
    angle_rad: f64,
    across: PatchCoord,
    inverse_mass: f64,
    initial_gap_m: f64,
    motion: [f64; 2],
}

impl<const L: usize> CoupledSolve<L> {
    fn new(interface: &Interface, body: &RingBody) -> Self {
        let grid = Grid::new(body.mesh(), body.target());
        let face = Field::<L>::zeros(interface.layout());
        let slaves: Vec<Slave> = interface
            .slaves()
            .iter()
            .enumerate()
            .map(|(index, slave)| {
                // The lever arms (−Y, X) give the position of a node from the disk's axis.
                let [minus_y, x] = slave.surface_motion;
                Slave {
                    place: face.place(index),
                    angle_rad: libm::atan2(-minus_y, x),
                    across: grid.across(libm::hypot(x, minus_y)),
                    inverse_mass: 1.0 / slave.mass_kg,
                    initial_gap_m: slave.initial_gap_m,
                    motion: slave.surface_motion,
                }
            })
            .collect();
        let angles = || slaves.iter().map(|slave| slave.angle_rad);
        let angles_rad = [angles().fold(f64::INFINITY, f64::min), angles().fold(f64::NEG_INFINITY, f64::max)];
        Self {
            angles_rad,
            directions: body.mesh().angles_rad().iter().map(|angle| libm::sincos(*angle)).collect(),
            face_before: Before::new(face),
            top_before: Before::new(Field::zeros(body.mesh().top_layout())),
            rows: vec![ContactRow::default(); slaves.len()],
            targets: TargetNodes { rows: grid.rows(), first: 0, nodes: Vec::new() },
            slaves,
            grid,
        }
    }

    /// Coordinates of the slave nodes of a lane along and across the track at t_{n+1}.
    fn patch_coords(&self, turned_rad: f64) -> impl Iterator<Item = (PatchCoord, PatchCoord)> + '_ {
        self.slaves.iter().map(move |slave| (self.grid.along(slave.angle_rad - turned_rad), slave.across))
    }

    /// Collects the target nodes under the slave nodes of a lane. The disk has turned by `turned_rad` at t_{n+1}.
    fn gather(&mut self, body: &RingBody, lane: usize, turned_rad: f64, dt: f64, disk: &RingState<L>) {
        let [low, high] = self.angles_rad.map(|angle| self.grid.along(angle - turned_rad).cell);
        let (first, last) = (low - self.grid.margin(), high + 1 + self.grid.margin());
        let (sin, cos) = libm::sincos(turned_rad);
        let mesh = body.mesh();
        self.targets.first = first;
        self.targets.nodes.clear();
        for column in first..=last {
            let column = self.grid.track_column(column);
            let (sin_there, cos_there) = self.directions[column];
            for row in 0..self.targets.rows {
                let node = mesh.node(column, mesh.track().first_row + row, 0);
                let place = disk.u.place(node);
                let before: [f64; 3] = std::array::from_fn(|c| self.top_before.u.at(place, c)[lane]);
                let last_increment_m = std::array::from_fn(|c| dt * self.top_before.p.at(place, c)[lane]);
                let mut target = TargetNode {
                    node,
                    column,
                    row,
                    cos: cos_there * cos - sin_there * sin,
                    sin: sin_there * cos + cos_there * sin,
                    height_m: before[2],
                    inverse_mass: body.inverse_mass()[node],
                    ..TargetNode::default()
                };
                let increment_m = std::array::from_fn(|c| disk.u.at(place, c)[lane] - before[c]);
                target.increment_m = target.in_pin(increment_m);
                target.last_increment_m = target.in_pin(last_increment_m);
                self.targets.nodes.push(target);
            }
        }
    }

    /// Sets the constraint row of every slave node of a lane from the prediction and the step before.
    fn gather_rows<const K: usize>(
        &mut self,
        step: &LaneStep<'_>,
        shares: &[[Share; K]],
        u: &Field<L>,
        contacts: &Contacts<L>,
    ) {
        let Self { slaves, face_before, rows, targets, .. } = self;
        let (lane, u_scale) = (step.lane, step.u_scale);
        for ((slave, row), shares) in slaves.iter().zip(rows).zip(shares) {
            let end: [f64; 3] = std::array::from_fn(|c| u.at(slave.place, c)[lane]);
            let before = [0, 1].map(|c| face_before.u.at(slave.place, c)[lane]);
            let slip = [0, 1].map(|c| end[c] - before[c] - slave.motion[c] * step.travel_m);
            *row = ContactRow {
                free_m: [slip[0], slip[1], end[2] + slave.initial_gap_m],
                force_n: std::array::from_fn(|c| contacts.force_n.at(slave.place, c)[lane]),
                own: u_scale * slave.inverse_mass,
                compliance: u_scale * slave.inverse_mass,
                sticks: false,
                limit_n: 0.0,
                last_increment_m: [0, 1].map(|c| contacts.previous_increment_m.at(slave.place, c)[lane]),
                slipped: contacts.status.at(slave.place, Status::Slips as usize)[lane],
                last_limit_n: contacts.friction.at(slave.place, LIMIT)[lane],
            };
            for share in shares {
                let node = targets.node(share);
                row.free_m[0] -= share.weight * node.increment_m[0];
                row.free_m[1] -= share.weight * node.increment_m[1];
                row.free_m[2] -= share.weight * (node.height_m + node.increment_m[2]);
                row.compliance += share.weight * share.weight * (u_scale * node.inverse_mass);
            }
        }
    }

    /// Increment \[m\] of a slave node relative to the deformation of the disk over the step before, by the constraint of this step: its
    /// forces do work over that increment, too.
    fn last_increment_m<const K: usize>(
        &self,
        step: &LaneStep<'_>,
        slave: &Slave,
        shares: &[Share; K],
    ) -> [f64; 3] {
        let p = &self.face_before.p;
        let mut last: [f64; 3] = std::array::from_fn(|c| step.time_step_s * p.at(slave.place, c)[step.lane]);
        for share in shares {
            let node = self.targets.node(share);
            for c in 0..3 {
                last[c] -= share.weight * node.last_increment_m[c];
            }
        }
        last
    }
}

impl<const L: usize> RingTarget<L> {
    /// Moves the slave nodes and the disk to t_{n+1}.
    pub(super) fn move_both(
        &mut self,
        given: &StepData<'_, L>,
        face: &mut Face<'_, L>,
        contacts: &mut Contacts<L>,
    ) {
        std::mem::swap(&mut self.increment_m, &mut self.previous_increment_m);
        self.solve.face_before.keep(face.u, face.p);
        self.solve.top_before.keep(&self.state.u, &self.state.p);
        let count = self.solve.face_before.u.blocks().len();
        self.state.predict(&self.body, given.factors);
        let (u, p) = (&mut face.u.blocks_mut()[..count], &mut face.p.blocks_mut()[..count]);
        move_nodes(given.factors, face.residual.blocks(), face.inverse_mass, u, p);
        for lane in 0..L {
            let step = LaneStep::new(given, lane);
            let turned_rad = given.drives[lane].rate * (step.number as f64 * step.time_step_s);
            self.solve.gather(&self.body, lane, turned_rad, step.time_step_s, &self.state);
            let (first, grid) = (self.solve.targets.first, self.solve.grid);
            let coords = self.solve.patch_coords(turned_rad);
            match self.body.target() {
                TargetSurface::Bilinear => {
                    let shares: Vec<_> = coords.map(|(a, b)| Grid::bilinear(a, b, first)).collect();
                    self.solve_lane(&step, &shares, face, contacts);
                }
                TargetSurface::Ferguson => {
                    let shares: Vec<_> = coords.map(|(a, b)| grid.ferguson(a, b, first)).collect();
                    self.solve_lane(&step, &shares, face, contacts);
                }
            }
        }
    }

    /// Finds the contact forces of a lane, and moves pin and disk by them.
    fn solve_lane<const K: usize>(
        &mut self,
        step: &LaneStep<'_>,
        shares: &[[Share; K]],
        face: &mut Face<'_, L>,
        contacts: &mut Contacts<L>,
    ) {
        self.solve.gather_rows(step, shares, face.u, contacts);
        let CoupledSolve { rows, targets, .. } = &mut self.solve;
        let sweeps = targets.sweep(&self.body, step.u_scale, step.law, rows, shares);
        targets.spread(rows, shares);
        targets.respond(&self.body, step.u_scale);
        let residual = targets.residual(step.law, rows, shares);
        self.solves[step.lane].add(step.number, sweeps, residual);
        for (index, shares) in shares.iter().enumerate() {
            self.write_back(step, index, shares, face, contacts);
        }
        for source in self.solve.targets.reactions() {
            self.state.add_force(&self.body, step.lane, &source, step.u_scale, step.p_scale);
        }
    }

    /// Moves a slave node by its contact force, and stores what the step found.
    fn write_back<const K: usize>(
        &mut self,
        step: &LaneStep<'_>,
        index: usize,
        shares: &[Share; K],
        face: &mut Face<'_, L>,
        contacts: &mut Contacts<L>,
    ) {
        let CoupledSolve { slaves, face_before, rows, targets, .. } = &self.solve;
        let (slave, row, lane) = (&slaves[index], &rows[index], step.lane);
        let place = slave.place;
        let relative = targets.relative_m(row, shares);
        let closed = row.force_n[2] > 0.0;
        let heights = {
            let ahead =
                shares.iter().fold(0.0, |sum, share| sum + share.weight * targets.node(share).height_m);
            let raised = face_before.u.at(place, 2)[lane] + slave.initial_gap_m;
            let measured = contacts.status.at(place, Status::Gap as usize)[lane];
            Heights {
                raised,
                ahead,
                // No step has measured the gap at the start.
                gap_before: if step.number == 1 { raised - ahead } else { measured },
                gap: if closed { 0.0 } else { relative[2] },
            }
        };
        for c in 0..3 {
            let force = row.force_n[c];
            face.u.at_mut(place, c)[lane] += row.own * force;
            face.p.at_mut(place, c)[lane] += (step.p_scale * slave.inverse_mass) * force;
            contacts.force_n.at_mut(place, c)[lane] = force;
        }
        contacts.friction.at_mut(place, LIMIT)[lane] = row.limit_n;
        if step.number > 1 {
            let last = self.solve.last_increment_m(step, slave, shares);
            for c in 0..2 {
                contacts.previous_increment_m.at_mut(place, c)[lane] =
                    last[c] - slave.motion[c] * step.travel_m;
            }
            let closing = contacts.previous_increment_m.at(place, 2)[lane];
            self.previous_increment_m.at_mut(place, 2)[lane] = last[2] - closing;
        }
        let moved = [0, 1].map(|c| face.u.at(place, c)[lane] - self.solve.face_before.u.at(place, c)[lane]);
        let increment = [relative[0], relative[1], heights.gap - heights.gap_before];
        let of_target = [
            moved[0] - increment[0] - slave.motion[0] * step.travel_m,
            moved[1] - increment[1] - slave.motion[1] * step.travel_m,
            heights.ahead - heights.under(),
        ];
        let slips = closed && !row.sticks;
        let status = [heights.gap, f64::from(u8::from(closed)), f64::from(u8::from(slips))];
        for c in 0..3 {
            contacts.increment_m.at_mut(place, c)[lane] = increment[c];
            contacts.status.at_mut(place, c)[lane] = status[c];
            self.increment_m.at_mut(place, c)[lane] = of_target[c];
        }
    }
}

/// A step of one lane.
struct LaneStep<'a> {
    lane: usize,
    /// Number of the step, counted from 1.
    number: u64,
    time_step_s: f64,
    /// What a force over a mass adds to a displacement \[s²\] and to p \[s\].
    u_scale: f64,
    p_scale: f64,
    /// Displacement \[m\] of the target over the step per unit of its motion.
    travel_m: f64,
    law: LawInStep<'a>,
}

impl<'a> LaneStep<'a> {
    fn new<const L: usize>(given: &StepData<'a, L>, lane: usize) -> Self {
        let (factors, drive) = (given.factors, &given.drives[lane]);
        let time_step_s = factors.time_step_s;
        Self {
            lane,
            number: given.steps_done[lane] + 1,
            time_step_s,
            u_scale: factors.u_scale[lane],
            p_scale: factors.p_scale[lane],
            travel_m: drive.rate * time_step_s,
            law: (&drive.law, time_step_s),
        }
    }
}

/// Heights \[m\] of a slave node and of the surface at both ends of a step.
///
/// ```text
///               t_n                                       t_{n+1}
///
///   raised  ●  the node
///           │                                          ●  the node
///           │ gap_before                               │ gap
///           │                   ___ ahead              │
///    under ─┴──────────‾‾‾‾‾‾‾‾‾‾    ┊       ──────────┴──────────
///           the surface below it     ┊        the surface, which has
///                                    ┊        moved meanwhile
///              where the node will be over
///              the disk at t_{n+1}
/// ```
///
/// The gap changes by `gap` − `gap_before`. The disk turns below the node, so the surface rises by `ahead` − `under` even if it does
/// not deform: that is its slope.
struct Heights {
    raised: f64,
    ahead: f64,
    gap_before: f64,
    gap: f64,
}

impl Heights {
    fn under(&self) -> f64 {
        self.raised - self.gap_before
    }
}

/// Work \[J\] of the normal forces over an increment in z.
fn normal_work<const L: usize>(contacts: &Contacts<L>, increment_m: &Field<L>) -> [f64; L] {
    let stride = increment_m.blocks_per_line();
    let mut total = [0.0; L];
    for along in 0..stride {
        let mut slots = [0.0; WIDTH];
        let column =
            contacts.force_n.blocks()[along..].iter().zip(&increment_m.blocks()[along..]).step_by(stride);
        for (force, increment) in column {
            for i in 0..WIDTH {
                slots[i] += force.0[2][i] * increment.0[2][i];
            }
        }
        add_slots(&mut total, &slots);
    }
    total
}

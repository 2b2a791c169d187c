//! The forward-increment solve on an elastic disk.
//!
//! Pin and disk are predicted to t_{n+1} without contact. A slave node s carries the row G_s = (1, −N_1, …, −N_k) of
//! the shape functions of the patch under it at t_{n+1}, and multipliers f (force on the pin; its negative, spread
//! by the same shape functions, acts on the disk) are found such that
//!
//! ```text
//! g = g* + cΔt² (1/m_s + N C Nᵀ) f     g ≥ 0, N ≥ 0, g N = 0     |t| ≤ μN, slip opposes t
//! ```
//!
//! C = B M⁻¹ is the disk's response ([`Response`](crate::solver::disk::response::Response)); it couples slave nodes
//! that share target nodes, by Gauss–Seidel ([`sweeps`](super::sweeps)). The solve begins with the forces of the step
//! before and ends when no force changes by more than [`TOLERANCE`](super::sweeps::TOLERANCE) of the largest.
//!
//! The gap is measured to the deformed target; slip is the pin's motion past the material point of the disk that
//! is under the node at t_{n+1}, and so has no jump where a node passes from one patch to the next. The normal
//! is that of the undeformed top: slopes are 10⁻⁶.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::patch::{Grid, Share, Spot};
use super::sweeps::{Row, TargetNode, Targets};
use super::{Contacts, Face, Status};
use crate::solver::disk::{DiskBody, DiskState};
use crate::solver::field::{Field, Place};
use crate::solver::integrate::Factors;
use crate::solver::model::Model;
use crate::solver::state::Drive;
use crate::spec::TargetSurface;
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// What is fixed during a run, and scratch.
#[derive(Debug, Clone)]
pub(in crate::solver) struct ElasticContact<const L: usize> {
    grid: Grid,
    slaves: Vec<Slave>,
    /// Smallest and largest angle [rad] of a slave node.
    angles_rad: [f64; 2],
    /// Sine and cosine of the angles of the mesh's columns.
    directions: Vec<(f64, f64)>,
    /// The pin's face and the disk's top at t_n.
    face_before: Before<L>,
    top_before: Before<L>,
    rows: Vec<Row>,
    targets: Targets,
}

/// Displacements [m] at t_n and, as p_n, over the step before [m/s].
#[derive(Debug, Clone)]
struct Before<const L: usize> {
    u: Field<L>,
    p: Field<L>,
}

impl<const L: usize> Before<L> {
    fn new(field: Field<L>) -> Self {
        Self { u: field.clone(), p: field }
    }

    /// Keeps the first blocks of these.
    fn keep(&mut self, u: &Field<L>, p: &Field<L>) {
        let count = self.u.blocks().len();
        self.u.blocks_mut().copy_from_slice(&u.blocks()[..count]);
        self.p.blocks_mut().copy_from_slice(&p.blocks()[..count]);
    }
}

/// A slave node.
#[derive(Debug, Clone, Copy)]
struct Slave {
    place: Place,
    angle_rad: f64,
    across: Spot,
    inverse_mass: f64,
    motion: [f64; 2],
}

/// What a step is given.
pub(in crate::solver) struct Given<'a, const L: usize> {
    pub factors: &'a Factors,
    pub drives: &'a [Drive; L],
    /// Number n + 1 of the step.
    pub steps: [u64; L],
    /// How far the disk has turned at t_{n+1}.
    pub turned_rad: [f64; L],
}

impl<const L: usize> ElasticContact<L> {
    pub fn new(model: &Model, body: &DiskBody) -> Self {
        let grid = Grid::new(body.mesh(), body.target());
        let face = Field::<L>::on_face(model.mesh());
        let slaves: Vec<Slave> = model
            .slaves()
            .iter()
            .enumerate()
            .map(|(index, slave)| {
                // The lever arms (−Y, X) say where a node is.
                let [minus_y, x] = slave.surface_motion;
                Slave {
                    place: face.place(index),
                    angle_rad: libm::atan2(-minus_y, x),
                    across: grid.across(libm::hypot(x, minus_y)),
                    inverse_mass: 1.0 / slave.mass_kg,
                    motion: slave.surface_motion,
                }
            })
            .collect();
        let angles = || slaves.iter().map(|slave| slave.angle_rad);
        let angles_rad = [angles().fold(f64::INFINITY, f64::min), angles().fold(f64::NEG_INFINITY, f64::max)];
        let [columns, rows, _] = body.mesh().nodes_per_axis();
        Self {
            angles_rad,
            directions: body.mesh().angles_rad().iter().map(|angle| libm::sincos(*angle)).collect(),
            face_before: Before::new(face),
            top_before: Before::new(Field::with_lines(columns, rows)),
            rows: vec![Row::default(); slaves.len()],
            targets: Targets { rows: grid.rows(), first: 0, nodes: Vec::new() },
            slaves,
            grid,
        }
    }

    /// Moves the slave nodes and the disk.
    pub fn solve(
        &mut self,
        body: &DiskBody,
        given: &Given<'_, L>,
        face: &mut Face<'_, L>,
        disk: &mut DiskState<L>,
        contacts: &mut Contacts<L>,
    ) {
        contacts.swap_increments();
        self.face_before.keep(face.u, face.p);
        self.top_before.keep(&disk.u, &disk.p);
        let count = self.face_before.u.blocks().len();
        disk.predict(body, given.factors);
        dispatch!(Level::new(), simd => predict(simd, given.factors, face, count));
        for lane in 0..L {
            self.gather(body, given, lane, disk);
            let first = self.targets.first;
            match body.target() {
                TargetSurface::Bilinear => {
                    let shares: Vec<_> =
                        self.spots(given, lane).map(|(a, b)| self.grid.bilinear(a, b, first)).collect();
                    self.solve_lane(body, given, lane, &shares, face, disk, contacts);
                }
                TargetSurface::Ferguson => {
                    let shares: Vec<_> =
                        self.spots(given, lane).map(|(a, b)| self.grid.ferguson(a, b, first)).collect();
                    self.solve_lane(body, given, lane, &shares, face, disk, contacts);
                }
            }
        }
    }

    /// Where the slave nodes of a lane are on the track at t_{n+1}.
    fn spots(&self, given: &Given<'_, L>, lane: usize) -> impl Iterator<Item = (Spot, Spot)> + '_ {
        let turned_rad = given.turned_rad[lane];
        self.slaves.iter().map(move |slave| (self.grid.along(slave.angle_rad - turned_rad), slave.across))
    }

    /// Collects the target nodes of a lane.
    fn gather(&mut self, body: &DiskBody, given: &Given<'_, L>, lane: usize, disk: &DiskState<L>) {
        let (turned_rad, dt) = (given.turned_rad[lane], given.factors.time_step_s);
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

    #[expect(clippy::too_many_arguments, reason = "a lane of a solve has that many parts")]
    fn solve_lane<const K: usize>(
        &mut self,
        body: &DiskBody,
        given: &Given<'_, L>,
        lane: usize,
        shares: &[[Share; K]],
        face: &mut Face<'_, L>,
        disk: &mut DiskState<L>,
        contacts: &mut Contacts<L>,
    ) {
        let (u_scale, p_scale) = (given.factors.u_scale[lane], given.factors.p_scale[lane]);
        let drive = &given.drives[lane];
        let travel_m = drive.rate * given.factors.time_step_s;
        for ((slave, row), shares) in self.slaves.iter().zip(&mut self.rows).zip(shares) {
            let end: [f64; 3] = std::array::from_fn(|c| face.u.at(slave.place, c)[lane]);
            let before = [0, 1].map(|c| self.face_before.u.at(slave.place, c)[lane]);
            let slip = [0, 1].map(|c| end[c] - before[c] - slave.motion[c] * travel_m);
            *row = Row {
                free_m: [slip[0], slip[1], end[2]],
                force_n: std::array::from_fn(|c| contacts.force_n.at(slave.place, c)[lane]),
                own: u_scale * slave.inverse_mass,
                compliance: u_scale * slave.inverse_mass,
                sticks: false,
            };
            for share in shares {
                let node = self.targets.node(share);
                row.free_m[0] -= share.weight * node.increment_m[0];
                row.free_m[1] -= share.weight * node.increment_m[1];
                row.free_m[2] -= share.weight * (node.height_m + node.increment_m[2]);
                row.compliance += share.weight * share.weight * (u_scale * node.inverse_mass);
            }
        }
        let sweeps = self.targets.sweep(body, u_scale, drive.mu, &mut self.rows, shares);
        self.targets.spread(&self.rows, shares);
        self.targets.respond(body, u_scale);
        let residual = self.targets.residual(drive.mu, &self.rows, shares);
        if let Some(elastic) = &mut contacts.elastic {
            elastic.solves[lane].add(given.steps[lane], sweeps, residual);
        }
        for ((slave, row), shares) in self.slaves.iter().zip(&self.rows).zip(shares) {
            let place = slave.place;
            let relative = self.targets.relative_m(row, shares);
            let closed = row.force_n[2] > 0.0;
            let gap_before = contacts.status.at(place, Status::Gap as usize)[lane];
            let gap = if closed { 0.0 } else { relative[2] };
            for c in 0..3 {
                let force = row.force_n[c];
                face.u.at_mut(place, c)[lane] += row.own * force;
                face.p.at_mut(place, c)[lane] += (p_scale * slave.inverse_mass) * force;
                contacts.force_n.at_mut(place, c)[lane] = force;
            }
            let increment = [relative[0], relative[1], gap - gap_before];
            let status = [gap, f64::from(u8::from(closed)), f64::from(u8::from(closed && !row.sticks))];
            // The surface under the node at t_n, and what is then under its place at t_{n+1}.
            let under = self.face_before.u.at(place, 2)[lane] - gap_before;
            let mut ahead = 0.0;
            // What the constraint of this step says of the step before: its forces do work over that, too.
            let mut last: [f64; 3] =
                std::array::from_fn(|c| given.factors.time_step_s * self.face_before.p.at(place, c)[lane]);
            for share in shares {
                let node = self.targets.node(share);
                ahead += share.weight * node.height_m;
                for c in 0..3 {
                    last[c] -= share.weight * node.last_increment_m[c];
                }
            }
            if given.steps[lane] > 1 {
                for c in 0..2 {
                    contacts.previous_increment_m.at_mut(place, c)[lane] =
                        last[c] - slave.motion[c] * travel_m;
                }
                let closing = contacts.previous_increment_m.at(place, 2)[lane];
                if let Some(elastic) = &mut contacts.elastic {
                    elastic.previous_yielding_m.at_mut(place, 2)[lane] = last[2] - closing;
                }
            }
            let moved = [0, 1].map(|c| face.u.at(place, c)[lane] - self.face_before.u.at(place, c)[lane]);
            let yielding = [
                moved[0] - increment[0] - slave.motion[0] * travel_m,
                moved[1] - increment[1] - slave.motion[1] * travel_m,
                ahead - under,
            ];
            for c in 0..3 {
                contacts.increment_m.at_mut(place, c)[lane] = increment[c];
                contacts.status.at_mut(place, c)[lane] = status[c];
                if let Some(elastic) = &mut contacts.elastic {
                    elastic.yielding_m.at_mut(place, c)[lane] = yielding[c];
                }
            }
        }
        self.targets.move_disk(body, lane, u_scale, p_scale, disk);
    }
}

/// Moves the slave nodes as if there were no contact.
#[inline(always)]
fn predict<S: Simd, const L: usize>(simd: S, factors: &Factors, face: &mut Face<'_, L>, count: usize) {
    let moving = face.u.blocks_mut()[..count].iter_mut().zip(&mut face.p.blocks_mut()[..count]);
    for ((u, p), (residual, inverse)) in moving.zip(face.residual.blocks().iter().zip(face.inverse_mass)) {
        for c in 0..3 {
            let force = f64x8::from_slice(simd, &residual.0[c]);
            let [next_u, next_p] = factors.moved(simd, force, &inverse.0[c], &u.0[c], &p.0[c]);
            next_u.store_slice(&mut u.0[c]);
            next_p.store_slice(&mut p.0[c]);
        }
    }
}

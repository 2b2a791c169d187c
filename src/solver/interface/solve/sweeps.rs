//! Gauss–Seidel sweeps over the constraint rows of one lane.
//!
//! A row is solved by itself: normal force, then projection on its cone. What it has changed is passed on to the
//! rows that share its target nodes with M⁻¹, the largest that the disk's response C = B M⁻¹ can be; after the sweep C
//! itself is applied. So a sweep is exact where the disk makes one stage, and contracts where it makes several.

use crate::solver::body::ring::{RingBody, TrackForce, times};
use crate::solver::interface::law::{Law, project};
use crate::solver::interface::target::patch::Share;
use crate::solver::lane::next;

/// Largest change of a nodal force in the last sweep, over the largest nodal force.
pub const TOLERANCE: f64 = 1.0e-10;

/// The solve has failed after so many sweeps. The reference scene takes six.
pub const MAX_SWEEPS: u32 = 500;

/// How the solves of a lane went.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Solves {
    /// Sweeps of all its steps.
    pub sweeps: f64,
    /// Most sweeps of a step.
    pub most_sweeps: f64,
    /// Largest residual of the forces that were found, over the largest force.
    pub residual: f64,
    /// Step whose solve did not converge, counted from 1; 0 if there is none.
    pub failed_step: f64,
}

impl Solves {
    /// Adds the solve of a step, counted from 1.
    pub(super) fn add(&mut self, step: u64, sweeps: u32, residual: f64) {
        let sweeps = f64::from(sweeps);
        self.sweeps += sweeps;
        self.most_sweeps = self.most_sweeps.max(sweeps);
        self.residual = self.residual.max(residual);
        if sweeps > f64::from(MAX_SWEEPS) && self.failed_step == 0.0 {
            self.failed_step = step as f64;
        }
    }

    pub(super) fn save(&self, saved: &mut Vec<f64>) {
        saved.extend([self.sweeps, self.most_sweeps, self.residual, self.failed_step]);
    }

    pub(super) fn load(saved: &mut dyn Iterator<Item = f64>) -> Self {
        let [sweeps, most_sweeps, residual, failed_step] = next(saved);
        Self { sweeps, most_sweeps, residual, failed_step }
    }
}

/// A slave node's constraint during the solve of one lane; vectors in the pin's directions.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ContactRow {
    /// Slip in x and y and gap [m] of the prediction.
    pub free_m: [f64; 3],
    pub force_n: [f64; 3],
    /// Displacement per force [m/N]: of the pin's node alone, and of all the row.
    pub own: f64,
    pub compliance: f64,
    pub sticks: bool,
    /// Limit [N] of the friction force.
    pub limit_n: f64,
    /// Of the step before: the increment [m] relative to the target, and whether the node slipped (0 or 1).
    pub last_increment_m: [f64; 2],
    pub slipped: f64,
}

/// The nodes of the disk's top that the slave nodes of a lane can touch, column by column.
#[derive(Debug, Clone)]
pub(super) struct TargetNodes {
    pub rows: usize,
    /// The track's column of the first ones.
    pub first: isize,
    pub nodes: Vec<TargetNode>,
}

/// One of them; vectors in the pin's directions unless said otherwise.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct TargetNode {
    /// Index in the mesh, column in mesh and track, row of the track.
    pub node: usize,
    pub column: usize,
    pub row: usize,
    /// Of the angle at which the node is at t_{n+1}.
    pub cos: f64,
    pub sin: f64,
    /// Height [m] at t_n, and increment [m] of the prediction.
    pub height_m: f64,
    pub increment_m: [f64; 3],
    /// Increment [m] of the step before.
    pub last_increment_m: [f64; 3],
    pub inverse_mass: f64,
    /// Force [N] that the slave nodes receive through it.
    pub force_n: [f64; 3],
    /// Its displacement [m] under that force.
    pub displacement_m: [f64; 3],
}

impl TargetNode {
    /// A vector of the node's own directions in the pin's.
    pub fn in_pin(&self, [radial, tangential, axial]: [f64; 3]) -> [f64; 3] {
        [radial * self.cos - tangential * self.sin, radial * self.sin + tangential * self.cos, axial]
    }

    /// The force on the node in its own directions.
    fn own_force_n(&self) -> [f64; 3] {
        let [x, y, z] = self.force_n;
        [x * self.cos + y * self.sin, y * self.cos - x * self.sin, z]
    }
}

/// What solves a row by itself.
struct RowSolution {
    force_n: [f64; 3],
    limit_n: f64,
    sticks: bool,
}

impl TargetNodes {
    pub fn node(&self, share: &Share) -> &TargetNode {
        &self.nodes[share.column * self.rows + share.row]
    }

    /// Slip and gap [m] of a slave node under the forces as they stand.
    pub fn relative_m(&self, row: &ContactRow, shares: &[Share]) -> [f64; 3] {
        let mut relative: [f64; 3] = std::array::from_fn(|c| row.free_m[c] + row.own * row.force_n[c]);
        for share in shares {
            let node = self.node(share);
            for c in 0..3 {
                relative[c] += share.weight * node.displacement_m[c];
            }
        }
        relative
    }

    /// What solves a row by itself, the others as they stand.
    fn solve_row(&self, row: &ContactRow, shares: &[Share], law: Law) -> RowSolution {
        let relative = self.relative_m(row, shares);
        let stiffness = 1.0 / row.compliance;
        // A number that is not finite gives no force; the guard finds it.
        let normal = (row.force_n[2] - relative[2] * stiffness).max(0.0);
        if normal <= 0.0 {
            return RowSolution { force_n: [0.0, 0.0, normal], limit_n: 0.0, sticks: false };
        }
        let trial = [0, 1].map(|c| row.force_n[c] - relative[c] * stiffness);
        let limit_n = law.limit_n(normal, row.last_increment_m, row.slipped);
        let friction = project(trial, limit_n);
        let [x, y] = friction.force_n;
        RowSolution { force_n: [x, y, normal], limit_n, sticks: friction.sticks }
    }

    /// By how much the forces miss their own rows, over the largest force: max |f − solved(f)| / max N.
    pub fn residual<const K: usize>(&self, law: Law, rows: &[ContactRow], shares: &[[Share; K]]) -> f64 {
        let (mut missed, mut largest) = (0.0_f64, 0.0_f64);
        for (row, shares) in rows.iter().zip(shares) {
            let force = self.solve_row(row, shares, law).force_n;
            largest = largest.max(row.force_n[2]);
            for c in 0..3 {
                missed = missed.max((force[c] - row.force_n[c]).abs());
            }
        }
        if largest > 0.0 { missed / largest } else { missed }
    }

    /// Sweeps over the slave nodes until their forces stand still: how many it took, more than [`MAX_SWEEPS`] if they
    /// did not.
    pub fn sweep<const K: usize>(
        &mut self,
        body: &RingBody,
        u_scale: f64,
        law: Law,
        rows: &mut [ContactRow],
        shares: &[[Share; K]],
    ) -> u32 {
        self.spread(rows, shares);
        self.respond(body, u_scale);
        let couples_further = body.response().reach() > 0;
        for sweep in 1..=MAX_SWEEPS {
            let (mut change, mut largest) = (0.0_f64, 0.0_f64);
            for (row, shares) in rows.iter_mut().zip(shares) {
                let RowSolution { force_n: force, limit_n, sticks } = self.solve_row(row, shares, law);
                (row.sticks, row.limit_n) = (sticks, limit_n);
                largest = largest.max(force[2]);
                if force == row.force_n {
                    continue;
                }
                let delta: [f64; 3] = std::array::from_fn(|c| force[c] - row.force_n[c]);
                row.force_n = force;
                for share in shares {
                    let node = &mut self.nodes[share.column * self.rows + share.row];
                    for c in 0..3 {
                        let part = share.weight * delta[c];
                        node.force_n[c] += part;
                        node.displacement_m[c] += (u_scale * node.inverse_mass) * part;
                        change = change.max(delta[c].abs());
                    }
                }
            }
            if change <= TOLERANCE * largest {
                // Where nothing touches, nothing was solved.
                return if largest > 0.0 { sweep } else { 0 };
            }
            if couples_further {
                self.respond(body, u_scale);
            }
        }
        MAX_SWEEPS + 1
    }

    /// Spreads the slave nodes' forces over the target nodes.
    pub fn spread<const K: usize>(&mut self, rows: &[ContactRow], shares: &[[Share; K]]) {
        for node in &mut self.nodes {
            node.force_n = [0.0; 3];
        }
        for (row, shares) in rows.iter().zip(shares).filter(|(row, _)| row.force_n[2] > 0.0) {
            for share in shares {
                let node = &mut self.nodes[share.column * self.rows + share.row];
                for c in 0..3 {
                    node.force_n[c] += share.weight * row.force_n[c];
                }
            }
        }
    }

    /// cΔt² C f at the target nodes.
    pub fn respond(&mut self, body: &RingBody, u_scale: f64) {
        for node in &mut self.nodes {
            // In the node's own directions at first.
            node.displacement_m = [0.0; 3];
        }
        let reach = body.response().reach() as isize;
        let (columns, rows) = ((self.nodes.len() / self.rows) as isize, self.rows as isize);
        for at in 0..self.nodes.len() {
            let source = self.nodes[at];
            if source.force_n == [0.0; 3] {
                continue;
            }
            let force = source.own_force_n();
            let (column, row) = (at as isize / rows, at as isize % rows);
            let top = body.response().of(source.column, source.row);
            let line = 2 * reach + 1;
            for r in -row.min(reach)..=reach.min(rows - 1 - row) {
                for c in -column.min(reach)..=reach.min(columns - 1 - column) {
                    let way = times(&top[((r + reach) * line + c + reach) as usize], force);
                    let node = &mut self.nodes[((column + c) * rows + row + r) as usize];
                    for i in 0..3 {
                        node.displacement_m[i] += way[i];
                    }
                }
            }
        }
        for node in &mut self.nodes {
            node.displacement_m = node.in_pin(node.displacement_m.map(|way| u_scale * way));
        }
    }

    /// The forces on the disk that balance those on the pin.
    pub fn reactions(&self) -> impl Iterator<Item = TrackForce> + '_ {
        let loaded = self.nodes.iter().filter(|node| node.force_n != [0.0; 3]);
        loaded.map(|node| TrackForce {
            node: node.node,
            column: node.column,
            row: node.row,
            force_n: node.own_force_n().map(|force| -force),
        })
    }
}

//! Gauss–Seidel sweeps over the constraint rows of one lane.
//!
//! Each row is solved by itself: first the normal force, then the projection on its friction cone. The change of
//! its force is passed on to the rows that share its target nodes. Within a sweep this uses M⁻¹, the upper bound of
//! the disk's response C = B M⁻¹. After the sweep C itself is applied. So the couplings are exact if the disk makes
//! one stage. With several stages the sweeps contract.

use crate::solver::body::ring::{RingBody, TrackForce, times};
use crate::solver::interface::law::{AtNode, Law, project};
use crate::solver::interface::target::patch::Share;
use crate::solver::lane::next;

/// Convergence tolerance: largest change of a nodal force in the last sweep, relative to the largest nodal force.
pub const TOLERANCE: f64 = 1.0e-10;

/// Number of sweeps after which a solve has failed. The reference scene needs six.
pub const MAX_SWEEPS: u32 = 500;

/// Convergence statistics of the contact solves of a lane.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Solves {
    /// Number of sweeps of all steps.
    pub sweeps: f64,
    /// Largest number of sweeps in one step.
    pub most_sweeps: f64,
    /// Largest residual of the forces, relative to the largest force.
    pub residual: f64,
    /// First step whose solve did not converge, counted from 1; 0 if there is none.
    pub failed_step: f64,
}

impl Solves {
    /// Adds the solve of a step. Steps are counted from 1.
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

/// Constraint row of a slave node during the solve of one lane. Vectors are in the pin's directions.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ContactRow {
    /// Slip in x and y, and gap \[m\], of the prediction.
    pub free_m: [f64; 3],
    pub force_n: [f64; 3],
    /// Compliance \[m/N\] (displacement per force) of the pin's node alone.
    pub own: f64,
    /// Compliance \[m/N\] of the whole row.
    pub compliance: f64,
    pub sticks: bool,
    /// Limit \[N\] of the friction force.
    pub limit_n: f64,
    /// Increment \[m\] relative to the target over the step before.
    pub last_increment_m: [f64; 2],
    /// Whether the node slipped in the step before (0 or 1).
    pub slipped: f64,
    /// Limit \[N\] of the friction force in the step before.
    pub last_limit_n: f64,
}

/// The nodes of the disk's top face that the slave nodes of a lane can touch, column by column.
#[derive(Debug, Clone)]
pub(super) struct TargetNodes {
    pub rows: usize,
    /// Column of the track at which `nodes` begins.
    pub first: isize,
    pub nodes: Vec<TargetNode>,
}

/// A node of the disk's top face. Vectors are in the pin's directions unless stated otherwise.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct TargetNode {
    /// Index in the mesh.
    pub node: usize,
    /// Column in the mesh, which is that in the track.
    pub column: usize,
    /// Row in the track.
    pub row: usize,
    /// Cosine of the node's angle at t_{n+1}.
    pub cos: f64,
    /// Sine of that angle.
    pub sin: f64,
    /// Displacement in z \[m\] at t_n.
    pub height_m: f64,
    /// Increment \[m\] of the prediction.
    pub increment_m: [f64; 3],
    /// Increment \[m\] of the step before.
    pub last_increment_m: [f64; 3],
    pub inverse_mass: f64,
    /// Contact force \[N\] that the slave nodes receive through this node.
    pub force_n: [f64; 3],
    /// Response cΔt² C f \[m\] to that force. The node itself moves by minus this.
    pub displacement_m: [f64; 3],
}

impl TargetNode {
    /// Transforms a vector from the node's own directions (radial, tangential, axial) to the pin's.
    pub fn in_pin(&self, [radial, tangential, axial]: [f64; 3]) -> [f64; 3] {
        [radial * self.cos - tangential * self.sin, radial * self.sin + tangential * self.cos, axial]
    }

    /// `force_n` in the node's own directions.
    fn own_force_n(&self) -> [f64; 3] {
        let [x, y, z] = self.force_n;
        [x * self.cos + y * self.sin, y * self.cos - x * self.sin, z]
    }
}

/// A law, and the time step \[s\].
pub(super) type LawInStep<'a> = (&'a Law, f64);

/// Solution of one row while all other forces stay fixed.
struct RowSolution {
    force_n: [f64; 3],
    limit_n: f64,
    sticks: bool,
}

impl TargetNodes {
    pub fn node(&self, share: &Share) -> &TargetNode {
        &self.nodes[share.column * self.rows + share.row]
    }

    /// Slip and gap \[m\] of a slave node under the current forces.
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

    /// Solves one row while all other forces stay fixed.
    fn solve_row(
        &self,
        row: &ContactRow,
        shares: &[Share],
        (law, time_step_s): LawInStep<'_>,
    ) -> RowSolution {
        let relative = self.relative_m(row, shares);
        let stiffness = 1.0 / row.compliance;
        // NaN gives no force here; the guard detects it.
        let normal = (row.force_n[2] - relative[2] * stiffness).max(0.0);
        if normal <= 0.0 {
            return RowSolution { force_n: [0.0, 0.0, normal], limit_n: 0.0, sticks: false };
        }
        let trial = [0, 1].map(|c| row.force_n[c] - relative[c] * stiffness);
        let at_node = AtNode {
            normal_n: normal,
            trial_n: trial,
            stiffness_n_m: stiffness,
            last_increment_m: row.last_increment_m,
            last_slipped: row.slipped,
            last_limit_n: row.last_limit_n,
        };
        let limit_n = law.limit_n(&at_node, time_step_s);
        let friction = project(trial, limit_n);
        let [x, y] = friction.force_n;
        RowSolution { force_n: [x, y, normal], limit_n, sticks: friction.sticks }
    }

    /// Residual of the current forces, relative to the largest force: max |f − solved(f)| / max N.
    pub fn residual<const K: usize>(
        &self,
        law: LawInStep<'_>,
        rows: &[ContactRow],
        shares: &[[Share; K]],
    ) -> f64 {
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

    /// Sweeps over the slave nodes until their forces converge. Returns the number of sweeps, or [`MAX_SWEEPS`] + 1
    /// if they do not converge. `u_scale` is cΔt² \[s²\].
    pub fn sweep<const K: usize>(
        &mut self,
        body: &RingBody,
        u_scale: f64,
        law: LawInStep<'_>,
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
                // Without contact the solve counts no sweep.
                return if largest > 0.0 { sweep } else { 0 };
            }
            if couples_further {
                self.respond(body, u_scale);
            }
        }
        MAX_SWEEPS + 1
    }

    /// Distributes the slave nodes' forces over the target nodes.
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

    /// Computes the response cΔt² C f of the target nodes; `u_scale` is cΔt² \[s²\].
    pub fn respond(&mut self, body: &RingBody, u_scale: f64) {
        for node in &mut self.nodes {
            // During the sum the displacement is in the node's own directions.
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

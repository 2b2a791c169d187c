//! Stored energies of a block and the work of its damping at one time t_n.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::BlockBody;
use super::line_table::LineTable;
use super::operator::Scratch;
use crate::solver::body::{EnergySums, add_lanes};
use crate::solver::field::{Field, Row, WIDTH, add_slots, in_slots};
use crate::solver::lane::LaneState;
use crate::solver::scheme::Scheme;
use crate::solver::simd::dispatch;
use fearless_simd::{Simd, f64x8, prelude::*};

/// Displacements \[m\] and p \[m/s\] of a block at one time, and the number of steps that each lane has done.
#[derive(Clone, Copy)]
pub(in crate::solver) struct Motion<'a, const L: usize> {
    pub u: &'a Field<L>,
    pub p: &'a Field<L>,
    pub steps_done: &'a [u64; L],
}

/// Evaluates the energies of a block. It stores values from before the audited step.
#[derive(Debug, Clone)]
pub(in crate::solver) struct BlockAudit<const L: usize> {
    mass: LineTable<L>,
    p: Field<L>,
    /// K p.
    kp: Field<L>,
    scratch: Scratch<L>,
    /// ½uKu before the step.
    elastic_j: [f64; L],
    /// Work of damping over the increment before t_n.
    damping_before_j: [f64; L],
    /// Sums of the columns of blocks.
    columns: Vec<[Row; SUMS]>,
    /// Present for β₂ > ½ only.
    jumps: Option<Jumps<L>>,
}

/// The additional fields for β₂ > ½.
#[derive(Debug, Clone)]
struct Jumps<const L: usize> {
    /// Displacements before the step. With β₂ = 1 the first step does not change p, so its acceleration follows
    /// from the displacements alone.
    u: Field<L>,
    acceleration: Field<L>,
    previous_acceleration: Field<L>,
    /// Increment of the displacements over the step before.
    increment: Field<L>,
}

/// Number of sums: kinetic energy, work of damping after t_n, and ΔaMΔa.
const SUMS: usize = 3;
const KINETIC: usize = 0;
const DAMPING_AFTER: usize = 1;
const INERTIAL_JUMP: usize = 2;

impl<const L: usize> BlockAudit<L> {
    pub fn new(block: &BlockBody, beta2: f64) -> Self {
        let field = || Field::<L>::zeros(block.mesh().layout());
        let jumps = (beta2 > 0.5).then(|| Jumps {
            u: field(),
            acceleration: field(),
            previous_acceleration: field(),
            increment: field(),
        });
        Self {
            mass: LineTable::new(block.mesh(), |node| block.masses_kg()[node]),
            p: field(),
            kp: field(),
            scratch: Scratch::new(block.mesh()),
            elastic_j: [0.0; L],
            damping_before_j: [0.0; L],
            columns: vec![[Row::default(); SUMS]; field().blocks_per_line()],
            jumps,
        }
    }

    /// Stores the state before the step.
    pub fn keep(&mut self, before: &Motion<'_, L>) {
        self.p.clone_from(before.p);
        if let Some(jumps) = &mut self.jumps {
            jumps.u.clone_from(before.u);
        }
    }

    /// Evaluates uKu and pKp before the step.
    pub fn begin(&mut self, block: &BlockBody, scheme: &Scheme, before: &Motion<'_, L>) {
        let (operator, dt, beta_r) = (block.operator(), scheme.time_step_s, scheme.beta_r_s);
        // K p overwrites K u below.
        self.elastic_j = operator.product(before.u, &mut self.kp, &mut self.scratch).map(|form| 0.5 * form);
        if beta_r == 0.0 {
            return;
        }
        let form = operator.product(before.p, &mut self.kp, &mut self.scratch);
        self.damping_before_j = form.map(|form| beta_r * dt * form);
        if let Some(jumps) = &self.jumps {
            // Δu of the step before is Δt p + (γ−½) Δt² a.
            let factor = beta_r * (scheme.beta2 - 0.5) * dt * dt;
            let form = jumps.previous_acceleration.dot(&self.kp);
            for lane in 0..L {
                self.damping_before_j[lane] += factor * form[lane];
            }
        }
    }

    /// Computes `a_n` from the displacements of the step, contact forces included. It is needed for β₂ > ½.
    pub fn find_acceleration(&mut self, scheme: &Scheme, after: &Motion<'_, L>) {
        let Some(jumps) = &mut self.jumps else { return };
        let dt = scheme.time_step_s;
        let scale = in_slots(&u_scales(scheme, after).map(|scale| 1.0 / scale));
        let after = after.u.blocks().iter().zip(jumps.u.blocks()).zip(self.p.blocks());
        for (a, ((after, u), p)) in jumps.acceleration.blocks_mut().iter_mut().zip(after) {
            for c in 0..3 {
                for i in 0..WIDTH {
                    a.0[c][i] = (after.0[c][i] - u.0[c][i] - dt * p.0[c][i]) * scale[i];
                }
            }
        }
    }

    /// Ends the step: its acceleration becomes the previous one.
    pub fn end(&mut self) {
        if let Some(jumps) = &mut self.jumps {
            std::mem::swap(&mut jumps.acceleration, &mut jumps.previous_acceleration);
        }
    }

    /// Adds the energies at `t_n`, the time before the step.
    pub fn add_to(
        &mut self,
        total: &mut EnergySums<L>,
        block: &BlockBody,
        scheme: &Scheme,
        after: &Motion<'_, L>,
    ) {
        dispatch!(simd => self.add_up(simd, block, scheme, after));
        let mut sums = [[0.0; L]; SUMS];
        for column in &self.columns {
            for (sum, slots) in sums.iter_mut().zip(column) {
                add_slots(sum, &slots.0);
            }
        }
        let numerical_j = self.numerical_loss(block, scheme, &sums[INERTIAL_JUMP]);
        add_lanes(&mut total.kinetic_j, &sums[KINETIC]);
        add_lanes(&mut total.elastic_j, &self.elastic_j);
        add_lanes(&mut total.damping_after_j, &sums[DAMPING_AFTER]);
        add_lanes(&mut total.damping_before_j, &self.damping_before_j);
        add_lanes(&mut total.numerical_j, &numerical_j);
    }

    /// Forms the sums over all nodes that need the state after the step.
    #[inline(always)]
    fn add_up<S: Simd>(&mut self, simd: S, block: &BlockBody, scheme: &Scheme, after: &Motion<'_, L>) {
        let [_, my, mz] = block.mesh().nodes_per_axis();
        let (dt, gamma) = (scheme.time_step_s, scheme.beta2);
        let damps = scheme.beta_r_s > 0.0;
        let begins = after.steps_done.map(|steps| steps == 1);
        let gain = in_slots(&begins.map(|begins| if begins { 0.0 } else { gamma * dt }));
        let per_p = in_slots(&begins.map(|begins| 1.0 / (scheme.factors(begins).1 * dt)));
        let u_scale = in_slots(&u_scales(scheme, after));
        let (gain, per_p) = (f64x8::from_slice(simd, &gain), f64x8::from_slice(simd, &per_p));
        let u_scale = f64x8::from_slice(simd, &u_scale);
        let half = f64x8::splat(simd, 0.5);
        let beta_r = f64x8::splat(simd, scheme.beta_r_s);
        let of_a2 = f64x8::splat(simd, 0.5 * gamma * dt * dt);
        let dt = f64x8::splat(simd, dt);
        let zero = f64x8::splat(simd, 0.0);
        let blocks = self.columns.len();
        self.columns.fill([Row::default(); SUMS]);
        for k in 0..mz {
            for along in 0..blocks {
                let mut sums = [zero; SUMS];
                for j in 0..my {
                    let line = j + my * k;
                    let at = line * blocks + along;
                    let half_mass = half * f64x8::from_slice(simd, self.mass.row(line, along));
                    for c in 0..3 {
                        let p = load(simd, &self.p, at, c);
                        let a = match &self.jumps {
                            None => (load(simd, after.p, at, c) - p) * per_p,
                            Some(jumps) => load(simd, &jumps.acceleration, at, c),
                        };
                        let v = p + gain * a;
                        sums[KINETIC] += half_mass * (v * v - of_a2 * (a * a));
                        if damps {
                            let stroke = dt * p + u_scale * a;
                            sums[DAMPING_AFTER] += (beta_r * load(simd, &self.kp, at, c)) * stroke;
                        }
                        if let Some(jumps) = &self.jumps {
                            let jump = a - load(simd, &jumps.previous_acceleration, at, c);
                            sums[INERTIAL_JUMP] += (half_mass + half_mass) * (jump * jump);
                        }
                    }
                }
                for (total, sum) in self.columns[along].iter_mut().zip(sums) {
                    (f64x8::from_slice(simd, &total.0) + sum).store_slice(&mut total.0);
                }
            }
        }
    }

    /// (γ−½)\[ΔuKΔu − ½γΔt² ΔaMΔa\] \[J\] of the step before `t_n`. It overwrites K p, which is no longer needed.
    fn numerical_loss(&mut self, block: &BlockBody, scheme: &Scheme, inertial_jump_j: &[f64; L]) -> [f64; L] {
        let Some(jumps) = &mut self.jumps else { return [0.0; L] };
        let (dt, gamma) = (scheme.time_step_s, scheme.beta2);
        let before = self.p.blocks().iter().zip(jumps.previous_acceleration.blocks());
        for (increment, (p, a)) in jumps.increment.blocks_mut().iter_mut().zip(before) {
            for c in 0..3 {
                for i in 0..WIDTH {
                    increment.0[c][i] = dt * p.0[c][i] + (gamma - 0.5) * dt * dt * a.0[c][i];
                }
            }
        }
        let elastic_jump_j = block.operator().product(&jumps.increment, &mut self.kp, &mut self.scratch);
        std::array::from_fn(|lane| {
            (gamma - 0.5) * (elastic_jump_j[lane] - 0.5 * gamma * dt * dt * inertial_jump_j[lane])
        })
    }
}

/// Only the acceleration of the step before is carried from step to step.
impl<const L: usize> LaneState for BlockAudit<L> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        if let Some(jumps) = &self.jumps {
            jumps.previous_acceleration.save_lane(lane, saved);
        }
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        if let Some(jumps) = &mut self.jumps {
            jumps.previous_acceleration.load_lane(lane, saved);
        }
    }
}

/// Factor \[s²\] of a in the displacements of the step that each lane has just done.
fn u_scales<const L: usize>(scheme: &Scheme, after: &Motion<'_, L>) -> [f64; L] {
    let dt = scheme.time_step_s;
    after.steps_done.map(|steps| scheme.factors(steps == 1).0 * dt * dt)
}

#[inline(always)]
fn load<S: Simd, const L: usize>(simd: S, field: &Field<L>, at: usize, component: usize) -> f64x8<S> {
    f64x8::from_slice(simd, &field.blocks()[at].0[component])
}

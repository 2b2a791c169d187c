//! Stored energies and the work of damping at one time t_n.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use crate::solver::field::{Field, Row, WIDTH, add_slots, in_slots};
use crate::solver::line_table::LineTable;
use crate::solver::model::Model;
use crate::solver::operator::Scratch;
use crate::solver::state::State;
use crate::solver::step::factors;
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// Fields kept from before the step, and products with K.
#[derive(Debug, Clone)]
pub(super) struct Audit<const L: usize> {
    mass: LineTable<L>,
    u: Field<L>,
    p: Field<L>,
    acceleration: Field<L>,
    previous_acceleration: Field<L>,
    ku: Field<L>,
    kp: Field<L>,
    scratch: Scratch<L>,
    /// Sums of a column of blocks.
    columns: Vec<[Row; SUMS]>,
}

/// Kinetic, elastic, damping after and before t_n, and ΔaMΔa.
const SUMS: usize = 5;

/// What an audit finds [J].
#[derive(Debug, Clone, Copy)]
#[expect(clippy::struct_field_names, reason = "units are part of the names")]
pub(super) struct Found<const L: usize> {
    pub kinetic_j: [f64; L],
    pub elastic_j: [f64; L],
    /// Work of damping over the increment after t_n, and over the one before it.
    pub damping_after_j: [f64; L],
    pub damping_before_j: [f64; L],
    /// What β₂ > ½ dissipates in the step before t_n.
    pub numerical_j: [f64; L],
}

impl<const L: usize> Audit<L> {
    pub fn new(model: &Model) -> Self {
        let field = || Field::<L>::zeros(model.mesh());
        Self {
            mass: LineTable::new(model.mesh(), |node| model.masses_kg()[node]),
            u: field(),
            p: field(),
            acceleration: field(),
            previous_acceleration: field(),
            ku: field(),
            kp: field(),
            scratch: Scratch::new(model.mesh()),
            columns: vec![[Row::default(); SUMS]; field().blocks_per_line()],
        }
    }

    /// Sets a lane to a lane of another audit. Between audits only the acceleration is kept.
    pub fn copy_lane<const M: usize>(&mut self, lane: usize, from: &Audit<M>, from_lane: usize) {
        self.previous_acceleration.copy_lane(lane, &from.previous_acceleration, from_lane);
    }

    /// Keeps the state before the step.
    pub fn keep(&mut self, state: &State<L>) {
        self.u.clone_from(&state.u);
        self.p.clone_from(&state.p);
    }

    /// `a_n` from the step's displacements, contact forces included.
    pub fn find_acceleration(&mut self, model: &Model, state: &State<L>) {
        dispatch!(Level::new(), simd => self.find_acceleration_in(simd, model, state));
    }

    #[inline(always)]
    fn find_acceleration_in<S: Simd>(&mut self, simd: S, model: &Model, state: &State<L>) {
        let dt = model.time_step_s();
        let scale: [f64; L] = std::array::from_fn(|lane| {
            let (u_factor, _) = factors(model.beta2(), state.steps_done(lane) - 1);
            1.0 / (u_factor * dt * dt)
        });
        let scale = f64x8::from_slice(simd, &in_slots(&scale));
        let dt = f64x8::splat(simd, dt);
        let after = state.u.blocks().iter().zip(self.u.blocks()).zip(self.p.blocks());
        for (a, ((after, u), p)) in self.acceleration.blocks_mut().iter_mut().zip(after) {
            for c in 0..3 {
                let increment = f64x8::from_slice(simd, &after.0[c]) - f64x8::from_slice(simd, &u.0[c]);
                ((increment - dt * f64x8::from_slice(simd, &p.0[c])) * scale).store_slice(&mut a.0[c]);
            }
        }
    }

    /// Ends the step: its acceleration becomes that of the step before.
    pub fn end(&mut self) {
        std::mem::swap(&mut self.acceleration, &mut self.previous_acceleration);
    }

    /// Evaluates the energies at `t_n`, the time before the step.
    pub fn evaluate(&mut self, model: &Model, state: &State<L>) -> Found<L> {
        model.operator().product(&self.u, &mut self.ku, &mut self.scratch);
        if model.beta_r_s() > 0.0 {
            model.operator().product(&self.p, &mut self.kp, &mut self.scratch);
        }
        dispatch!(Level::new(), simd => self.add_up(simd, model, state));
        let mut sums = [[0.0; L]; SUMS];
        for column in &self.columns {
            for (sum, slots) in sums.iter_mut().zip(column) {
                add_slots(sum, &slots.0);
            }
        }
        let [kinetic_j, elastic_j, damping_after_j, damping_before_j, inertial_jump_j] = sums;
        let (dt, gamma) = (model.time_step_s(), model.beta2());
        let mut numerical_j = [0.0; L];
        if gamma > 0.5 {
            let elastic_jump_j = self.elastic_jump(model);
            for l in 0..L {
                numerical_j[l] =
                    (gamma - 0.5) * (elastic_jump_j[l] - 0.5 * gamma * dt * dt * inertial_jump_j[l]);
            }
        }
        Found { kinetic_j, elastic_j, damping_after_j, damping_before_j, numerical_j }
    }

    /// The sums over all nodes, by columns.
    #[inline(always)]
    fn add_up<S: Simd>(&mut self, simd: S, model: &Model, state: &State<L>) {
        let [_, my, mz] = model.mesh().nodes_per_axis();
        let (dt, gamma) = (model.time_step_s(), model.beta2());
        let (damps, jumps) = (model.beta_r_s() > 0.0, gamma > 0.5);
        let gain: [f64; L] =
            std::array::from_fn(|lane| if state.steps_done(lane) == 1 { 0.0 } else { gamma * dt });
        let gain = f64x8::from_slice(simd, &in_slots(&gain));
        let half = f64x8::splat(simd, 0.5);
        let beta_r = f64x8::splat(simd, model.beta_r_s());
        let of_a2 = f64x8::splat(simd, 0.5 * gamma * dt * dt);
        let of_p = f64x8::splat(simd, dt);
        let of_a = f64x8::splat(simd, (gamma - 0.5) * dt * dt);
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
                        let u = load(simd, &self.u, at, c);
                        let p = load(simd, &self.p, at, c);
                        let a = load(simd, &self.acceleration, at, c);
                        let v = p + gain * a;
                        sums[0] += half_mass * (v * v - of_a2 * (a * a));
                        sums[1] += half * (u * load(simd, &self.ku, at, c));
                        if damps {
                            let force = beta_r * load(simd, &self.kp, at, c);
                            sums[2] += force * (load(simd, &state.u, at, c) - u);
                            let mut increment = of_p * p;
                            if jumps {
                                let before = load(simd, &self.previous_acceleration, at, c);
                                increment += of_a * before;
                            }
                            sums[3] += force * increment;
                        }
                        if jumps {
                            let jump = a - load(simd, &self.previous_acceleration, at, c);
                            sums[4] += (half_mass + half_mass) * (jump * jump);
                        }
                    }
                }
                for (total, sum) in self.columns[along].iter_mut().zip(sums) {
                    (f64x8::from_slice(simd, &total.0) + sum).store_slice(&mut total.0);
                }
            }
        }
    }

    /// ΔuKΔu of the step before `t_n`; overwrites the products, which are no longer needed.
    fn elastic_jump(&mut self, model: &Model) -> [f64; L] {
        let (dt, gamma) = (model.time_step_s(), model.beta2());
        let before = self.p.blocks().iter().zip(self.previous_acceleration.blocks());
        for (increment, (p, a)) in self.ku.blocks_mut().iter_mut().zip(before) {
            for c in 0..3 {
                for i in 0..WIDTH {
                    increment.0[c][i] = dt * p.0[c][i] + (gamma - 0.5) * dt * dt * a.0[c][i];
                }
            }
        }
        model.operator().product(&self.ku, &mut self.kp, &mut self.scratch);
        dispatch!(Level::new(), simd => dot(simd, &self.ku, &self.kp))
    }
}

/// The product of two fields, by columns like all sums over nodes.
#[inline(always)]
fn dot<S: Simd, const L: usize>(simd: S, a: &Field<L>, b: &Field<L>) -> [f64; L] {
    let blocks = a.blocks_per_line();
    let mut product = [0.0; L];
    for along in 0..blocks {
        let mut sum = f64x8::splat(simd, 0.0);
        for at in (along..a.blocks().len()).step_by(blocks) {
            for c in 0..3 {
                sum += load(simd, a, at, c) * load(simd, b, at, c);
            }
        }
        let mut slots = [0.0; WIDTH];
        sum.store_slice(&mut slots);
        add_slots(&mut product, &slots);
    }
    product
}

#[inline(always)]
fn load<S: Simd, const L: usize>(simd: S, field: &Field<L>, at: usize, component: usize) -> f64x8<S> {
    f64x8::from_slice(simd, &field.blocks()[at].0[component])
}

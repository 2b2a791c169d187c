//! Stored energies and the work of damping at one time t_n.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use crate::solver::field::{Block, Field, Row, WIDTH, add_slots, in_slots};
use crate::solver::line_table::LineTable;
use crate::solver::model::Model;
use crate::solver::operator::{Operator, Pass, Scratch, Spot, load_all};
use crate::solver::state::State;
use crate::solver::step::factors;
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// What is kept from before the step, and what belongs to the step before.
#[derive(Debug, Clone)]
pub(super) struct Audit<const L: usize> {
    mass: LineTable<L>,
    p: Field<L>,
    /// K p.
    kp: Field<L>,
    scratch: Scratch<L>,
    /// Sums of the columns of blocks, in the order of [`Found`].
    columns: Vec<[Row; SUMS]>,
    /// For β₂ > ½.
    jumps: Option<Jumps<L>>,
}

/// What β₂ > ½ takes into account besides.
#[derive(Debug, Clone)]
struct Jumps<const L: usize> {
    /// Displacements before the step: with β₂ = 1 the first step tells its acceleration by nothing else.
    u: Field<L>,
    acceleration: Field<L>,
    previous_acceleration: Field<L>,
    /// Increment of the displacements over the step before.
    increment: Field<L>,
}

/// Kinetic, elastic, damping after and before t_n, and ΔaMΔa.
const SUMS: usize = 5;
const KINETIC: usize = 0;
const ELASTIC: usize = 1;
const DAMPING_AFTER: usize = 2;
const DAMPING_BEFORE: usize = 3;
const INERTIAL_JUMP: usize = 4;

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
        let jumps = (model.beta2() > 0.5).then(|| Jumps {
            u: field(),
            acceleration: field(),
            previous_acceleration: field(),
            increment: field(),
        });
        Self {
            mass: LineTable::new(model.mesh(), |node| model.masses_kg()[node]),
            p: field(),
            kp: field(),
            scratch: Scratch::new(model.mesh()),
            columns: vec![[Row::default(); SUMS]; field().blocks_per_line()],
            jumps,
        }
    }

    /// Sets a lane to a lane of another audit. Between audits only the acceleration is kept.
    pub fn copy_lane<const M: usize>(&mut self, lane: usize, from: &Audit<M>, from_lane: usize) {
        if let (Some(jumps), Some(from)) = (&mut self.jumps, &from.jumps) {
            jumps.previous_acceleration.copy_lane(lane, &from.previous_acceleration, from_lane);
        }
    }

    /// Keeps the state before the step.
    pub fn keep(&mut self, state: &State<L>) {
        self.p.clone_from(&state.p);
        if let Some(jumps) = &mut self.jumps {
            jumps.u.clone_from(&state.u);
        }
    }

    /// Sums over the state before the step: what u and p do against K.
    pub fn begin(&mut self, model: &Model, state: &State<L>) {
        self.columns.fill([Row::default(); SUMS]);
        let columns = &mut self.columns;
        match model.operator() {
            Operator::Tensor(operator) => {
                let (x, factor) = (state.u.blocks(), 0.5);
                let mut elastic = Dot::<false> { x, kx: &mut [], columns, sum: ELASTIC, factor };
                dispatch!(Level::new(), simd => operator.pass(simd, &mut elastic, &mut self.scratch));
                if model.beta_r_s() > 0.0 {
                    let factor = model.beta_r_s() * model.time_step_s();
                    let (x, kx) = (state.p.blocks(), self.kp.blocks_mut());
                    let mut damping = Dot::<true> { x, kx, columns, sum: DAMPING_BEFORE, factor };
                    dispatch!(Level::new(), simd => operator.pass(simd, &mut damping, &mut self.scratch));
                }
            }
            Operator::Assembled(operator) => {
                operator.product(&state.u, &mut self.kp);
                add_columns(columns, ELASTIC, 0.5, &state.u, &self.kp);
                operator.product(&state.p, &mut self.kp);
                let factor = model.beta_r_s() * model.time_step_s();
                add_columns(columns, DAMPING_BEFORE, factor, &state.p, &self.kp);
            }
        }
        if let Some(jumps) = &self.jumps {
            // Δu of the step before is Δt p + (γ−½) Δt² a.
            let factor = model.beta_r_s() * (model.beta2() - 0.5) * model.time_step_s().powi(2);
            add_columns(columns, DAMPING_BEFORE, factor, &jumps.previous_acceleration, &self.kp);
        }
    }

    /// `a_n` from the step's displacements, contact forces included, for β₂ > ½.
    pub fn find_acceleration(&mut self, model: &Model, state: &State<L>) {
        let Some(jumps) = &mut self.jumps else { return };
        let dt = model.time_step_s();
        let scale = in_slots(&u_scales(model, state).map(|scale| 1.0 / scale));
        let after = state.u.blocks().iter().zip(jumps.u.blocks()).zip(self.p.blocks());
        for (a, ((after, u), p)) in jumps.acceleration.blocks_mut().iter_mut().zip(after) {
            for c in 0..3 {
                for i in 0..WIDTH {
                    a.0[c][i] = (after.0[c][i] - u.0[c][i] - dt * p.0[c][i]) * scale[i];
                }
            }
        }
    }

    /// Ends the step: its acceleration becomes that of the step before.
    pub fn end(&mut self) {
        if let Some(jumps) = &mut self.jumps {
            std::mem::swap(&mut jumps.acceleration, &mut jumps.previous_acceleration);
        }
    }

    /// Evaluates the energies at `t_n`, the time before the step.
    pub fn evaluate(&mut self, model: &Model, state: &State<L>) -> Found<L> {
        dispatch!(Level::new(), simd => self.add_up(simd, model, state));
        let mut sums = [[0.0; L]; SUMS];
        for column in &self.columns {
            for (sum, slots) in sums.iter_mut().zip(column) {
                add_slots(sum, &slots.0);
            }
        }
        let numerical_j = self.numerical_loss(model, &sums[INERTIAL_JUMP]);
        let [kinetic_j, elastic_j, damping_after_j, damping_before_j, _] = sums;
        Found { kinetic_j, elastic_j, damping_after_j, damping_before_j, numerical_j }
    }

    /// The sums over all nodes that need the state after the step.
    #[inline(always)]
    fn add_up<S: Simd>(&mut self, simd: S, model: &Model, state: &State<L>) {
        let [_, my, mz] = model.mesh().nodes_per_axis();
        let (dt, gamma) = (model.time_step_s(), model.beta2());
        let damps = model.beta_r_s() > 0.0;
        let begins: [bool; L] = std::array::from_fn(|lane| state.steps_done(lane) == 1);
        let gain = in_slots(&begins.map(|begins| if begins { 0.0 } else { gamma * dt }));
        let per_p = in_slots(&begins.map(|begins| 1.0 / (factors(gamma, u64::from(!begins)).1 * dt)));
        let u_scale = in_slots(&u_scales(model, state));
        let (gain, per_p) = (f64x8::from_slice(simd, &gain), f64x8::from_slice(simd, &per_p));
        let u_scale = f64x8::from_slice(simd, &u_scale);
        let half = f64x8::splat(simd, 0.5);
        let beta_r = f64x8::splat(simd, model.beta_r_s());
        let of_a2 = f64x8::splat(simd, 0.5 * gamma * dt * dt);
        let dt = f64x8::splat(simd, dt);
        let zero = f64x8::splat(simd, 0.0);
        let blocks = self.columns.len();
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
                            None => (load(simd, &state.p, at, c) - p) * per_p,
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

    /// (γ−½)[ΔuKΔu − ½γΔt² ΔaMΔa] of the step before `t_n`; overwrites K p, which is no longer needed.
    fn numerical_loss(&mut self, model: &Model, inertial_jump_j: &[f64; L]) -> [f64; L] {
        let Some(jumps) = &mut self.jumps else { return [0.0; L] };
        let (dt, gamma) = (model.time_step_s(), model.beta2());
        let before = self.p.blocks().iter().zip(jumps.previous_acceleration.blocks());
        for (increment, (p, a)) in jumps.increment.blocks_mut().iter_mut().zip(before) {
            for c in 0..3 {
                for i in 0..WIDTH {
                    increment.0[c][i] = dt * p.0[c][i] + (gamma - 0.5) * dt * dt * a.0[c][i];
                }
            }
        }
        model.operator().product(&jumps.increment, &mut self.kp, &mut self.scratch);
        self.columns.fill([Row::default(); SUMS]);
        add_columns(&mut self.columns, ELASTIC, 1.0, &jumps.increment, &self.kp);
        let mut elastic_jump_j = [0.0; L];
        for column in &self.columns {
            add_slots(&mut elastic_jump_j, &column[ELASTIC].0);
        }
        std::array::from_fn(|lane| {
            (gamma - 0.5) * (elastic_jump_j[lane] - 0.5 * gamma * dt * dt * inertial_jump_j[lane])
        })
    }
}

/// The factor of a in the displacements of the step that every lane has just done [s²].
fn u_scales<const L: usize>(model: &Model, state: &State<L>) -> [f64; L] {
    let dt = model.time_step_s();
    std::array::from_fn(|lane| factors(model.beta2(), state.steps_done(lane) - 1).0 * dt * dt)
}

/// factor · x·Kx, added up by columns as the product passes; keeps K x if asked to.
struct Dot<'a, const KEEPS: bool> {
    x: &'a [Block],
    kx: &'a mut [Block],
    columns: &'a mut [[Row; SUMS]],
    sum: usize,
    factor: f64,
}

impl<S: Simd, const KEEPS: bool> Pass<S> for Dot<'_, KEEPS> {
    #[inline(always)]
    fn input(&self, simd: S, at: usize) -> [f64x8<S>; 3] {
        load_all(simd, &self.x[at].0)
    }

    #[inline(always)]
    fn output(&mut self, simd: S, spot: Spot, kx: [f64x8<S>; 3]) {
        let x = load_all(simd, &self.x[spot.at].0);
        let product = x[0] * kx[0] + x[1] * kx[1] + x[2] * kx[2];
        let total = &mut self.columns[spot.along][self.sum].0;
        (f64x8::from_slice(simd, total) + f64x8::splat(simd, self.factor) * product).store_slice(total);
        if KEEPS {
            for c in 0..3 {
                kx[c].store_slice(&mut self.kx[spot.at].0[c]);
            }
        }
    }
}

/// Adds factor · a·b to a sum, by columns.
fn add_columns<const L: usize>(
    columns: &mut [[Row; SUMS]],
    sum: usize,
    factor: f64,
    a: &Field<L>,
    b: &Field<L>,
) {
    let blocks = a.blocks_per_line();
    for (at, (a, b)) in a.blocks().iter().zip(b.blocks()).enumerate() {
        let total = &mut columns[at % blocks][sum].0;
        for i in 0..WIDTH {
            total[i] += factor * (a.0[0][i] * b.0[0][i] + a.0[1][i] * b.0[1][i] + a.0[2][i] * b.0[2][i]);
        }
    }
}

#[inline(always)]
fn load<S: Simd, const L: usize>(simd: S, field: &Field<L>, at: usize, component: usize) -> f64x8<S> {
    f64x8::from_slice(simd, &field.blocks()[at].0[component])
}

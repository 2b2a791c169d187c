//! Stored energies of a block and the work of its damping at one time t_n.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use super::PinBody;
use super::line_table::LineTable;
use super::operator::Scratch;
use crate::solver::body::{EnergySums, add_lanes};
use crate::solver::field::{Block, FieldOf, Layout, add_slots, in_slots_of};
use crate::solver::lane::LaneState;
use crate::solver::number::Number;
use crate::solver::scheme::Scheme;
use crate::solver::simd::{dispatch, load, splat};
use fearless_simd::Simd;

/// Displacements \[m\] and p \[m/s\] of a pin at one time, and the number of steps that each lane has done.
#[derive(Clone, Copy)]
pub(in crate::solver) struct Motion<'a, const L: usize, R: Number> {
    pub u: &'a FieldOf<L, R>,
    pub p: &'a FieldOf<L, R>,
    /// What its elements keep of their past.
    pub history: &'a [R],
    pub steps_done: &'a [u64; L],
}

/// Evaluates the energies of a pin. It stores values from before the audited step.
#[derive(Debug, Clone)]
pub(in crate::solver) struct PinAudit<const L: usize, R: Number> {
    mass: LineTable<R>,
    p: FieldOf<L, R>,
    /// K p.
    kp: FieldOf<L, R>,
    scratch: Scratch<R>,
    /// Stored energy before the step.
    elastic_j: [f64; L],
    /// Plastic work before the step, since the start.
    plastic_j: [f64; L],
    /// Work of damping over the increment before t_n.
    damping_before_j: [f64; L],
    /// Sums of the columns of blocks.
    columns: Vec<[R::Totals; SUMS]>,
    /// Present for β₂ > ½ only.
    jumps: Option<Jumps<L, R>>,
}

/// The additional fields for β₂ > ½.
#[derive(Debug, Clone)]
struct Jumps<const L: usize, R: Number> {
    /// Displacements before the step. With β₂ = 1 the first step does not change p, so its acceleration follows
    /// from the displacements alone.
    u: FieldOf<L, R>,
    acceleration: FieldOf<L, R>,
    previous_acceleration: FieldOf<L, R>,
    /// Increment of the displacements over the step before.
    increment: FieldOf<L, R>,
}

/// Number of sums: kinetic energy, work of damping after t_n, and ΔaMΔa.
const SUMS: usize = 3;
const KINETIC: usize = 0;
const DAMPING_AFTER: usize = 1;
const INERTIAL_JUMP: usize = 2;

impl<const L: usize, R: Number> PinAudit<L, R> {
    pub fn new(pin: &PinBody, beta2: f64) -> Self {
        let field = || FieldOf::<L, R>::zeros(pin.mesh().layout());
        let jumps = (beta2 > 0.5).then(|| Jumps {
            u: field(),
            acceleration: field(),
            previous_acceleration: field(),
            increment: field(),
        });
        Self {
            mass: LineTable::new(pin.mesh(), L, |node| pin.masses_kg()[node]),
            p: field(),
            kp: field(),
            scratch: pin.operator().scratch(pin.mesh().layout(), L),
            elastic_j: [0.0; L],
            plastic_j: [0.0; L],
            damping_before_j: [0.0; L],
            columns: vec![[R::Totals::default(); SUMS]; field().blocks_per_line()],
            jumps,
        }
    }

    /// Stores the state before the step.
    pub fn keep(&mut self, before: &Motion<'_, L, R>) {
        self.p.clone_from(before.p);
        if let Some(jumps) = &mut self.jumps {
            jumps.u.clone_from(before.u);
        }
    }

    /// Evaluates the stored energy and pKp before the step.
    pub fn begin(&mut self, pin: &PinBody, scheme: &Scheme, before: &Motion<'_, L, R>) {
        let (operator, dt) = (pin.operator(), scheme.time_step_s);
        let scale = scale_of_damping(scheme);
        // K p overwrites K u below.
        let totals = |lane| operator.plastic_totals(before.history, lane, L);
        self.plastic_j = std::array::from_fn(|lane| totals(lane).map_or(0.0, |[work_j, _]| work_j));
        self.elastic_j = operator.stored_j(before.u, before.history, &mut self.kp, &mut self.scratch);
        if scale == 0.0 {
            return;
        }
        let beta_r_s = scheme.beta_r_s;
        let mut form =
            operator.damper(before.u, before.p, before.history, beta_r_s, &mut self.kp, &mut self.scratch);
        if scheme.alpha_r_per_s > 0.0 {
            self.add_mass_damping(scheme, before.p);
            form = before.p.dot(&self.kp);
        }
        self.damping_before_j = form.map(|form| scale * dt * form);
        if let Some(jumps) = &self.jumps {
            // Δu of the step before is Δt p + (γ−½) Δt² a.
            let factor = scale * (scheme.beta2 - 0.5) * dt * dt;
            let form = jumps.previous_acceleration.dot(&self.kp);
            for lane in 0..L {
                self.damping_before_j[lane] += factor * form[lane];
            }
        }
    }

    /// Computes `a_n` from the displacements of the step, contact forces included. It is needed for β₂ > ½.
    pub fn find_acceleration(&mut self, scheme: &Scheme, after: &Motion<'_, L, R>) {
        let Some(jumps) = &mut self.jumps else { return };
        let dt = scheme.time_step_s;
        let scale = in_slots_of::<R>(&u_scales(scheme, after).map(|scale| 1.0 / scale));
        let dt = R::from_f64(dt);
        let after = after.u.blocks().iter().zip(jumps.u.blocks()).zip(self.p.blocks());
        for (a, ((after, u), p)) in jumps.acceleration.blocks_mut().iter_mut().zip(after) {
            for c in 0..3 {
                for i in 0..R::WIDTH {
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
        pin: &PinBody,
        scheme: &Scheme,
        after: &Motion<'_, L, R>,
    ) {
        let dt = scheme.time_step_s;
        let begins = after.steps_done.map(|steps| steps == 1);
        let factors = Factors {
            gain: in_slots_of::<R>(&begins.map(|begins| if begins { 0.0 } else { scheme.beta2 * dt })),
            per_p: in_slots_of::<R>(&begins.map(|begins| 1.0 / (scheme.factors(begins).1 * dt))),
            u_scale: in_slots_of::<R>(&u_scales(scheme, after)),
            scheme,
        };
        let jumps = self.jumps.as_ref();
        let motion = AuditedMotion {
            layout: pin.mesh().layout(),
            mass: &self.mass,
            before_p: self.p.blocks(),
            after_p: after.p.blocks(),
            kp: self.kp.blocks(),
            accelerations: jumps.map(|j| [j.acceleration.blocks(), j.previous_acceleration.blocks()]),
        };
        motion.add_up(&factors, &mut self.columns);
        let mut sums = [[0.0; L]; SUMS];
        for column in &self.columns {
            for (sum, slots) in sums.iter_mut().zip(column) {
                add_slots(sum, slots.as_ref());
            }
        }
        let numerical_j = self.numerical_loss(pin, scheme, &sums[INERTIAL_JUMP]);
        add_lanes(&mut total.kinetic_j, &sums[KINETIC]);
        add_lanes(&mut total.elastic_j, &self.elastic_j);
        add_lanes(&mut total.plastic_j, &self.plastic_j);
        add_lanes(&mut total.damping_after_j, &sums[DAMPING_AFTER]);
        add_lanes(&mut total.damping_before_j, &self.damping_before_j);
        add_lanes(&mut total.numerical_j, &numerical_j);
    }

    /// Makes the damping forces β_R K p + α_R M p of K p.
    fn add_mass_damping(&mut self, scheme: &Scheme, p: &FieldOf<L, R>) {
        let [alpha, beta] = [scheme.alpha_r_per_s, scheme.beta_r_s].map(R::from_f64);
        let blocks = p.blocks_per_line();
        for (at, (force, p)) in self.kp.blocks_mut().iter_mut().zip(p.blocks()).enumerate() {
            let mass = self.mass.row(at / blocks, at % blocks);
            for c in 0..3 {
                for i in 0..R::WIDTH {
                    force.0[c][i] = beta * force.0[c][i] + alpha * mass[i] * p.0[c][i];
                }
            }
        }
    }

    /// (γ−½)\[ΔuKΔu − ½γΔt² ΔaMΔa\] \[J\] of the step before `t_n`. It overwrites K p, which is no longer needed.
    fn numerical_loss(&mut self, pin: &PinBody, scheme: &Scheme, inertial_jump_j: &[f64; L]) -> [f64; L] {
        let Some(jumps) = &mut self.jumps else { return [0.0; L] };
        let (dt, gamma) = (scheme.time_step_s, scheme.beta2);
        let before = self.p.blocks().iter().zip(jumps.previous_acceleration.blocks());
        let (per_p, per_a) = (R::from_f64(dt), R::from_f64((gamma - 0.5) * dt * dt));
        for (increment, (p, a)) in jumps.increment.blocks_mut().iter_mut().zip(before) {
            for c in 0..3 {
                for i in 0..R::WIDTH {
                    increment.0[c][i] = per_p * p.0[c][i] + per_a * a.0[c][i];
                }
            }
        }
        let elastic_jump_j = pin.operator().tangent(&jumps.increment, &mut self.kp, &mut self.scratch);
        std::array::from_fn(|lane| {
            (gamma - 0.5) * (elastic_jump_j[lane] - 0.5 * gamma * dt * dt * inertial_jump_j[lane])
        })
    }
}

/// Only the acceleration of the step before is carried from step to step.
impl<const L: usize, R: Number> LaneState for PinAudit<L, R> {
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

/// Factors of the audited step.
struct Factors<'a, R: Number> {
    gain: R::Row,
    per_p: R::Row,
    u_scale: R::Row,
    scheme: &'a Scheme,
}

/// The blocks of an audited step, for any number of lanes.
struct AuditedMotion<'a, R: Number> {
    layout: Layout,
    mass: &'a LineTable<R>,
    before_p: &'a [Block<R>],
    after_p: &'a [Block<R>],
    kp: &'a [Block<R>],
    /// The acceleration, and that of the step before. Present for β₂ > ½ only.
    accelerations: Option<[&'a [Block<R>]; 2]>,
}

impl<R: Number> AuditedMotion<'_, R> {
    /// Forms the sums over all nodes that need the state after the step.
    fn add_up(&self, factors: &Factors<'_, R>, columns: &mut [[R::Totals; SUMS]]) {
        dispatch!(simd => self.add_up_in(simd, factors, columns));
    }

    #[inline(always)]
    fn add_up_in<S: Simd>(&self, simd: S, factors: &Factors<'_, R>, columns: &mut [[R::Totals; SUMS]]) {
        let Scheme { time_step_s: dt, beta2: gamma, .. } = *factors.scheme;
        let scale = scale_of_damping(factors.scheme);
        let damps = scale > 0.0;
        let all = |value| splat::<R, S>(simd, value);
        let row = |row| load::<R, S>(simd, row);
        let [gain, per_p, u_scale] = [row(&factors.gain), row(&factors.per_p), row(&factors.u_scale)];
        let [half, scale, of_a2] = [all(0.5), all(scale), all(0.5 * gamma * dt * dt)];
        let [dt, zero] = [all(dt), all(0.0)];
        let blocks = columns.len();
        columns.fill([R::Totals::default(); SUMS]);
        let Layout { lines_per_plane, .. } = self.layout;
        let lines = self.layout.lines();
        for plane in 0..self.layout.planes() {
            for along in 0..blocks {
                let mut sums = [zero; SUMS];
                for line in plane * lines_per_plane..((plane + 1) * lines_per_plane).min(lines) {
                    let at = line * blocks + along;
                    let half_mass = half * row(self.mass.row(line, along));
                    for c in 0..3 {
                        let p = row(&self.before_p[at].0[c]);
                        let a = match &self.accelerations {
                            None => (row(&self.after_p[at].0[c]) - p) * per_p,
                            Some([now, _]) => row(&now[at].0[c]),
                        };
                        let v = p + gain * a;
                        sums[KINETIC] += half_mass * (v * v - of_a2 * (a * a));
                        if damps {
                            let stroke = dt * p + u_scale * a;
                            sums[DAMPING_AFTER] += (scale * row(&self.kp[at].0[c])) * stroke;
                        }
                        if let Some([_, before]) = &self.accelerations {
                            let jump = a - row(&before[at].0[c]);
                            sums[INERTIAL_JUMP] += (half_mass + half_mass) * (jump * jump);
                        }
                    }
                }
                for (totals, sum) in columns[along].iter_mut().zip(sums) {
                    R::add_to_totals::<S>(totals, sum);
                }
            }
        }
    }
}

/// What makes the field `kp` of a [`PinAudit`] the damping forces. The field is K p, and where there is α_R it is β_R K p + α_R M p.
fn scale_of_damping(scheme: &Scheme) -> f64 {
    if scheme.alpha_r_per_s > 0.0 { 1.0 } else { scheme.beta_r_s }
}

/// Factor \[s²\] of a in the displacements of the step that each lane has just done.
fn u_scales<const L: usize, R: Number>(scheme: &Scheme, after: &Motion<'_, L, R>) -> [f64; L] {
    let dt = scheme.time_step_s;
    after.steps_done.map(|steps| scheme.factors(steps == 1).0 * dt * dt)
}

//! Energy bookkeeping of a run.
//!
//! For Newmark's method with β = 0, γ = β₂ and nodal forces f (load, contact, damping) the scheme
//! satisfies, to rounding (Krenk, *Energy conservation in Newmark based time integration
//! algorithms*, CMAME 195, 2006, with β = 0),
//!
//! ```text
//! E_n = ½ vMv + ½ uKu − (γ/4) Δt² aMa
//! E_{n+1} − E_n = Δu·[(1−γ) f_n + γ f_{n+1}] − (γ−½) [ΔuKΔu − (γ/2) Δt² ΔaMΔa]
//! ```
//!
//! For γ = ½ the kinetic part is ½ v_{n−½} M v_{n+½}. So a force f_n does the work
//! f_n·[(1−γ)Δu_n + γΔu_{n−1}]. For contact forces this splits into
//! * the drive's work f_t·VΔt,
//! * friction: −f_t·[(1−γ)s_n + γs_{n−1}] of the slipping nodes, s the increment relative to the target,
//! * contact loss: the same product for the tangential forces of sticking nodes, and −N·[(1−γ)Δz_n +
//!   γΔz_{n−1}] of all nodes: what a velocity jump costs when a node sticks or closes.
//!
//! Work of load and contact is summed every step (boundary nodes only). The stored energies and the
//! damping need products with K and are evaluated every `interval` steps, the damping's work being
//! the sample times `interval`. With `interval` = 1 the balance closes to rounding.

use super::contact::ContactState;
use super::field::{Field, WIDTH};
use super::model::Model;
use super::operator::Scratch;
use super::state::{Drive, State};
use super::step::factors;

/// Energies [J] of one lane: stored now, done and lost since the start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energies {
    /// Kinetic, ½vMv − (γ/4)Δt²aMa.
    pub kinetic_j: f64,
    /// Elastic, ½uKu.
    pub elastic_j: f64,
    /// Stored at the start.
    pub initial_j: f64,
    /// Work of the load.
    pub load_work_j: f64,
    /// Work of the moving target on the pin.
    pub drive_work_j: f64,
    /// Dissipated by friction.
    pub friction_j: f64,
    /// Dissipated by `β_R` and by β₂ > ½.
    pub damping_j: f64,
    /// Lost in contact impacts.
    pub contact_loss_j: f64,
}

impl Energies {
    /// What was put in minus what is stored and lost [J]; zero but for rounding and sampling.
    pub fn imbalance_j(&self) -> f64 {
        self.initial_j + self.load_work_j + self.drive_work_j
            - self.kinetic_j
            - self.elastic_j
            - self.friction_j
            - self.damping_j
            - self.contact_loss_j
    }

    /// Energy put in [J], the scale of the balance.
    pub fn input_j(&self) -> f64 {
        self.initial_j.abs() + self.load_work_j.abs() + self.drive_work_j.abs()
    }

    /// |imbalance| over the energy put in; 0 when nothing was put in.
    pub fn relative_residual(&self) -> f64 {
        let input = self.input_j();
        if input > 0.0 { self.imbalance_j().abs() / input } else { 0.0 }
    }
}

/// A sum of works weighted as the scheme does: increments before and after the force's time.
#[derive(Debug, Clone, Copy, Default)]
struct Work {
    after_j: f64,
    before_j: f64,
}

impl Work {
    fn done(&self, gamma: f64) -> f64 {
        (1.0 - gamma) * self.after_j + gamma * self.before_j
    }
}

#[derive(Debug, Clone, Copy, Default)]
struct LaneSums {
    load: Work,
    drive: Work,
    friction: Work,
    contact_loss: Work,
    damping: Work,
    numerical_j: f64,
}

/// Works of the contact forces of one step.
#[derive(Debug, Clone, Copy, Default)]
struct ContactWork {
    drive_j: f64,
    friction: Work,
    contact_loss: Work,
}

/// Follows the energies of all lanes; call [`EnergyLedger::before_step`] and
/// [`EnergyLedger::after_step`] around every step from the first one on.
#[derive(Debug, Clone)]
pub struct EnergyLedger<const L: usize> {
    interval: u64,
    sums: [LaneSums; L],
    energies: [Energies; L],
    previous_increment_m: Vec<[[f64; L]; 3]>,
    u: Field<L>,
    p: Field<L>,
    acceleration: Field<L>,
    previous_acceleration: Field<L>,
    ku: Field<L>,
    kp: Field<L>,
    scratch: Scratch<L>,
}

impl<const L: usize> EnergyLedger<L> {
    /// A ledger that evaluates stored energies and damping every `interval` steps, from step 0 on.
    ///
    /// # Panics
    /// If `interval` is zero.
    pub fn new(model: &Model, interval: u64) -> Self {
        assert!(interval > 0, "an interval of at least one step");
        let field = || Field::zeros(model.mesh());
        Self {
            interval,
            sums: [LaneSums::default(); L],
            energies: [Energies::default(); L],
            previous_increment_m: vec![[[0.0; L]; 3]; model.slaves().len()],
            u: field(),
            p: field(),
            acceleration: field(),
            previous_acceleration: field(),
            ku: field(),
            kp: field(),
            scratch: Scratch::new(model.mesh()),
        }
    }

    /// Whether the energies are evaluated at this step.
    pub fn audits(&self, step: u64) -> bool {
        step.is_multiple_of(self.interval)
    }

    /// The energies of a lane at its last audit.
    pub fn energies(&self, lane: usize) -> &Energies {
        &self.energies[lane]
    }

    /// Keeps what the audit of the coming step needs of the state at `t_n`.
    pub fn before_step(&mut self, model: &Model, state: &State<L>) {
        if self.keeps(model, state.step) {
            self.u.clone_from(&state.u);
            self.p.clone_from(&state.p);
        }
    }

    /// Adds up the works of the step just done and, at an audit, evaluates the energies at its `t_n`.
    pub fn after_step(&mut self, model: &Model, drives: &[Drive; L], state: &State<L>) {
        let done = state.step - 1;
        let contact = self.contact_work(model, drives, state);
        for l in 0..L {
            let sums = &mut self.sums[l];
            sums.load.before_j += state.load_work_j.before_j[l];
            sums.friction.before_j += contact[l].friction.before_j;
            sums.contact_loss.before_j += contact[l].contact_loss.before_j;
            if done > 0 {
                sums.drive.before_j += contact[l].drive_j;
            }
        }
        let mut damping_after_j = [0.0; L];
        if self.keeps(model, done) {
            self.find_acceleration(model, state, done);
            if self.audits(done) {
                damping_after_j = self.audit(model, state, done);
            }
            std::mem::swap(&mut self.acceleration, &mut self.previous_acceleration);
        }
        for l in 0..L {
            let sums = &mut self.sums[l];
            sums.load.after_j += state.load_work_j.after_j[l];
            sums.friction.after_j += contact[l].friction.after_j;
            sums.contact_loss.after_j += contact[l].contact_loss.after_j;
            sums.drive.after_j += contact[l].drive_j;
            sums.damping.after_j += damping_after_j[l];
        }
        self.previous_increment_m.copy_from_slice(&state.contacts.relative_increment_m);
    }

    /// β₂ > ½ needs the acceleration of the step before the audited one, too.
    fn keeps(&self, model: &Model, step: u64) -> bool {
        self.audits(step) || (model.beta2() > 0.5 && self.audits(step + 1))
    }

    fn contact_work(&self, model: &Model, drives: &[Drive; L], state: &State<L>) -> [ContactWork; L] {
        let dt = model.time_step_s();
        let mut works = [ContactWork::default(); L];
        let contacts = &state.contacts;
        for (slave, slave_node) in model.slaves().iter().enumerate() {
            let force = &contacts.force_n[slave];
            let now = &contacts.relative_increment_m[slave];
            let before = &self.previous_increment_m[slave];
            for l in 0..L {
                let work = &mut works[l];
                let slips = contacts.state[slave][l] == ContactState::Slip;
                for c in 0..3 {
                    let sink = if c < 2 && slips { &mut work.friction } else { &mut work.contact_loss };
                    sink.after_j -= force[c][l] * now[c][l];
                    sink.before_j -= force[c][l] * before[c][l];
                }
                for c in 0..2 {
                    work.drive_j += force[c][l] * slave_node.surface_motion[c] * drives[l].rate * dt;
                }
            }
        }
        works
    }

    /// `a_n` from the step's displacements, contact forces included.
    fn find_acceleration(&mut self, model: &Model, state: &State<L>, done: u64) {
        let dt = model.time_step_s();
        let (u_factor, _) = factors(model.beta2(), done);
        let scale = 1.0 / (u_factor * dt * dt);
        let after = state.u.blocks().iter().zip(self.u.blocks()).zip(self.p.blocks());
        for (a, ((after, u), p)) in self.acceleration.blocks_mut().iter_mut().zip(after) {
            for c in 0..3 {
                for i in 0..WIDTH {
                    a.0[c][i] = (after.0[c][i] - u.0[c][i] - dt * p.0[c][i]) * scale;
                }
            }
        }
    }

    /// Evaluates the energies at `t_n` and returns this step's damping work over the increment after `t_n`.
    fn audit(&mut self, model: &Model, state: &State<L>, done: u64) -> [f64; L] {
        let (dt, gamma, beta_r) = (model.time_step_s(), model.beta2(), model.beta_r_s());
        model.operator().product(&self.u, &mut self.ku, &mut self.scratch);
        if beta_r > 0.0 {
            model.operator().product(&self.p, &mut self.kp, &mut self.scratch);
        }
        let mut kinetic = [0.0; L];
        let mut elastic = [0.0; L];
        let mut damping = [Work::default(); L];
        let mut inertial_jump = [0.0; L];
        let velocity_gain = if done == 0 { 0.0 } else { gamma * dt };
        // Node by node: sums must not depend on how lanes share a block.
        for (node, &mass) in model.masses_kg().iter().enumerate() {
            let place = self.u.place(node);
            for c in 0..3 {
                let (u, ku, after) = (self.u.at(place, c), self.ku.at(place, c), state.u.at(place, c));
                let (p, kp) = (self.p.at(place, c), self.kp.at(place, c));
                let (a, a_before) = (self.acceleration.at(place, c), self.previous_acceleration.at(place, c));
                for l in 0..L {
                    let v = p[l] + velocity_gain * a[l];
                    kinetic[l] += 0.5 * mass * (v * v - 0.5 * gamma * dt * dt * a[l] * a[l]);
                    elastic[l] += 0.5 * u[l] * ku[l];
                    damping[l].after_j += beta_r * kp[l] * (after[l] - u[l]);
                    if done > 0 {
                        let increment = dt * p[l] + (gamma - 0.5) * dt * dt * a_before[l];
                        damping[l].before_j += beta_r * kp[l] * increment;
                        let jump = a[l] - a_before[l];
                        inertial_jump[l] += mass * jump * jump;
                    }
                }
            }
        }
        let samples = self.interval as f64;
        if gamma > 0.5 && done > 0 {
            let elastic_jump = self.elastic_jump(model);
            for l in 0..L {
                let loss = (gamma - 0.5) * (elastic_jump[l] - 0.5 * gamma * dt * dt * inertial_jump[l]);
                self.sums[l].numerical_j += samples * loss;
            }
        }
        for l in 0..L {
            let sums = &mut self.sums[l];
            sums.damping.before_j += samples * damping[l].before_j;
            let initial_j = if done == 0 { kinetic[l] + elastic[l] } else { self.energies[l].initial_j };
            self.energies[l] = Energies {
                kinetic_j: kinetic[l],
                elastic_j: elastic[l],
                initial_j,
                load_work_j: sums.load.done(gamma),
                drive_work_j: sums.drive.done(gamma),
                friction_j: sums.friction.done(gamma),
                damping_j: sums.damping.done(gamma) + sums.numerical_j,
                contact_loss_j: sums.contact_loss.done(gamma),
            };
        }
        damping.map(|work| samples * work.after_j)
    }

    /// ΔuKΔu of the step before `t_n`; overwrites the product with p, which is no longer needed.
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
        let mut jump = [0.0; L];
        for node in 0..model.masses_kg().len() {
            let place = self.ku.place(node);
            for c in 0..3 {
                let (increment, force) = (self.ku.at(place, c), self.kp.at(place, c));
                for l in 0..L {
                    jump[l] += increment[l] * force[l];
                }
            }
        }
        jump
    }
}

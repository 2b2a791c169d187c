//! Energy balance of a run.
//!
//! For Newmark's method with β = 0, γ = β₂ and nodal forces f (load, contact, damping) the scheme satisfies, to
//! rounding,
//!
//! ```text
//! E_n = ½ vMv + ½ uKu − (γ/4) Δt² aMa
//! E_{n+1} − E_n = Δu·[(1−γ) f_n + γ f_{n+1}] − (γ−½) [ΔuKΔu − (γ/2) Δt² ΔaMΔa]
//! ```
//!
//! (Krenk, *Energy conservation in Newmark based time integration algorithms*, CMAME 195, 2006, with β = 0). For γ
//! = ½ the kinetic part is ½ v_{n−½} M v_{n+½}. So a force f_n does the work f_n·\[(1−γ)Δu_n + γΔu_{n−1}\]. For
//! contact forces this work has three parts:
//! * The work of the drive is f_t·\[(1−γ)V_n + γV_{n−1}\]Δt with the velocities of the target over both steps. On an
//!   elastic disk, N times the rise of the surface along the node's path is added.
//! * The work of friction is −f_t·\[(1−γ)s_n + γs_{n−1}\] of the slipping nodes, where s is the increment relative
//!   to the target.
//! * The contact loss is the same product for the tangential forces of sticking nodes, and
//!   −N·\[(1−γ)Δz_n + γΔz_{n−1}\] for all nodes. It is the energy that a velocity jump costs when a node sticks or
//!   closes.
//!
//! A contact layer stores ∫N dδ, which is taken from the work −N·Δz of its nodes. The rest of that work is what its implicit
//! law dissipates, and remains in the contact loss.
//!
//! With large strains the stored energy is W(u) instead of ½uKu, and the balance has an error of the second order in Δt. Elements that
//! yield add up their plastic work themselves, in every step.
//!
//! The energies are a sum over bodies, supports and the interface. The works of the interface and of the load are
//! summed in every step, because they need boundary nodes only. The stored energies and the damping of bodies need
//! products with K. They are evaluated in an audit every `interval` steps, and the work of damping is the sample
//! times `interval`. With `interval` = 1 the balance closes to rounding.
//!
//! On an elastic disk the contact forces do work on both bodies, and increments are relative to the deformed
//! target.

use super::body::EnergySums;
use super::body::pin::PinAudit;
use super::body::ring::RingAudit;
use super::drive::Drive;
use super::interface::InterfaceWork;
use super::interface::solve::RunNumber;
use super::lane::{LaneState, next};
use super::model::Model;
use super::state::StateOf;
use serde::{Deserialize, Serialize};

/// Energies \[J\] of one lane: stored at the last audit; done as work or lost since the start.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Energies {
    /// Kinetic energy ½vMv − (γ/4)Δt²aMa.
    pub kinetic_j: f64,
    /// Elastic energy of the pin and the disk, with that of springs of a holder and of a contact layer.
    pub elastic_j: f64,
    /// Energy stored at the start.
    pub initial_j: f64,
    /// Work of the load.
    pub load_work_j: f64,
    /// Work of the moving target on the pin.
    pub drive_work_j: f64,
    /// Energy dissipated by friction.
    pub friction_j: f64,
    /// Energy dissipated by `β_R`, by β₂ > ½ and by dampers of a holder.
    pub damping_j: f64,
    /// Energy lost in contact impacts.
    pub contact_loss_j: f64,
    /// Plastic work of the pin.
    #[serde(default)]
    pub plastic_j: f64,
}

impl Energies {
    /// Energy put in minus energy stored, dissipated and lost \[J\]. It is zero except for rounding and sampling.
    pub fn imbalance_j(&self) -> f64 {
        self.initial_j + self.load_work_j + self.drive_work_j
            - self.kinetic_j
            - self.elastic_j
            - self.friction_j
            - self.damping_j
            - self.contact_loss_j
            - self.plastic_j
    }

    /// Energy put in \[J\], as a sum of magnitudes. It is the scale of the balance.
    pub fn input_j(&self) -> f64 {
        self.initial_j.abs() + self.load_work_j.abs() + self.drive_work_j.abs()
    }

    /// |imbalance| divided by the energy put in; 0 if nothing was put in.
    pub fn relative_residual(&self) -> f64 {
        let input = self.input_j();
        if input > 0.0 { self.imbalance_j().abs() / input } else { 0.0 }
    }
}

/// Work of forces at t_n over the increments after and before t_n. The scheme weights the two by 1−γ and γ.
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

/// Sums the energies of all lanes. Call [`EnergyLedger::before_step`] and [`EnergyLedger::after_step`] around every
/// step from the first one on.
#[derive(Debug, Clone)]
pub struct EnergyLedger<const L: usize, R: RunNumber = f64> {
    interval: u64,
    sums: [LaneSums; L],
    energies: [Energies; L],
    /// Rate of the target's motion over the last step.
    last_rates: [f64; L],
    interface: InterfaceWork<L, R>,
    pin: PinAudit<L, R>,
    ring: Option<RingAudit<L>>,
}

impl<const L: usize, R: RunNumber> EnergyLedger<L, R> {
    /// [`Self::new`] for any number of lanes, compiled by its caller.
    pub(crate) fn of_lanes(model: &Model, interval: u64) -> Self {
        assert!(interval > 0, "an interval of at least one step");
        Self {
            interval,
            sums: [LaneSums::default(); L],
            energies: [Energies::default(); L],
            last_rates: [0.0; L],
            interface: InterfaceWork::new(model.interface()),
            pin: PinAudit::new(model.pin(), model.scheme().beta2),
            ring: model.ring().map(RingAudit::new),
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

    /// [`Self::before_step`] for any number of lanes, compiled by its caller.
    pub(crate) fn before_step_of_lanes(&mut self, model: &Model, state: &StateOf<L, R>) {
        let (scheme, steps_done) = (model.scheme(), state.steps_of_lanes());
        let before = state.motion(&steps_done);
        if self.keeps(model, state.step) {
            self.pin.keep(&before);
        }
        if self.audits(state.step) {
            self.pin.begin(model.pin(), scheme, &before);
            if let (Some(audit), Some((body, ring))) = (&mut self.ring, state.target.ring()) {
                audit.begin(body, scheme, ring);
            }
        }
    }

    /// [`Self::after_step`] for any number of lanes, compiled by its caller.
    pub(crate) fn after_step_of_lanes(&mut self, model: &Model, drives: &[Drive; L], state: &StateOf<L, R>) {
        let done = state.step - 1;
        let rates: [f64; L] = std::array::from_fn(|l| drives[l].rate);
        let both_rates = [&rates, &self.last_rates];
        let works = self.interface.of_step(model.time_step_s(), both_rates, &state.contacts, &state.target);
        self.last_rates = rates;
        let [before_last, last, next] = &state.load_stroke_m;
        for l in 0..L {
            let sums = &mut self.sums[l];
            sums.load.before_j += state.load_n[l] * (last[l] - before_last[l]);
            sums.friction.before_j += works.friction_before_j[l];
            sums.contact_loss.before_j += works.contact_loss_before_j[l];
            if state.steps_done(l) > 1 {
                sums.drive.before_j += works.drive_before_j[l];
            }
            sums.drive.before_j += works.slope_before_j[l];
        }
        let mut damping_after_j = [0.0; L];
        if self.keeps(model, done) {
            self.pin.find_acceleration(model.scheme(), &state.motion(&state.steps_of_lanes()));
            if self.audits(done) {
                damping_after_j = self.evaluate(model, state);
            }
            self.pin.end();
        }
        for l in 0..L {
            let sums = &mut self.sums[l];
            sums.load.after_j += state.load_n[l] * (next[l] - last[l]);
            sums.friction.after_j += works.friction_after_j[l];
            sums.contact_loss.after_j += works.contact_loss_after_j[l];
            sums.drive.after_j += works.drive_after_j[l] + works.slope_after_j[l];
            sums.damping.after_j += damping_after_j[l];
        }
    }

    /// Whether a step stores its initial state. With β₂ > ½ an audit also needs the acceleration of the step before
    /// it.
    fn keeps(&self, model: &Model, step: u64) -> bool {
        self.audits(step) || (model.scheme().beta2 > 0.5 && self.audits(step + 1))
    }

    /// Evaluates the energies at `t_n`. Returns the damping work \[J\] over the increment after `t_n`, times the
    /// interval.
    fn evaluate(&mut self, model: &Model, state: &StateOf<L, R>) -> [f64; L] {
        let (scheme, steps_done) = (model.scheme(), state.steps_of_lanes());
        let gamma = scheme.beta2;
        let samples = self.interval as f64;
        let mut found = EnergySums::ZERO;
        self.pin.add_to(&mut found, model.pin(), scheme, &state.motion(&steps_done));
        if let (Some(audit), Some((_, ring))) = (&self.ring, state.target.ring()) {
            audit.add_to(&mut found, scheme, ring, &steps_done.map(|steps| steps == 1));
        }
        state.workspace.supports.add_energies(scheme, &steps_done, &state.u, &mut found);
        // The layer has N_n at the depth of t_{n+1}. What it stores is no loss.
        let in_layer_j = self.interface.stored_j(&state.contacts);
        for l in 0..L {
            let sums = &mut self.sums[l];
            let begins = state.steps_done(l) == 1;
            if !begins {
                sums.numerical_j += samples * found.numerical_j[l];
                sums.damping.before_j += samples * found.damping_before_j[l];
            }
            let (kinetic_j, elastic_j) = (found.kinetic_j[l], found.elastic_j[l]);
            self.energies[l] = Energies {
                kinetic_j,
                elastic_j: elastic_j + in_layer_j[l],
                initial_j: if begins { kinetic_j + elastic_j } else { self.energies[l].initial_j },
                load_work_j: sums.load.done(gamma),
                drive_work_j: sums.drive.done(gamma),
                friction_j: sums.friction.done(gamma),
                damping_j: sums.damping.done(gamma) + sums.numerical_j,
                contact_loss_j: sums.contact_loss.done(gamma) - in_layer_j[l],
                plastic_j: found.plastic_j[l],
            };
        }
        found.damping_after_j.map(|work_j| samples * work_j)
    }
}

/// A lane must be saved just before an audit, and loaded just before an audit of another ledger. Zeros clear a
/// lane.
impl<const L: usize, R: RunNumber> LaneState for EnergyLedger<L, R> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        let LaneSums { load, drive, friction, contact_loss, damping, numerical_j } = self.sums[lane];
        for work in [load, drive, friction, contact_loss, damping] {
            saved.extend([work.after_j, work.before_j]);
        }
        saved.push(numerical_j);
        let Energies {
            kinetic_j,
            elastic_j,
            initial_j,
            load_work_j,
            drive_work_j,
            friction_j,
            damping_j,
            contact_loss_j,
            // The audit that follows finds it in what the elements keep.
            plastic_j: _,
        } = self.energies[lane];
        saved.extend([kinetic_j, elastic_j, initial_j, load_work_j]);
        saved.extend([drive_work_j, friction_j, damping_j, contact_loss_j]);
        saved.push(self.last_rates[lane]);
        self.pin.save_lane(lane, saved);
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        let mut work = || {
            let [after_j, before_j] = next(saved);
            Work { after_j, before_j }
        };
        let [load, drive, friction, contact_loss, damping] = std::array::from_fn(|_| work());
        let [numerical_j] = next(saved);
        self.sums[lane] = LaneSums { load, drive, friction, contact_loss, damping, numerical_j };
        let [kinetic_j, elastic_j, initial_j, load_work_j] = next(saved);
        let [drive_work_j, friction_j, damping_j, contact_loss_j] = next(saved);
        self.energies[lane] = Energies {
            kinetic_j,
            elastic_j,
            initial_j,
            load_work_j,
            drive_work_j,
            friction_j,
            damping_j,
            contact_loss_j,
            plastic_j: 0.0,
        };
        [self.last_rates[lane]] = next(saved);
        self.pin.load_lane(lane, saved);
    }
}

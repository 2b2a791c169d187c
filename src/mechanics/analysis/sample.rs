//! The samples of a run: totals and extremes over the contact face at every step.

#![expect(clippy::inline_always, reason = "vector code must be compiled for the level that calls it")]

use crate::solver::field::{Block, FieldOf, add_slots, fold_slots};
use crate::solver::interface::{ContactState, Contacts, LIMIT, Status};
use crate::solver::lane::{LaneState, next};
use crate::solver::simd::{dispatch, load, load_all, splat};
use crate::solver::{Drive, Model, Number, RunNumber, StateOf};
use fearless_simd::{Simd, prelude::*};
use serde::{Deserialize, Serialize};

/// Totals and extremes over the contact face during one step (forces at `t_n`).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sample {
    /// `t_n` \[s\].
    pub time_s: f64,
    /// Normal load F \[N\].
    pub load_n: f64,
    /// Total normal contact force N \[N\].
    pub normal_n: f64,
    /// N after the stress smoother \[N\].
    pub smooth_normal_n: f64,
    /// Total contact friction force on the pin in y \[N\].
    pub contact_tangential_n: f64,
    /// Total contact friction force on the pin in x \[N\].
    pub contact_sideways_n: f64,
    /// Σ N x/lx \[N\]: the normal contact force's first moment about the pin's axis, over its width.
    pub x_moment_n: f64,
    /// Σ N y/ly \[N\].
    pub y_moment_n: f64,
    /// Tangential force T \[N\] in y that the clamp carries.
    pub clamp_tangential_n: f64,
    /// Σ over sticking nodes of μN − t_y \[N\].
    pub stick_deficit_n: f64,
    /// Σ over slipping nodes of μN(1 − cos φ) \[N\], φ the angle of friction from +y.
    pub slip_deficit_n: f64,
    /// Number of nodes in stick.
    pub stick: usize,
    /// Number of nodes in slip.
    pub slip: usize,
    /// Number of separated nodes.
    pub separated: usize,
    /// Number of nodes whose state differs from that in the step before.
    pub transitions: usize,
    /// Largest smoothed nodal normal stress \[Pa\].
    pub sigma_n_max_pa: f64,
    /// Largest slip speed \[m/s\] of a node in contact.
    pub slip_speed_max_m_s: f64,
    /// Largest gap \[m\] of a node.
    pub lift_max_m: f64,
    /// The holder in x, y and z; zeros where it does not move.
    pub holder: [HolderSample; 3],
    /// The observed nodes.
    pub nodes: [NodeSample; OBSERVED],
}

/// The holder in one direction at `t_n`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HolderSample {
    /// Displacement \[m\].
    pub displacement_m: f64,
    /// Acceleration \[m/s²\].
    pub acceleration_m_s2: f64,
}

impl Sample {
    /// Total friction force in y over total normal force; 0 without contact.
    pub fn equivalent_friction(&self) -> f64 {
        if self.normal_n > 0.0 { self.contact_tangential_n / self.normal_n } else { 0.0 }
    }
}

/// Number of observed nodes.
pub const OBSERVED: usize = 2;

/// Names of the observed nodes: the centre of the leading and of the trailing edge of the contact face.
pub const OBSERVED_NAMES: [&str; OBSERVED] = ["front_centre", "rear_centre"];

/// Names of the directions.
pub const DIRECTIONS: [&str; 3] = ["x", "y", "z"];

/// One observed contact node during a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NodeSample {
    /// Displacement \[m\].
    pub u_m: [f64; 3],
    /// Velocity in y over the step \[m/s\].
    pub y_velocity_m_s: f64,
    /// Displacement over the step relative to the target \[m\]: x and y.
    pub slip_m: [f64; 2],
    /// Gap \[m\].
    pub gap_m: f64,
    /// Contact force \[N\] on the pin: friction in x and y, N in z.
    pub force_n: [f64; 3],
    /// Limit \[N\] of the friction force that the law gave; 0 without contact.
    pub limit_n: f64,
    /// Smoothed normal stress \[Pa\].
    pub sigma_n_pa: f64,
    /// Slip speed \[m/s\]; 0 unless the node slips.
    pub slip_speed_m_s: f64,
    /// Contact state.
    pub state: ContactState,
}

impl NodeSample {
    /// Equivalent friction coefficient `μ_eq` = |τ/σ_n|; 0 when separated (as in the paper's figure 2b).
    pub fn equivalent_friction(&self) -> f64 {
        let [x, y, n] = self.force_n;
        if n > 0.0 { (x * x + y * y).sqrt() / n } else { 0.0 }
    }
}

/// A first-order low-pass filter.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Smoother {
    value: f64,
}

impl Smoother {
    /// A filter whose input has always been `value`.
    pub fn at(value: f64) -> Self {
        Self { value }
    }

    /// Advances by one step with the gain 1 − exp(−Δt/τ).
    pub fn push(&mut self, input: f64, gain: f64) -> f64 {
        self.value += gain * (input - self.value);
        self.value
    }
}

/// Gain of a first-order low-pass of time constant `tau_s` at the step `time_step_s`.
pub fn smoothing_gain(time_step_s: f64, tau_s: f64) -> f64 {
    1.0 - libm::exp(-time_step_s / tau_s)
}

/// Time constant of the stress smoother over the pressure-wave transit time of the pin's height.
///
/// A node that closes carries a spike of about ρ c v/CFL for one step. The spike is a property of the time
/// step, not of the contact. 0.15 transit times (2 µs in the reference scene) remove it, and they damp the 16
/// kHz cycle by 2 %.
pub const STRESS_SMOOTHING: f64 = 0.15;

/// Computes the [`Sample`]s of all lanes.
#[derive(Debug, Clone)]
pub struct Sampler<const L: usize, R: Number = f64> {
    gain: f64,
    /// 1/area, x/lx and y/ly of every slave node.
    nodes: FieldOf<L, R>,
    /// For every slave node after the last step: its smoothed stress, whether it was closed and whether it
    /// slipped.
    last: FieldOf<L, R>,
    normal: [Smoother; L],
    /// The slave nodes that are always observed.
    observed: [usize; OBSERVED],
}

/// Sums and maxima over the contact face, lane by lane.
#[derive(Debug, Clone, Copy)]
struct Totals<const L: usize> {
    sums: [[f64; L]; SUMS],
    maxima: [[f64; L]; MAXIMA],
}

/// Number and indices of [`Totals::sums`].
const SUMS: usize = 10;
const NORMAL: usize = 0;
const TANGENTIAL: usize = 1;
const SIDEWAYS: usize = 2;
const X_MOMENT: usize = 3;
const Y_MOMENT: usize = 4;
const STICK_DEFICIT: usize = 5;
const SLIP_DEFICIT: usize = 6;
const ALL_CLOSED: usize = 7;
const ALL_SLIPPING: usize = 8;
const TRANSITIONS: usize = 9;

/// Number and indices of [`Totals::maxima`].
const MAXIMA: usize = 3;
const STRESS: usize = 0;
const SLIPPED: usize = 1;
const GAP: usize = 2;

/// Components of [`Sampler::last`].
const SIGMA_N: usize = 0;
const CLOSED: usize = 1;
const SLIPS: usize = 2;

impl<const L: usize, R: RunNumber> Sampler<L, R> {
    /// A sampler of jobs that begin at rest.
    pub fn new(model: &Model) -> Self {
        let interface = model.interface();
        let transit_s = model.pin().pressure_transit_s();
        let [width_m, length_m] = interface.extent_m();
        let nodes = interface.field(|node| {
            let [x, y] = node.position_m;
            [1.0 / node.area_m2, x / width_m, y / length_m]
        });
        Self {
            gain: smoothing_gain(model.time_step_s(), STRESS_SMOOTHING * transit_s),
            nodes,
            last: FieldOf::zeros(interface.layout()),
            normal: [Smoother::default(); L],
            observed: interface.edge_centres(),
        }
    }

    /// The samples of the last step of `state`.
    pub fn sample(&mut self, model: &Model, drives: &[Drive; L], state: &StateOf<L, R>) -> [Sample; L] {
        let dt = model.time_step_s();
        let Totals { sums, maxima } = self.totals(&state.contacts);
        let holder = state.holder_motion();
        std::array::from_fn(|l| Sample {
            time_s: (state.steps_done(l) - 1) as f64 * dt,
            load_n: state.load_n[l],
            normal_n: sums[NORMAL][l],
            smooth_normal_n: self.normal[l].push(sums[NORMAL][l], self.gain),
            contact_tangential_n: sums[TANGENTIAL][l],
            contact_sideways_n: sums[SIDEWAYS][l],
            x_moment_n: sums[X_MOMENT][l],
            y_moment_n: sums[Y_MOMENT][l],
            // The clamp's reaction on the pin opposes the friction of the disk.
            clamp_tangential_n: -state.reaction_n[1][l],
            stick_deficit_n: sums[STICK_DEFICIT][l],
            slip_deficit_n: sums[SLIP_DEFICIT][l],
            stick: (sums[ALL_CLOSED][l] - sums[ALL_SLIPPING][l]) as usize,
            slip: sums[ALL_SLIPPING][l] as usize,
            separated: model.slaves().len() - sums[ALL_CLOSED][l] as usize,
            transitions: sums[TRANSITIONS][l] as usize,
            sigma_n_max_pa: maxima[STRESS][l],
            slip_speed_max_m_s: maxima[SLIPPED][l] / dt,
            lift_max_m: maxima[GAP][l],
            holder: holder.map(|[displacement_m, acceleration_m_s2]| HolderSample {
                displacement_m: displacement_m[l],
                acceleration_m_s2: acceleration_m_s2[l],
            }),
            nodes: self.observed.map(|slave| self.node(slave, model, &drives[l], state, l)),
        })
    }

    /// The gain of the stress smoothers.
    pub fn gain(&self) -> f64 {
        self.gain
    }

    /// One slave node of a lane during the last step of `state`.
    pub fn node(
        &self,
        slave: usize,
        model: &Model,
        drive: &Drive,
        state: &StateOf<L, R>,
        lane: usize,
    ) -> NodeSample {
        let dt = model.time_step_s();
        let place = state.u.place(slave);
        let contacts = &state.contacts;
        let contact_state = contacts.state_of(slave, lane);
        let [x, y, _] = contacts.increment_of(slave, lane);
        let slips = contact_state == ContactState::Slip;
        let [_, of_target, _] = state.target.increment_of(slave, lane);
        NodeSample {
            u_m: std::array::from_fn(|c| state.u.at(place, c)[lane].to_f64()),
            slip_m: [x, y],
            y_velocity_m_s: (y + of_target) / dt + model.slaves()[slave].surface_motion[1] * drive.rate,
            gap_m: contacts.gap_of(slave, lane),
            force_n: contacts.force_of(slave, lane),
            limit_n: contacts.friction_limit_of(slave, lane),
            sigma_n_pa: self.last.at(place, SIGMA_N)[lane].to_f64(),
            slip_speed_m_s: if slips { (x * x + y * y).sqrt() / dt } else { 0.0 },
            state: contact_state,
        }
    }

    fn totals(&mut self, contacts: &Contacts<L, R>) -> Totals<L> {
        let mut totals = Totals { sums: [[0.0; L]; SUMS], maxima: [[0.0; L]; MAXIMA] };
        let mut face = FaceSample {
            gain: R::from_f64(self.gain),
            stride: self.nodes.blocks_per_line(),
            nodes: self.nodes.blocks(),
            last: self.last.blocks_mut(),
            force_n: contacts.force_n.blocks(),
            increment_m: contacts.increment_m.blocks(),
            status: contacts.status.blocks(),
            friction: contacts.friction.blocks(),
        };
        face.add_up(
            &mut totals.sums.each_mut().map(<[f64; L]>::as_mut_slice),
            &mut totals.maxima.each_mut().map(<[f64; L]>::as_mut_slice),
        );
        totals
    }
}

/// The blocks of the contact face, for any number of lanes.
struct FaceSample<'a, R: Number> {
    gain: R,
    stride: usize,
    nodes: &'a [Block<R>],
    last: &'a mut [Block<R>],
    force_n: &'a [Block<R>],
    increment_m: &'a [Block<R>],
    status: &'a [Block<R>],
    friction: &'a [Block<R>],
}

impl<R: Number> FaceSample<'_, R> {
    /// Adds the face to the sums and the maxima of the lanes.
    fn add_up(&mut self, sums: &mut [&mut [f64]; SUMS], maxima: &mut [&mut [f64]; MAXIMA]) {
        dispatch!(simd => self.add_up_in(simd, sums, maxima));
    }

    #[inline(always)]
    fn add_up_in<S: Simd>(
        &mut self,
        simd: S,
        face_sums: &mut [&mut [f64]; SUMS],
        face_maxima: &mut [&mut [f64]; MAXIMA],
    ) {
        let zero = splat::<R, S>(simd, 0.0);
        let one = splat::<R, S>(simd, 1.0);
        let gain = R::Vector::<S>::splat(simd, self.gain);
        for along in 0..self.stride {
            let mut sums = [zero; SUMS];
            let mut maxima = [zero; MAXIMA];
            for at in (along..self.nodes.len()).step_by(self.stride) {
                let (node, last) = (&self.nodes[at].0, &mut self.last[at].0);
                let force = load_all::<R, S>(simd, &self.force_n[at].0);
                let status = load_all::<R, S>(simd, &self.status[at].0);
                let (gap, closed, slips) = (
                    status[Status::Gap as usize],
                    status[Status::Closed as usize],
                    status[Status::Slips as usize],
                );
                let before = load_all::<R, S>(simd, last);
                let sigma_n =
                    before[SIGMA_N] + gain * (force[2] * load::<R, S>(simd, &node[0]) - before[SIGMA_N]);
                let changed = closed.simd_ne(before[CLOSED]) | slips.simd_ne(before[SLIPS]);
                sigma_n.store_array(&mut last[SIGMA_N]);
                closed.store_array(&mut last[CLOSED]);
                slips.store_array(&mut last[SLIPS]);
                let increment = &self.increment_m[at].0;
                let (x, y) = (load::<R, S>(simd, &increment[0]), load::<R, S>(simd, &increment[1]));
                let slipping = slips.simd_gt(zero);
                let slipped = slipping.select((x * x + y * y).sqrt(), zero);
                let limit = load::<R, S>(simd, &self.friction[at].0[LIMIT]);
                // Friction points along −slip, so cos φ = −s_y/|s|.
                let misaligned = limit * (one + y / slipped);
                sums[NORMAL] += force[2];
                sums[TANGENTIAL] += force[1];
                sums[SIDEWAYS] += force[0];
                sums[X_MOMENT] += force[2] * load::<R, S>(simd, &node[1]);
                sums[Y_MOMENT] += force[2] * load::<R, S>(simd, &node[2]);
                sums[STICK_DEFICIT] += slipping.select(zero, limit - force[1]);
                sums[SLIP_DEFICIT] += slipped.simd_gt(zero).select(misaligned, zero);
                sums[ALL_CLOSED] += closed;
                sums[ALL_SLIPPING] += slips;
                sums[TRANSITIONS] += changed.select(one, zero);
                maxima[STRESS] = sigma_n.simd_gt(maxima[STRESS]).select(sigma_n, maxima[STRESS]);
                maxima[SLIPPED] = slipped.simd_gt(maxima[SLIPPED]).select(slipped, maxima[SLIPPED]);
                maxima[GAP] = gap.simd_gt(maxima[GAP]).select(gap, maxima[GAP]);
            }
            for (totals, sum) in face_sums.iter_mut().zip(&sums) {
                let row: &R::Row = sum.as_array();
                add_slots(totals, row.as_ref());
            }
            for (largest, found) in face_maxima.iter_mut().zip(&maxima) {
                let row: &R::Row = found.as_array();
                fold_slots(largest, row.as_ref(), |largest, value| value.max(largest));
            }
        }
    }
}

/// A lane of zeros has no history.
impl<const L: usize, R: Number> LaneState for Sampler<L, R> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        self.last.save_lane(lane, saved);
        saved.push(self.normal[lane].value);
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        self.last.load_lane(lane, saved);
        [self.normal[lane].value] = next(saved);
    }
}

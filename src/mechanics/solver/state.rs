//! What changes during a run.

use super::body::pin::{History, Motion, NodeMotion};
use super::field::FieldOf;
use super::interface::Contacts;
use super::interface::solve::{RunNumber, TargetState};
use super::lane::{LaneState, next};
use super::model::Model;
use super::support::AppliedSupports;
use super::support::load::AppliedLoad;

/// The state of `L` jobs, each at its own t_n, with fields of the number type `R`.
#[derive(Debug, Clone)]
pub struct StateOf<const L: usize, R: RunNumber> {
    /// Steps that the lanes have taken together.
    pub step: u64,
    /// Value of `step` at which the job in a lane began. The job is at t_n with n = `step` − `begun`. The
    /// subtraction wraps, because a job can be loaded in the middle of its run and then has more steps than this
    /// state.
    pub begun: [u64; L],
    /// Displacements `u_n` of the pin \[m\].
    pub u: FieldOf<L, R>,
    /// `p_n = v_{n−1} + (1−β₂)Δt a_{n−1}` of the pin \[m/s\]; at n = 0 the initial velocity.
    pub p: FieldOf<L, R>,
    /// What the elements of the pin keep of their past.
    pub history: History<L, R>,
    /// Contact during the last step, from `t_{n−1}` to `t_n`.
    pub contacts: Contacts<L, R>,
    /// The target, on which the pin slides.
    pub target: TargetState<L, R>,
    /// Sum of the reaction forces \[N\] of the supports on the pin at `t_{n−1}`: x, y and z.
    pub reaction_n: [[f64; L]; 3],
    /// Load \[N\] at `t_{n−1}`.
    pub load_n: [f64; L],
    /// Displacement \[m\] that is work-conjugate to the total load, at `t_{n−2}`, `t_{n−1}` and `t_n`.
    pub load_stroke_m: [[f64; L]; 3],
    pub(super) workspace: Workspace<L, R>,
}

/// The state of `L` jobs in double precision.
pub type State<const L: usize> = StateOf<L, f64>;

/// The parts of the model that move the pin, prepared for all lanes, and scratch memory. Nothing in it is carried
/// from step to step.
#[derive(Debug, Clone)]
pub(super) struct Workspace<const L: usize, R: RunNumber> {
    pub pin: NodeMotion<L, R>,
    pub supports: AppliedSupports<L, R>,
    pub load: AppliedLoad<R>,
}

impl<const L: usize, R: RunNumber> StateOf<L, R> {
    /// All lanes at rest and undeformed. It is compiled by its caller, for any number of lanes.
    ///
    /// # Panics
    /// As [`Self::at_rest`].
    pub(crate) fn lanes_at_rest(model: &Model) -> Self {
        let pin = model.pin();
        Self {
            step: 0,
            begun: [0; L],
            u: FieldOf::zeros(pin.mesh().layout()),
            p: FieldOf::zeros(pin.mesh().layout()),
            history: History::new(pin.operator()),
            contacts: Contacts::separated(model.interface().layout()),
            target: TargetState::at_rest(model.interface(), model.target()),
            reaction_n: [[0.0; L]; 3],
            load_n: [0.0; L],
            load_stroke_m: [[0.0; L]; 3],
            workspace: Workspace {
                pin: NodeMotion::new(pin, model.scheme().alpha_r_per_s),
                supports: AppliedSupports::new(model.supports(), pin.mesh().layout(), pin.masses_kg()),
                load: AppliedLoad::new(model.load(), pin.mesh().layout(), L),
            },
        }
    }

    /// Number n of steps that the job in a lane has done.
    pub fn steps_done(&self, lane: usize) -> u64 {
        self.step.wrapping_sub(self.begun[lane])
    }

    /// Number of steps that the job in each lane has done.
    pub(super) fn steps_of_lanes(&self) -> [u64; L] {
        std::array::from_fn(|lane| self.steps_done(lane))
    }

    /// Displacement \[m\] and acceleration \[m/s²\] of the holder in x, y and z at `t_{n−1}`, in every lane; zeros where it does
    /// not move.
    pub fn holder_motion(&self) -> [[[f64; L]; 2]; 3] {
        self.workspace.supports.holder_motion()
    }

    /// The motion of the pin.
    pub(super) fn motion<'a>(&'a self, steps_done: &'a [u64; L]) -> Motion<'a, L, R> {
        Motion { u: &self.u, p: &self.p, history: self.history.numbers(), steps_done }
    }
}

/// The saved numbers are all that a job needs to continue. Zeros are a job that begins at rest.
impl<const L: usize, R: RunNumber> LaneState for StateOf<L, R> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        // The conversion is exact below 2⁵³ steps.
        saved.push(self.steps_done(lane) as f64);
        self.u.save_lane(lane, saved);
        self.p.save_lane(lane, saved);
        self.history.save_lane(lane, saved);
        self.contacts.save_lane(lane, saved);
        self.target.save_lane(lane, saved);
        self.reaction_n.save_lane(lane, saved);
        self.load_stroke_m.save_lane(lane, saved);
        self.load_n.save_lane(lane, saved);
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        let [steps] = next(saved);
        self.begun[lane] = self.step.wrapping_sub(steps as u64);
        self.u.load_lane(lane, saved);
        self.p.load_lane(lane, saved);
        self.history.load_lane(lane, saved);
        self.contacts.load_lane(lane, saved);
        self.target.load_lane(lane, saved);
        self.reaction_n.load_lane(lane, saved);
        self.load_stroke_m.load_lane(lane, saved);
        self.load_n.load_lane(lane, saved);
    }
}

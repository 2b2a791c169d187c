//! Results of a contact solve at the slave nodes.

use crate::solver::field::{FieldOf, Layout};
use crate::solver::lane::LaneState;
use crate::solver::number::Number;

/// State of a slave node during a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum ContactState {
    /// No contact force.
    #[default]
    Separated,
    /// The contact force is inside the friction cone: the node moves with the target.
    Stick,
    /// The contact force is on the friction cone: the node moves relative to the target.
    Slip,
}

impl ContactState {
    /// The name used in tables and CSV.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// Contact of all slave nodes during the last step. Slave nodes are numbered like the nodes of the contact face.
#[derive(Debug, Clone)]
pub struct Contacts<const L: usize, R: Number = f64> {
    /// Contact force \[N\] on the pin at t_n: x, y, and N ≥ 0 in z (the multipliers are minus these forces).
    pub force_n: FieldOf<L, R>,
    /// Displacement increment \[m\] relative to the target over the step: x, y, and in z the change of the gap.
    pub increment_m: FieldOf<L, R>,
    /// The increment \[m\] over the step before.
    pub previous_increment_m: FieldOf<L, R>,
    /// Gap and state; [`Status`] names the components.
    pub status: FieldOf<L, R>,
    /// In the first component, the limit \[N\] of the friction force at t_n that the law gave; 0 without contact. The
    /// other components are 0.
    pub friction: FieldOf<L, R>,
}

/// The component of [`Contacts::friction`] that holds the limit.
pub(crate) const LIMIT: usize = 0;

/// The components of [`Contacts::status`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Gap \[m\] at t_{n+1}, positive when open.
    Gap = 0,
    /// 1 if the node carried a contact force during the step, otherwise 0.
    Closed = 1,
    /// 1 if the node slipped, otherwise 0.
    Slips = 2,
}

impl<const L: usize, R: Number> Contacts<L, R> {
    /// No contact at the slave nodes of a face with this layout.
    pub fn separated(layout: Layout) -> Self {
        let face = || FieldOf::zeros(layout);
        Self {
            force_n: face(),
            increment_m: face(),
            previous_increment_m: face(),
            status: face(),
            friction: face(),
        }
    }

    /// Prepares a step: the increments of the last step become those of the step before.
    pub(in crate::solver) fn swap_increments(&mut self) {
        std::mem::swap(&mut self.increment_m, &mut self.previous_increment_m);
    }

    fn fields(&self) -> [&FieldOf<L, R>; 5] {
        [&self.force_n, &self.increment_m, &self.previous_increment_m, &self.status, &self.friction]
    }

    fn fields_mut(&mut self) -> [&mut FieldOf<L, R>; 5] {
        [
            &mut self.force_n,
            &mut self.increment_m,
            &mut self.previous_increment_m,
            &mut self.status,
            &mut self.friction,
        ]
    }

    /// Number of slave nodes.
    pub fn slaves(&self) -> usize {
        self.force_n.len() / (3 * L)
    }

    /// Contact force \[N\] on a slave node of a lane at t_n.
    pub fn force_of(&self, slave: usize, lane: usize) -> [f64; 3] {
        vector(&self.force_n, slave, lane)
    }

    /// Displacement increment \[m\] of a slave node of a lane relative to the target.
    pub fn increment_of(&self, slave: usize, lane: usize) -> [f64; 3] {
        vector(&self.increment_m, slave, lane)
    }

    /// The limit \[N\] of the friction force on a slave node of a lane at t_n.
    pub fn friction_limit_of(&self, slave: usize, lane: usize) -> f64 {
        self.friction.at(self.friction.place(slave), LIMIT)[lane].to_f64()
    }

    /// Gap \[m\] of a slave node of a lane at t_{n+1}.
    pub fn gap_of(&self, slave: usize, lane: usize) -> f64 {
        self.status.at(self.status.place(slave), Status::Gap as usize)[lane].to_f64()
    }

    /// State of a slave node of a lane during the step.
    pub fn state_of(&self, slave: usize, lane: usize) -> ContactState {
        let [_, closed, slips] = vector(&self.status, slave, lane);
        if slips != 0.0 {
            ContactState::Slip
        } else if closed != 0.0 {
            ContactState::Stick
        } else {
            ContactState::Separated
        }
    }

    /// States of all slave nodes of a lane.
    pub fn states(&self, lane: usize) -> impl Iterator<Item = ContactState> + '_ {
        (0..self.slaves()).map(move |slave| self.state_of(slave, lane))
    }

    /// Contact forces \[N\] on all slave nodes of a lane.
    pub fn forces(&self, lane: usize) -> impl Iterator<Item = [f64; 3]> + '_ {
        (0..self.slaves()).map(move |slave| self.force_of(slave, lane))
    }
}

/// Zeros are a lane without contact.
impl<const L: usize, R: Number> LaneState for Contacts<L, R> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        for field in self.fields() {
            field.save_lane(lane, saved);
        }
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        for field in self.fields_mut() {
            field.load_lane(lane, saved);
        }
    }
}

fn vector<const L: usize, R: Number>(field: &FieldOf<L, R>, node: usize, lane: usize) -> [f64; 3] {
    let place = field.place(node);
    std::array::from_fn(|c| field.at(place, c)[lane].to_f64())
}

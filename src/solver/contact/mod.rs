//! Unilateral contact with Coulomb friction by forward increment Lagrange multipliers.
//!
//! Carpenter, Taylor and Katona (1991): predict u* without contact; every slave node that would be
//! below its target at t_{n+1} gets a constraint row, and the multipliers that put it back act at t_n.

pub mod coulomb;
pub mod elastic;
pub mod patch;
pub mod rigid;
pub mod sweeps;

pub use sweeps::Solves;

use super::field::{Block, Field};
use super::mesh::BlockMesh;

/// The slave nodes at t_n, which the solve takes to t_{n+1}.
pub(in crate::solver) struct Face<'a, const L: usize> {
    pub u: &'a mut Field<L>,
    pub p: &'a mut Field<L>,
    /// K (u + β_R p) − external forces [N].
    pub residual: &'a Field<L>,
    /// 1/m of every degree of freedom, 0 where it is fixed.
    pub inverse_mass: &'a [Block],
}

/// State of a slave node during a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ContactState {
    /// No contact force.
    #[default]
    Separated,
    /// Contact force inside the friction cone: moves with the target.
    Stick,
    /// Contact force on the friction cone: moves relative to the target.
    Slip,
}

impl ContactState {
    /// The name used in tables and CSV.
    pub fn name(self) -> &'static str {
        match self {
            Self::Separated => "separated",
            Self::Stick => "stick",
            Self::Slip => "slip",
        }
    }
}

/// Contact of all slave nodes during the last step; slave nodes are numbered as the nodes of the contact face.
#[derive(Debug, Clone)]
pub struct Contacts<const L: usize> {
    /// Contact force [N] on the pin at t_n: x, y, and N ≥ 0 in z (the multipliers are its negative).
    pub force_n: Field<L>,
    /// Displacement increment [m] relative to the target over the step: x, y and (target at rest) z.
    pub increment_m: Field<L>,
    /// The same over the step before.
    pub previous_increment_m: Field<L>,
    /// What [`Status`] names, component by component.
    pub status: Field<L>,
    /// On an elastic target.
    pub elastic: Option<Box<ElasticContacts<L>>>,
}

/// What there is besides on an elastic target.
#[derive(Debug, Clone)]
pub struct ElasticContacts<const L: usize> {
    /// How the target itself moves under each slave node during the step [m]: x, y, and in z by how much its surface
    /// at t_n is higher where the node will be than where it is.
    pub yielding_m: Field<L>,
    /// Over the step before; in z by the patches of this step, as [`Contacts::previous_increment_m`] is.
    pub previous_yielding_m: Field<L>,
    /// How the contact solves went.
    pub solves: [Solves; L],
}

/// The components of [`Contacts::status`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Gap [m] at t_{n+1}, positive when open.
    Gap = 0,
    /// 1 if the node carried a contact force during the step, otherwise 0.
    Closed = 1,
    /// 1 if it slipped, otherwise 0.
    Slips = 2,
}

impl<const L: usize> Contacts<L> {
    /// No contact at the nodes of the contact face of `mesh`.
    pub fn separated(mesh: &BlockMesh) -> Self {
        let face = || Field::on_face(mesh);
        Self {
            force_n: face(),
            increment_m: face(),
            previous_increment_m: face(),
            status: face(),
            elastic: None,
        }
    }

    /// The same on an elastic target.
    pub fn on_elastic_target(mesh: &BlockMesh) -> Self {
        let face = || Field::on_face(mesh);
        let elastic = ElasticContacts {
            yielding_m: face(),
            previous_yielding_m: face(),
            solves: [Solves::default(); L],
        };
        Self { elastic: Some(Box::new(elastic)), ..Self::separated(mesh) }
    }

    /// What was found over the last step is now of the step before.
    pub(super) fn swap_increments(&mut self) {
        std::mem::swap(&mut self.increment_m, &mut self.previous_increment_m);
        if let Some(elastic) = &mut self.elastic {
            std::mem::swap(&mut elastic.yielding_m, &mut elastic.previous_yielding_m);
        }
    }

    /// How the contact solves of a lane went, on an elastic target.
    pub fn solves_of(&self, lane: usize) -> Option<&Solves> {
        self.elastic.as_ref().map(|elastic| &elastic.solves[lane])
    }

    /// Number of slave nodes.
    pub fn slaves(&self) -> usize {
        self.force_n.len() / (3 * L)
    }

    /// Contact force [N] on a slave node of a lane at t_n.
    pub fn force_of(&self, slave: usize, lane: usize) -> [f64; 3] {
        vector(&self.force_n, slave, lane)
    }

    /// Displacement increment [m] of a slave node of a lane relative to the target.
    pub fn increment_of(&self, slave: usize, lane: usize) -> [f64; 3] {
        vector(&self.increment_m, slave, lane)
    }

    /// Gap [m] of a slave node of a lane at t_{n+1}.
    pub fn gap_of(&self, slave: usize, lane: usize) -> f64 {
        self.status.at(self.status.place(slave), Status::Gap as usize)[lane]
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

    /// Contact forces [N] on all slave nodes of a lane.
    pub fn forces(&self, lane: usize) -> impl Iterator<Item = [f64; 3]> + '_ {
        (0..self.slaves()).map(move |slave| self.force_of(slave, lane))
    }

    /// Appends a lane.
    pub fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        for field in [&self.force_n, &self.increment_m, &self.previous_increment_m, &self.status] {
            field.save_lane(lane, saved);
        }
        if let Some(elastic) = &self.elastic {
            elastic.yielding_m.save_lane(lane, saved);
            elastic.previous_yielding_m.save_lane(lane, saved);
            elastic.solves[lane].save(saved);
        }
    }

    /// Sets a lane to a saved one; all zeros separate its nodes.
    pub fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        for field in
            [&mut self.force_n, &mut self.increment_m, &mut self.previous_increment_m, &mut self.status]
        {
            field.load_lane(lane, saved);
        }
        if let Some(elastic) = &mut self.elastic {
            elastic.yielding_m.load_lane(lane, saved);
            elastic.previous_yielding_m.load_lane(lane, saved);
            elastic.solves[lane] = Solves::load(saved);
        }
    }
}

fn vector<const L: usize>(field: &Field<L>, node: usize, lane: usize) -> [f64; 3] {
    let place = field.place(node);
    std::array::from_fn(|c| field.at(place, c)[lane])
}

//! What an elastic disk is to a pin whose fields have a given precision.

use super::coupled::RingTarget;
use super::step_data::StepData;
use crate::solver::body::pin::Face;
use crate::solver::body::ring::RingBody;
use crate::solver::interface::{Contacts, Interface};
use crate::solver::lane::LaneState;
use crate::solver::number::Number;
use std::fmt::Debug;
use std::sync::Arc;

/// The numbers of the fields of a run.
pub trait RunNumber: Number {
    /// An elastic disk under a pin with such fields.
    type Elastic<const L: usize>: ElasticTarget<L, Self>;
}

impl RunNumber for f64 {
    type Elastic<const L: usize> = RingTarget<L>;
}

impl RunNumber for f32 {
    type Elastic<const L: usize> = NoElasticTarget;
}

/// An elastic disk under a pin with fields of the number type `R`.
pub trait ElasticTarget<const L: usize, R: Number>: Clone + Debug + Send + Sync + LaneState {
    /// The disk at rest; `None` if this precision has no elastic disk.
    fn at_rest(interface: &Interface, body: &Arc<RingBody>) -> Option<Self>;
    /// Its contact solve and state.
    fn ring(&self) -> &RingTarget<L>;
    /// Moves the slave nodes and the disk to t_{n+1}.
    fn solve(&mut self, given: &StepData<'_, L, R>, face: &mut Face<'_, L, R>, contacts: &mut Contacts<L, R>);
    /// Works \[J\] of the drive on the slopes of the disk, over the increments after and before the time of the forces.
    fn slope_works_j(&self, contacts: &Contacts<L, R>) -> [[f64; L]; 2];
}

impl<const L: usize> ElasticTarget<L, f64> for RingTarget<L> {
    fn at_rest(interface: &Interface, body: &Arc<RingBody>) -> Option<Self> {
        Some(Self::new(interface, body))
    }

    fn ring(&self) -> &RingTarget<L> {
        self
    }

    fn solve(&mut self, given: &StepData<'_, L>, face: &mut Face<'_, L>, contacts: &mut Contacts<L>) {
        self.move_both(given, face, contacts);
    }

    fn slope_works_j(&self, contacts: &Contacts<L>) -> [[f64; L]; 2] {
        self.works_on_slopes_j(contacts)
    }
}

/// The elastic disk of single precision: there is none.
#[derive(Debug, Clone, Copy)]
pub enum NoElasticTarget {}

impl<const L: usize> ElasticTarget<L, f32> for NoElasticTarget {
    fn at_rest(_: &Interface, _: &Arc<RingBody>) -> Option<Self> {
        None
    }

    fn ring(&self) -> &RingTarget<L> {
        match *self {}
    }

    fn solve(&mut self, _: &StepData<'_, L, f32>, _: &mut Face<'_, L, f32>, _: &mut Contacts<L, f32>) {
        match *self {}
    }

    fn slope_works_j(&self, _: &Contacts<L, f32>) -> [[f64; L]; 2] {
        match *self {}
    }
}

impl LaneState for NoElasticTarget {
    fn save_lane(&self, _: usize, _: &mut Vec<f64>) {
        match *self {}
    }

    fn load_lane(&mut self, _: usize, _: &mut dyn Iterator<Item = f64>) {
        match *self {}
    }
}

//! The two solves for the contact forces of a step.
//!
//! * `diagonal` – on a rigid target: node by node, in closed form.
//! * `coupled` – on an elastic disk, where constraints share target nodes: by Gauss–Seidel (`sweeps`). Single precision
//!   has no elastic disk (`elastic`).
//!
//! The law and the projection stand once for all. What a node's gap and slip are, and how it is moved, differs with the target, so the
//! rule around them stands in `diagonal`, in `held` (nodes with a fixed component) and in `sweeps`. A test runs the three on the same
//! nodes and compares them.

mod coupled;
mod diagonal;
mod elastic;
mod held;
mod step_data;
pub(in crate::solver) mod sweeps;

use elastic::ElasticTarget;
pub use elastic::RunNumber;
pub(in crate::solver) use step_data::StepData;
pub use sweeps::Solves;

use super::target::Target;
use super::{Contacts, Interface};
use crate::solver::body::pin::Face;
use crate::solver::body::ring::{RingBody, RingState};
use crate::solver::lane::LaneState;
use diagonal::DiagonalSolve;

/// The target in every lane, with its contact solve.
#[derive(Debug, Clone)]
pub struct TargetState<const L: usize, R: RunNumber = f64>(Kind<L, R>);

#[derive(Debug, Clone)]
enum Kind<const L: usize, R: RunNumber> {
    Rigid(DiagonalSolve<L, R>),
    Ring(Box<R::Elastic<L>>),
}

impl<const L: usize, R: RunNumber> TargetState<L, R> {
    /// The target at rest.
    ///
    /// # Panics
    /// If it is an elastic disk in single precision. `JobSpec::check` refuses such a scene.
    pub(in crate::solver) fn at_rest(interface: &Interface, target: &Target) -> Self {
        Self(match target {
            Target::Rigid => Kind::Rigid(DiagonalSolve::new(interface)),
            Target::Ring(ring) => {
                let ring = <R::Elastic<L>>::at_rest(interface, ring);
                Kind::Ring(Box::new(ring.expect("an elastic disk has double precision")))
            }
        })
    }

    /// Moves the slave nodes and the target to t_{n+1}. Returns the sum of the contact forces \[N\] on fixed
    /// degrees of freedom of the pin, which its supports carry: x, y and z.
    pub(in crate::solver) fn solve(
        &mut self,
        given: &StepData<'_, L, R>,
        face: &mut Face<'_, L, R>,
        contacts: &mut Contacts<L, R>,
    ) -> [[f64; L]; 3] {
        contacts.swap_increments();
        match &mut self.0 {
            Kind::Rigid(solve) => solve.solve(given, face, contacts),
            Kind::Ring(ring) => {
                ring.solve(given, face, contacts);
                // On a ring no slave node is fixed: `Model::new` refuses it.
                [[0.0; L]; 3]
            }
        }
    }

    /// The elastic disk and its state, if the target is one.
    pub fn ring(&self) -> Option<(&RingBody, &RingState<L>)> {
        match &self.0 {
            Kind::Rigid(_) => None,
            Kind::Ring(ring) => Some((ring.ring().body(), ring.ring().state())),
        }
    }

    /// Displacement increment \[m\] of the target under a slave node of a lane over the last step, in addition to
    /// the prescribed motion. It is zero on a rigid target.
    pub fn increment_of(&self, slave: usize, lane: usize) -> [f64; 3] {
        match &self.0 {
            Kind::Rigid(_) => [0.0; 3],
            Kind::Ring(ring) => ring.ring().increment_of(slave, lane),
        }
    }

    /// Convergence statistics of the contact solves of a lane; `None` on a rigid target.
    pub fn solves_of(&self, lane: usize) -> Option<&Solves> {
        match &self.0 {
            Kind::Rigid(_) => None,
            Kind::Ring(ring) => Some(ring.ring().solves_of(lane)),
        }
    }

    /// Works \[J\] of the drive on the slopes of the target, over the increments after and before the time of the
    /// forces. A plane has no slopes.
    pub(in crate::solver) fn slope_works_j(&self, contacts: &Contacts<L, R>) -> [[f64; L]; 2] {
        match &self.0 {
            Kind::Rigid(solve) => solve.relief_works_j(contacts),
            Kind::Ring(ring) => ring.slope_works_j(contacts),
        }
    }

    /// Whether all numbers of a lane are finite.
    pub fn is_finite(&self, lane: usize) -> bool {
        self.ring().is_none_or(|(_, ring)| ring.is_finite(lane))
    }
}

#[cfg(test)]
impl<const L: usize> TargetState<L> {
    /// A rigid target that solves all nodes one by one, as if each had a fixed component.
    pub(super) fn one_by_one(interface: &Interface) -> Self {
        Self(Kind::Rigid(DiagonalSolve::in_pass(interface, |_| false)))
    }

    /// [`TargetState::solve`] on a rigid target with a friction law of the tests.
    pub(super) fn solve_with<W: super::law::FrictionLimit<0>>(
        &mut self,
        given: &StepData<'_, L>,
        face: &mut Face<'_, L>,
        contacts: &mut Contacts<L>,
    ) {
        contacts.swap_increments();
        let Kind::Rigid(solve) = &self.0 else { panic!("a rigid target") };
        let pass = solve.pass(given, face, contacts);
        let law = super::law::LawOfLanes::<W, f64, 0>::NONE;
        crate::solver::simd::dispatch!(simd => pass.solve(simd, &law));
    }
}

impl<const L: usize, R: RunNumber> LaneState for TargetState<L, R> {
    fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        if let Kind::Ring(ring) = &self.0 {
            ring.save_lane(lane, saved);
        }
    }

    fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        if let Kind::Ring(ring) = &mut self.0 {
            ring.load_lane(lane, saved);
        }
    }
}

//! What changes during a run: per-lane fields, and the drive of each lane.

use super::contact::Contacts;
use super::contact::elastic::ElasticContact;
use super::contact::rigid::RigidContact;
use super::disk::{DiskBody, DiskState};
use super::field::{Field, next};
use super::integrate::Integration;
use super::model::Model;
use super::operator::Scratch;
use super::supports::Supports;

/// What one lane is driven by; everything else of a job is shared through the [`Model`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// Coulomb friction coefficient μ.
    pub mu: f64,
    /// Rate of the target's motion: ω [rad/s] of a disk, the speed [m/s] of a plane.
    pub rate: f64,
    /// Total load [N] after the ramp.
    pub force_n: f64,
    /// Duration [s] of the load's linear ramp; 0 is a sudden load.
    pub ramp_s: f64,
}

impl Drive {
    /// The load [N] at a time.
    pub fn load_n(&self, time_s: f64) -> f64 {
        if time_s >= self.ramp_s { self.force_n } else { self.force_n * (time_s / self.ramp_s) }
    }
}

/// The state of `L` jobs, each at its own t_n.
#[derive(Debug, Clone)]
pub struct State<const L: usize> {
    /// Steps that the lanes have taken together.
    pub step: u64,
    /// Value of `step` at which the job in a lane began, or would have: it is at t_n with n = `step` − `begun`,
    /// in wrapping arithmetic, because a job may come from elsewhere in the middle of its run.
    pub begun: [u64; L],
    /// Displacements `u_n` [m].
    pub u: Field<L>,
    /// `p_n = v_{n−1} + (1−β₂)Δt a_{n−1}` [m/s]; at n = 0 the initial velocity.
    pub p: Field<L>,
    /// Contact during the step that led here.
    pub contacts: Contacts<L>,
    /// An elastic disk.
    pub disk: Option<Box<DiskState<L>>>,
    /// Sum of the clamp's reactions [N] on the pin at `t_{n−1}`, x, y and z.
    pub reaction_n: [[f64; L]; 3],
    /// Load [N] at `t_{n−1}`.
    pub load_n: [f64; L],
    /// Displacement [m] on which a unit of the load does work, at `t_{n−2}`, `t_{n−1}` and `t_n`.
    pub load_stroke_m: [[f64; L]; 3],
    pub(super) workspace: Workspace<L>,
}

/// Scratch of the step and what it needs of the model; nothing in it is carried from step to step.
#[derive(Debug, Clone)]
pub(super) struct Workspace<const L: usize> {
    /// Scratch of the product with K.
    pub product: Scratch<L>,
    /// K (u + β_R p) − load on the constrained planes.
    pub residual: Field<L>,
    /// What moves the nodes.
    pub integration: Integration<L>,
    pub supports: Supports<L>,
    pub contact: ContactSolve<L>,
}

/// The contact solve that the target needs.
#[derive(Debug, Clone)]
pub(super) enum ContactSolve<const L: usize> {
    Rigid(RigidContact<L>),
    Elastic(Box<ElasticContact<L>>),
}

impl<const L: usize> ContactSolve<L> {
    fn new(model: &Model, disk: Option<&DiskBody>) -> Self {
        match disk {
            None => Self::Rigid(RigidContact::new(model)),
            Some(disk) => Self::Elastic(Box::new(ElasticContact::new(model, disk))),
        }
    }
}

impl<const L: usize> State<L> {
    /// At rest and undeformed.
    pub fn at_rest(model: &Model) -> Self {
        let field = || Field::zeros(model.mesh());
        Self {
            step: 0,
            begun: [0; L],
            u: field(),
            p: field(),
            contacts: match model.disk() {
                None => Contacts::separated(model.mesh()),
                Some(_) => Contacts::on_elastic_target(model.mesh()),
            },
            disk: model.disk().map(|disk| Box::new(DiskState::at_rest(disk))),
            reaction_n: [[0.0; L]; 3],
            load_n: [0.0; L],
            load_stroke_m: [[0.0; L]; 3],
            workspace: Workspace {
                product: Scratch::new(model.mesh()),
                residual: field(),
                integration: Integration::new(model),
                supports: Supports::new(model),
                contact: ContactSolve::new(model, model.disk()),
            },
        }
    }

    /// Number n of steps that the job in a lane has done.
    pub fn steps_done(&self, lane: usize) -> u64 {
        self.step.wrapping_sub(self.begun[lane])
    }

    /// Appends all that a lane's job needs to go on, in any lane of any state of the same model.
    pub fn save_lane(&self, lane: usize, saved: &mut Vec<f64>) {
        // Exact: there are fewer steps than 2⁵³.
        saved.push(self.steps_done(lane) as f64);
        self.u.save_lane(lane, saved);
        self.p.save_lane(lane, saved);
        self.contacts.save_lane(lane, saved);
        if let Some(disk) = &self.disk {
            disk.save_lane(lane, saved);
        }
        saved.extend(self.reaction_n.map(|reaction| reaction[lane]));
        saved.extend(self.load_stroke_m.map(|stroke| stroke[lane]));
        saved.push(self.load_n[lane]);
    }

    /// Sets a lane to a saved job, wherever that is in its run; all zeros are a job that begins at rest.
    pub fn load_lane(&mut self, lane: usize, saved: &mut dyn Iterator<Item = f64>) {
        let [steps] = next(saved);
        self.begun[lane] = self.step.wrapping_sub(steps as u64);
        self.u.load_lane(lane, saved);
        self.p.load_lane(lane, saved);
        self.contacts.load_lane(lane, saved);
        if let Some(disk) = &mut self.disk {
            disk.load_lane(lane, saved);
        }
        for component in self.reaction_n.iter_mut().chain(&mut self.load_stroke_m) {
            [component[lane]] = next(saved);
        }
        [self.load_n[lane]] = next(saved);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::step;
    use crate::spec::JobSpec;

    /// Protects: the ramp is linear from zero, then constant; without one the load is there at once.
    #[test]
    fn the_load_is_ramped() {
        let ramped = Drive { mu: 0.0, rate: 0.0, force_n: 30.0, ramp_s: 1.0e-3 };
        assert_eq!([0.0, 0.25e-3, 1.0e-3, 2.0e-3].map(|t| ramped.load_n(t)), [0.0, 7.5, 30.0, 30.0]);
        assert_eq!(Drive { ramp_s: 0.0, ..ramped }.load_n(0.0), 30.0);
    }

    /// Protects: the load of a step is that of its time t_n, not of the step before or after.
    #[test]
    fn a_step_takes_the_load_of_its_own_time() {
        let mut spec = JobSpec::default();
        spec.scene.pin.elements = [6, 8, 5];
        spec.scene.clamp.width_m = 0.002;
        let model = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        let dt = model.time_step_s();
        let drive = Drive { mu: 0.4, rate: 0.7, force_n: 30.0, ramp_s: 5.5 * dt };
        let mut state = State::<1>::at_rest(&model);
        for n in 0..8 {
            step(&model, &[drive], &mut state);
            assert_eq!(state.load_n[0], drive.load_n(f64::from(n) * dt), "step {n}");
        }
    }
}

//! What changes during a run: per-lane fields, and the drive of each lane.

use super::contact::Contacts;
use super::field::Field;
use super::integrate::Integration;
use super::model::Model;
use super::operator::Scratch;
use super::places::Places;

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

/// The state of `L` jobs at t_n.
#[derive(Debug, Clone)]
pub struct State<const L: usize> {
    /// Index n of the next step; the fields are those at t_n = nΔt.
    pub step: u64,
    /// Displacements `u_n` [m].
    pub u: Field<L>,
    /// `p_n = v_{n−1} + (1−β₂)Δt a_{n−1}` [m/s]; at n = 0 the initial velocity.
    pub p: Field<L>,
    /// Contact during the step that led here.
    pub contacts: Contacts<L>,
    /// Sum of the clamp's reactions [N] on the pin at `t_{n−1}`, x, y and z.
    pub reaction_n: [[f64; L]; 3],
    /// Load [N] at `t_{n−1}`.
    pub load_n: [f64; L],
    /// Work increments of the load over the step: the load at `t_{n−1}` times the displacement
    /// increments after and before that time [J].
    pub load_work_j: LoadWork<L>,
    pub(super) workspace: Workspace<L>,
}

/// The load times the displacement increments on both sides of the time at which it acts [J].
#[derive(Debug, Clone, Copy)]
pub struct LoadWork<const L: usize> {
    /// f_n · (u_{n+1} − u_n).
    pub after_j: [f64; L],
    /// f_n · (u_n − u_{n−1}).
    pub before_j: [f64; L],
}

/// Scratch of the step; nothing in it survives it.
#[derive(Debug, Clone)]
pub(super) struct Workspace<const L: usize> {
    /// Scratch of the product with K.
    pub product: Scratch<L>,
    /// K (u + β_R p) − load on the constrained planes.
    pub residual: Field<L>,
    /// What moves the nodes.
    pub integration: Integration<L>,
    pub places: Places,
    /// Displacements of the slave nodes at t_n.
    pub slave_u: Vec<[[f64; L]; 3]>,
    /// New displacement and p of every tied group.
    pub tied: Vec<[(f64, f64); L]>,
    /// Σ share·u of the loaded degrees of freedom before and at t_n.
    pub load_stroke_m: [[f64; L]; 2],
}

impl<const L: usize> State<L> {
    /// At rest and undeformed.
    pub fn at_rest(model: &Model) -> Self {
        let slaves = model.slaves().len();
        let field = || Field::zeros(model.mesh());
        Self {
            step: 0,
            u: field(),
            p: field(),
            contacts: Contacts::separated(slaves),
            reaction_n: [[0.0; L]; 3],
            load_n: [0.0; L],
            load_work_j: LoadWork { after_j: [0.0; L], before_j: [0.0; L] },
            workspace: Workspace {
                product: Scratch::new(model.mesh()),
                residual: field(),
                places: Places::new::<L>(model, &field()),
                integration: Integration::new(model),
                slave_u: vec![[[0.0; L]; 3]; slaves],
                tied: vec![[(0.0, 0.0); L]; model.ties().len()],
                load_stroke_m: [[0.0; L]; 2],
            },
        }
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

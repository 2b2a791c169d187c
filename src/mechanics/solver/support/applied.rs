//! What a support does in every lane.

use crate::solver::body::EnergySums;
use crate::solver::field::FieldOf;
use crate::solver::number::Number;
use crate::solver::scheme::Scheme;
use std::fmt::Debug;

/// A support in every lane. It may store within a step what [`AppliedSupport::add_energies`] needs. Nothing is
/// carried from step to step.
pub(in crate::solver) trait AppliedSupport<const L: usize, R: Number>:
    Debug + Send + Sync
{
    /// Acts on the pin at t_n, and adds its reaction force on the pin \[N\] to `reaction_n`. A compliant support adds its
    /// force to the residual, a tie replaces the residual, and a fixed support only reads it.
    fn act(&mut self, pin: &mut Supported<'_, L, R>, reaction_n: &mut [[f64; L]; 3]);

    /// Adds the energy stored at t_n, and the work of damping in the step from there to `u_after`, after which the lanes
    /// have done `steps_done` steps. A rigid support has neither.
    ///
    /// The work of damping over the increment before t_n can be given for β₂ = ½ only, where that increment is Δt p_n.
    fn add_energies(
        &self,
        _scheme: &Scheme,
        _steps_done: &[u64; L],
        _u_after: &FieldOf<L, R>,
        _total: &mut EnergySums<L>,
    ) {
    }

    /// The component in which the support moves as one body, and its displacement \[m\] and acceleration \[m/s²\] at t_n; none
    /// for a support that is no body.
    fn motion(&self) -> Option<(usize, [[f64; L]; 2])> {
        None
    }

    /// A copy.
    fn boxed(&self) -> Box<dyn AppliedSupport<L, R>>;
}

/// The pin at t_n, on which supports act.
pub(in crate::solver) struct Supported<'a, const L: usize, R: Number> {
    /// Displacements \[m\] at t_n, on the planes of nodes on which supports and loads act; the others have been moved. Rigid
    /// supports do not need them, nor `p`.
    pub u: &'a FieldOf<L, R>,
    /// p_n \[m/s\].
    pub p: &'a FieldOf<L, R>,
    /// K (u + β_R p) − external forces \[N\].
    pub residual: &'a mut FieldOf<L, R>,
}

/// A mass on a spring and a damper, or an inertia on their rotational counterparts.
pub(super) struct Way {
    pub inertia: f64,
    pub stiffness: f64,
    pub damping: f64,
}

impl Way {
    /// Adds its energies: `motion` is its displacement, p and acceleration at t_n, and `after` its displacement after the step.
    pub fn add_energies<const L: usize>(
        &self,
        scheme: &Scheme,
        steps_done: &[u64; L],
        motion: &[[f64; L]; 3],
        after: &[f64; L],
        total: &mut EnergySums<L>,
    ) {
        let Self { inertia, stiffness, damping } = *self;
        let Scheme { beta2: gamma, time_step_s: dt, .. } = *scheme;
        for lane in 0..L {
            let [u, p, a] = motion.map(|of_lanes| of_lanes[lane]);
            // In its first step p is the velocity.
            let v = if steps_done[lane] == 1 { p } else { p + gamma * dt * a };
            total.kinetic_j[lane] += 0.5 * inertia * (v * v - 0.5 * gamma * dt * dt * (a * a));
            total.elastic_j[lane] += 0.5 * stiffness * u * u;
            total.damping_after_j[lane] += damping * p * (after[lane] - u);
            total.damping_before_j[lane] += damping * p * (dt * p);
        }
    }
}

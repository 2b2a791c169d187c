//! What a friction law says about itself, and what it may use.

use crate::solver::real::Real;
use crate::spec::{Contact, FrictionLaw};

/// A slave node in contact, before its friction is known: one node (`R` = `f64`), or the nodes of a vector.
#[derive(Debug, Clone, Copy)]
pub(in crate::solver) struct AtNode<R> {
    /// Normal force \[N\] of this step, ≥ 0.
    pub normal_n: R,
    /// The force \[N\] in x and y that would stop the node relative to the target.
    pub trial_n: [R; 2],
    /// The force \[N/m\] that changes the node's slip of this step by one metre.
    pub stiffness_n_m: R,
    /// Increment \[m\] relative to the target over the step before, in x and y.
    pub last_increment_m: [R; 2],
    /// Whether the node slipped in the step before (1) or not (0).
    pub last_slipped: R,
    /// The friction limit \[N\] of the step before; 0 without contact.
    pub last_limit_n: R,
}

/// How the friction limit follows from `N` numbers, for one node (`R` = `f64`) or for the nodes of a vector.
pub(in crate::solver) trait FrictionLimit<const N: usize> {
    /// False if the limit is always zero. Then no trial force is computed.
    const TRANSMITS: bool = true;

    /// The friction limit \[N\].
    fn limit_n<R: Real>(numbers: [R; N], node: &AtNode<R>) -> R;
}

/// A friction law with the coefficients of one lane.
pub(in crate::solver) trait LawFormula<const N: usize>: FrictionLimit<N> + Sized {
    /// Its name in a study. [`FrictionLaw`] says what does not depend on the coefficients.
    const NAME: FrictionLaw;

    /// The law of a contact. A coefficient that is absent is not a number.
    fn of(contact: &Contact) -> Self;

    /// The numbers from which the limit follows, for a time step.
    fn numbers(&self, time_step_s: f64) -> [f64; N];

    /// The coefficient μ that every law has.
    fn mu(&self) -> f64;

    /// Gives the law another coefficient μ.
    fn set_mu(&mut self, mu: f64);

    /// μ(v) of steady slip with the speed v \[m/s\], and μ′(v) \[s/m\]; none if it is μ at every speed.
    fn steady(&self, _speed_m_s: f64) -> Option<[f64; 2]> {
        None
    }
}

/// A coefficient of a contact. The check of a job refuses a law without its coefficients, so that NaN reaches no run.
pub(super) fn given(value: Option<f64>) -> f64 {
    value.unwrap_or(f64::NAN)
}

/// A static coefficient for another μ: it changes in proportion. Without kinetic friction there is no proportion, and it stays.
pub(super) fn in_proportion(mu_static: f64, before: f64, mu: f64) -> f64 {
    if before == 0.0 { mu_static } else { mu_static * mu / before }
}

/// The length of a vector in the contact plane.
#[inline(always)]
pub(super) fn length<R: Real>([x, y]: [R; 2]) -> R {
    (x * x + y * y).root()
}

//! The entries to the solver that are compiled with the library, for 1, 2, 4 and 8 lanes in both precisions.
//!
//! Generic code is compiled by the crate that calls it. Without these entries every program that takes a step, each of the tests
//! too, would compile the solver again, which takes minutes.

use super::drive::Drive;
use super::energy::EnergyLedger;
use super::interface::solve::RunNumber;
use super::model::Model;
use super::state::StateOf;
use super::step::step_of_lanes;

/// Numbers for whose states of `L` lanes the library has the compiled solver.
pub trait InLanes<const L: usize>: RunNumber {
    /// [`StateOf::at_rest`].
    fn at_rest(model: &Model) -> StateOf<L, Self>;
    /// [`step`].
    fn step(model: &Model, drives: &[Drive; L], state: &mut StateOf<L, Self>);
    /// [`EnergyLedger::new`].
    fn ledger(model: &Model, interval: u64) -> EnergyLedger<L, Self>;
    /// [`EnergyLedger::before_step`].
    fn before_step(ledger: &mut EnergyLedger<L, Self>, model: &Model, state: &StateOf<L, Self>);
    /// [`EnergyLedger::after_step`].
    fn after_step(
        ledger: &mut EnergyLedger<L, Self>,
        model: &Model,
        drives: &[Drive; L],
        state: &StateOf<L, Self>,
    );
}

/// Implements [`InLanes`] for a number type and numbers of lanes.
macro_rules! in_lanes {
    ($number:ty: $($lanes:literal)*) => {$(
        impl InLanes<$lanes> for $number {
            fn at_rest(model: &Model) -> StateOf<$lanes, Self> {
                StateOf::lanes_at_rest(model)
            }

            fn step(model: &Model, drives: &[Drive; $lanes], state: &mut StateOf<$lanes, Self>) {
                step_of_lanes(model, drives, state);
            }

            fn ledger(model: &Model, interval: u64) -> EnergyLedger<$lanes, Self> {
                EnergyLedger::of_lanes(model, interval)
            }

            fn before_step(ledger: &mut EnergyLedger<$lanes, Self>, model: &Model, state: &StateOf<$lanes, Self>) {
                ledger.before_step_of_lanes(model, state);
            }

            fn after_step(
                ledger: &mut EnergyLedger<$lanes, Self>,
                model: &Model,
                drives: &[Drive; $lanes],
                state: &StateOf<$lanes, Self>,
            ) {
                ledger.after_step_of_lanes(model, drives, state);
            }
        }
    )*};
}

in_lanes!(f64: 1 2 4 8);
in_lanes!(f32: 1 2 4 8);

/// Advances all lanes from `t_n` to `t_{n+1}`.
pub fn step<const L: usize, R: InLanes<L>>(model: &Model, drives: &[Drive; L], state: &mut StateOf<L, R>) {
    R::step(model, drives, state);
}

impl<const L: usize, R: InLanes<L>> StateOf<L, R> {
    /// All lanes at rest and undeformed.
    ///
    /// # Panics
    /// If the target is an elastic disk and the precision is single.
    pub fn at_rest(model: &Model) -> Self {
        R::at_rest(model)
    }
}

impl<const L: usize, R: InLanes<L>> EnergyLedger<L, R> {
    /// A ledger that evaluates stored energies and damping every `interval` steps, from step 0 on.
    ///
    /// # Panics
    /// If `interval` is zero.
    pub fn new(model: &Model, interval: u64) -> Self {
        R::ledger(model, interval)
    }

    /// Stores what the audit of the coming step needs of the state at `t_n`.
    ///
    /// All lanes count their steps together, so a job must begin at an audit.
    pub fn before_step(&mut self, model: &Model, state: &StateOf<L, R>) {
        R::before_step(self, model, state);
    }

    /// Adds the works of the step just done and, at an audit, evaluates the energies at the `t_n` of that step.
    pub fn after_step(&mut self, model: &Model, drives: &[Drive; L], state: &StateOf<L, R>) {
        R::after_step(self, model, drives, state);
    }
}

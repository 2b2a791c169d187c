//! What is found in a run: cycles, periodic state, decay, regime, μ*, identities.

pub mod cycles;
pub mod figures;
pub mod record;
pub mod sample;

pub use record::{EnergyTotals, JobRecord, ObservedNode, Outcome, Regime};

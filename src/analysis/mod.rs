//! What is found in a run: cycles, periodic state, decay, regime, μ*, identities.

pub mod record;

pub use record::{EnergyTotals, JobRecord, ObservedNode, Outcome, Regime};

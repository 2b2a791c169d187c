//! History matching: which values of free parameters do measured values not rule out?
//!
//! ```text
//! runs at points of the unit cube ──► states at each measured point ──► emulators of each state ──► implausibility ──► region
//! ```
//!
//! Everything here is numbers: a point is a place in the unit cube, a quantity is a position in a list. What they mean is known to
//! [`sweep`](crate::sweep).
//!
//! The implausibility of a place is the distance of a measured value from that which the emulator expects, over the standard deviation of
//! this distance: that of the measurement with the discrepancy of the model, that of the emulator, and that of the mesh (Craig, Goldstein,
//! Seheult and Smith 1997; Vernon, Goldstein and Bower, Bayesian Anal. 5, 2010). A place is ruled out if the implausibility of one measured
//! value is larger than [`History::cutoff`], or if all runs around it squeal where steady sliding was measured, or the other way round.

mod emulator;
mod history;
mod region;
mod states;
mod values;

pub use history::{Check, Fit, History};
pub use region::{Candidate, Region};
pub use values::{Assessment, Computed, Expected, LOG_FREQUENCY, Measured, Outcome, QUANTITIES, Run, Target};

#[cfg(test)]
mod tests;

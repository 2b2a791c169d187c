//! The application: studies, the steps of a sweep, and the command line, with the names of all other members.

#[cfg(feature = "sweep")]
pub mod calibration;
#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "cli")]
mod exit;
pub mod study;
#[cfg(feature = "sweep")]
pub mod sweep;
#[cfg(feature = "queue")]
pub mod worker;

pub use tribosweep_mechanics::{analysis, random, solver, spec, stability, units};
#[cfg(feature = "report")]
pub use tribosweep_output::{inspect, publish, report};
#[cfg(feature = "queue")]
pub use tribosweep_queue::queue;

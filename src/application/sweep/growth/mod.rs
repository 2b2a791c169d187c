//! The next jobs of studies that grow, from the results of those that have ended.
//!
//! ```text
//! rows of the study ──► series (jobs that differ along one way) ─────┬──► refine: curves, minima, boundaries ──┐
//!                                                                    └──► chains, kicks: jobs that continue ───┼──► wave
//! runs at measured points ──► emulators, region that is left ────────────► calibrate ───────────────────────────┘
//! ```
//!
//! A wave is a function of the study and of the results before it: the same study gets the same jobs, whoever plans them and
//! in whatever order results come in. Jobs that failed, or that have no value, are points where nothing is known.

mod calibrate;
mod chains;
mod findings;
mod planner;
mod refine;
mod series;

pub use findings::{read_growth, read_implausibility};
pub use planner::PLANNER;
pub(super) use series::{Series, along, name, position, rest, series_along};

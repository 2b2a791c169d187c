//! The complex modes of steady sliding over the grid of a study, and the values of a parameter, usually μ, at which sliding becomes
//! unstable or stable.
//!
//! ```text
//! plan of the modes ──► plan_thresholds (way, tolerance, stored points) ──► queue ──► points ──► report (thresholds, tables)
//!                                                                            │ ▲
//!                                                                            ▼ │ waves near the crossings
//!                                                                           growth
//! ```
//!
//! All points are jobs of an ordinary study, whose name ends in `-stability`, and which grows as other studies do. Points that were
//! computed before stay in it as long as the study has their speed and their other parameters.

mod along;
mod points;
mod thresholds;

pub use along::{way_of, ways as ways_to_thresholds};
pub use points::{name_of_modes, read_stability};
pub use thresholds::plan_thresholds;

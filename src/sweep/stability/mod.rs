//! The complex modes of steady sliding over the grid of a study, and the values of a parameter, usually μ, at which sliding becomes
//! unstable or stable.
//!
//! ```text
//! plan of the modes ──► StabilitySweep (ladder, stored points) ──► queue ──► points ──► report (thresholds, tables)
//!                                 ▲                                            │
//!                                 └───────── waves near the crossings ◄────────┘
//! ```
//!
//! All points are jobs of an ordinary study, whose name ends in `-stability`. It only grows: points that were computed
//! before stay in it as long as the study has their speed and their other parameters.

mod along;
mod ladder;
mod points;
mod sweep;
mod waves;

pub use along::{natural as natural_way, ways as ways_to_thresholds};
pub use points::{name_of_modes, read_stability};
pub use sweep::StabilitySweep;
pub use waves::WAVES;

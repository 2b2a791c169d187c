//! The complex modes of steady sliding over the grid of a study, and the friction coefficients at which sliding becomes
//! unstable.
//!
//! ```text
//! plan of the modes ──► StabilitySweep (ladder, stored points) ──► queue ──► points ──► report (thresholds, tables)
//!                                 ▲                                            │
//!                                 └───────── waves near the crossings ◄────────┘
//! ```
//!
//! All points are jobs of an ordinary study, whose name ends in `-stability`. It only grows: points that were computed
//! before stay in it as long as the study has their speed and their other parameters.

mod ladder;
mod points;
mod sweep;
mod waves;

pub use points::{name_of_modes, read_stability};
pub use sweep::StabilitySweep;
pub use waves::WAVES;

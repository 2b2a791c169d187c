//! Eigenvalues of steady sliding beside a run.

use super::record::SlidingStability;

/// Eigenvalues of a job that runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Noted {
    /// The eigenvalues.
    pub stability: SlidingStability,
    /// Whether a mode grows by more than its error.
    pub grows: bool,
}

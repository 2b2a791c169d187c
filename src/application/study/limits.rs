//! Limits of a study that keep typing errors from filling a database.

/// Largest number of grid points of a study.
pub const MAX_JOBS: usize = 1_000_000;

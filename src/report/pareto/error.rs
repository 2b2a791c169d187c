//! Why jobs cannot be compared.

/// There are no jobs that can be compared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ParetoError {
    /// Too few results.
    #[error(
        "jobs done: {done} of {jobs}; expected at least two done jobs of one physical case; \
         finish the study with `tribosweep run` first"
    )]
    TooFewDone {
        /// Jobs with a result.
        done: usize,
        /// Jobs in all.
        jobs: usize,
    },
    /// The rows do not say what their jobs' numerics are.
    #[error(
        "the database does not hold the numerics of these jobs: they were submitted by an earlier version of \
         tribosweep; submit the study again (its results are kept)"
    )]
    NoNumerics,
    /// Every physical case has a single job.
    #[error(
        "no two of the done jobs ({done}) are the same physical case: expected a study that varies numerics \
         (elements, safety_factor, time_step_s, beta2, stop_early, tolerance …) at fixed physics"
    )]
    OneJobACase {
        /// Jobs with a result.
        done: usize,
    },
    /// No run times.
    #[error(
        "none of the done jobs ({done}) has a run time (wall_s): expected one per job to compare errors with"
    )]
    NoRunTimes {
        /// Jobs with a result.
        done: usize,
    },
}

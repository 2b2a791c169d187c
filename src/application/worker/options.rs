//! Settings of a worker.

use super::eta::TYPICAL_S_PER_COST;
use super::planner::Planner;
use crate::spec::JobSpec;
use std::time::Duration;

/// The key of a job with this specification.
pub type JobKey = fn(&JobSpec) -> String;

/// Settings of a worker.
#[derive(Debug, Clone, Copy)]
pub struct WorkOptions {
    /// Number of threads.
    pub threads: usize,
    /// How often the state of a running job is stored; `None` if never. Only jobs that are predicted to last two
    /// intervals or more, by their time limit, are stored at all.
    pub checkpoint_interval: Option<Duration>,
    /// How long the worker stays when it has no job, because new jobs may come. Then it exits even if other workers are
    /// still running jobs, unless one of them has missed a heartbeat. `None`: it exits when all jobs have ended.
    pub idle_exit: Option<Duration>,
    /// The range of seconds of a thread per unit of a job's cost that is expected. The remaining time is estimated from it
    /// until jobs have finished.
    pub expected_s_per_cost: [f64; 2],
    /// The key that a job with this specification has. A job that was claimed under another key fails: its specification was
    /// changed, and its result would be stored as that of another scene. Without it, keys may be any names.
    pub job_key: Option<JobKey>,
    /// Plans the waves of studies that grow. Without it they do not grow here.
    pub planner: Option<&'static dyn Planner>,
}

impl WorkOptions {
    /// The default interval. A checkpoint costs milliseconds, and at most a minute's work is lost.
    pub const CHECKPOINT_INTERVAL: Duration = Duration::from_mins(1);

    /// The same settings with a planner, so that studies grow.
    #[must_use]
    pub fn growing(self, planner: &'static dyn Planner) -> Self {
        Self { planner: Some(planner), ..self }
    }

    /// The same settings with a check of keys.
    #[must_use]
    pub fn checking(self, job_key: JobKey) -> Self {
        Self { job_key: Some(job_key), ..self }
    }

    /// Settings with that number of threads and defaults otherwise.
    pub fn new(threads: usize) -> Self {
        Self {
            threads,
            checkpoint_interval: Some(Self::CHECKPOINT_INTERVAL),
            idle_exit: None,
            expected_s_per_cost: TYPICAL_S_PER_COST,
            job_key: None,
            planner: None,
        }
    }
}

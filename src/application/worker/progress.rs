//! How a worker reports its progress.

use super::eta::Eta;
use crate::queue::{Counts, Planned};

/// A job that is running now.
#[derive(Debug, Clone, PartialEq)]
pub struct RunningJob {
    /// Key of the job.
    pub key: String,
    /// Simulated time so far \[s\].
    pub simulated_s: f64,
    /// Simulated time at which it ends at the latest \[s\]; `None` before it has begun.
    pub limit_s: Option<f64>,
}

/// The state of a worker's jobs at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Jobs of the worker's scope in each state.
    pub counts: Counts,
    /// The jobs that this worker runs.
    pub running: Vec<RunningJob>,
    /// Remaining time; `None` if nothing is known of the jobs that are left.
    pub eta: Option<Eta>,
}

/// Receives the progress of a worker, on the thread that runs [`work`](super::work).
pub trait Progress {
    /// Called a few times a second and after every finished job.
    fn update(&mut self, snapshot: &Snapshot);

    /// Called when a job failed.
    fn failed(&mut self, key: &str, error: &str);

    /// Called when the worker has to wait for the database.
    fn waiting(&mut self, reason: &str) {
        let _ = reason;
    }

    /// Called when this worker has planned a wave of a study that grows.
    fn planned(&mut self, study: &str, wave: u64, planned: &Planned) {
        let _ = (study, wave, planned);
    }

    /// Called once, when the worker stops.
    fn stopped(&mut self, snapshot: &Snapshot);
}

/// Ignores all progress.
#[derive(Debug, Clone, Copy, Default)]
pub struct SilentProgress;

impl Progress for SilentProgress {
    fn update(&mut self, _: &Snapshot) {}
    fn failed(&mut self, _: &str, _: &str) {}
    fn stopped(&mut self, _: &Snapshot) {}
}

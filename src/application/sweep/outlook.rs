//! How far a study is, and when it will be finished.

use super::error::SweepError;
use super::forecast::expected_s_per_cost;
use crate::queue::{ActiveWorkers, Counts, Queue, Scope};
use crate::worker::{Eta, Left};
use std::num::NonZeroUsize;

/// What is left of a study that is not finished.
#[derive(Debug, Clone)]
pub struct Outlook {
    /// The study's jobs by state.
    pub counts: Counts,
    /// The workers that are running now.
    pub alive: ActiveWorkers,
    /// Number of threads that this machine can run at once.
    pub threads_here: usize,
    /// The remaining time with the workers that are running, or on this machine if none is; `None` if it is unknown.
    pub eta: Option<Eta>,
}

impl Outlook {
    /// Estimates the remaining time of a study with these `counts`; `None` if no job is left.
    ///
    /// # Errors
    /// If the database has no such study or cannot be read.
    pub async fn read(queue: &mut Queue, study: &str, counts: Counts) -> Result<Option<Self>, SweepError> {
        let left = counts.pending + counts.running;
        if left == 0 {
            return Ok(None);
        }
        let alive = queue.active_workers().await?;
        let threads_here = available_threads();
        let threads = if alive.threads > 0 { alive.threads } else { threads_here as u64 };
        let scope = Scope::Study(study.to_owned());
        let left = Left::new(counts, queue.remaining(&scope).await?, 0.0);
        let finished = queue.timings(&scope).await?;
        let expected = expected_s_per_cost(queue).await?;
        let eta = Eta::estimate(&finished, expected, left, threads as usize);
        Ok(Some(Self { counts, alive, threads_here, eta }))
    }

    /// The share of jobs that have ended, from 0 to 1. Cancelled jobs do not count.
    pub fn ended_share(&self) -> f64 {
        let Counts { done, failed, pending, running, .. } = self.counts;
        let ended = done + failed;
        ended as f64 / (ended + pending + running) as f64
    }
}

/// Number of threads that this machine can run at once; 1 if it is unknown.
pub fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

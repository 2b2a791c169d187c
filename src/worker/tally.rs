//! Counts for the display. Counting a hundred thousand jobs takes the database longer than storing a turn's
//! results, so this worker's own turns are counted here and the database is asked now and then, for what other
//! workers do.

use crate::queue::{Counts, FinishedOutcome, Queue, QueueError, Scope};
use std::time::{Duration, Instant};

/// Asked no more often than this …
const INTERVAL: Duration = Duration::from_millis(250);

/// … nor for more than a small part of the time.
const SHARE: u32 = 20;

/// Jobs by state and the cost of what is left.
#[derive(Debug)]
pub struct Tally {
    /// Jobs in each state.
    pub counts: Counts,
    /// The cost of what is pending or running.
    pub remaining_cost: f64,
    due: Instant,
}

impl Tally {
    /// Asks the database.
    pub async fn new(queue: &mut Queue, scope: &Scope) -> Result<Self, QueueError> {
        let mut tally = Self { counts: Counts::default(), remaining_cost: 0.0, due: Instant::now() };
        tally.ask(queue, scope).await?;
        Ok(tally)
    }

    /// Asks the database, if that is due; whether it was.
    pub async fn refresh(&mut self, queue: &mut Queue, scope: &Scope) -> Result<bool, QueueError> {
        let is_due = Instant::now() >= self.due;
        if is_due {
            self.ask(queue, scope).await?;
        }
        Ok(is_due)
    }

    /// Asks the database.
    pub async fn ask(&mut self, queue: &mut Queue, scope: &Scope) -> Result<(), QueueError> {
        let begun = Instant::now();
        self.counts = queue.counts(scope).await?;
        self.remaining_cost = queue.remaining_cost(scope).await?;
        self.due = Instant::now() + INTERVAL.max(begun.elapsed() * SHARE);
        Ok(())
    }

    /// Jobs were claimed.
    pub fn claimed(&mut self, jobs: u64) {
        self.counts.pending = self.counts.pending.saturating_sub(jobs);
        self.counts.running += jobs;
    }

    /// A job's end was stored.
    pub fn ended(&mut self, outcome: &FinishedOutcome, cost: f64) {
        self.counts.running = self.counts.running.saturating_sub(1);
        match outcome {
            FinishedOutcome::Done { .. } => self.counts.done += 1,
            FinishedOutcome::Failed { .. } => self.counts.failed += 1,
            FinishedOutcome::Released | FinishedOutcome::Unstarted => {
                self.counts.pending += 1;
                return;
            }
        }
        self.remaining_cost = (self.remaining_cost - cost).max(0.0);
    }
}

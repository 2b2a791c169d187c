//! Counts for the display. Counting a hundred thousand jobs takes the database longer than storing a turn's
//! results, so this worker's own turns are counted here and the database is asked now and then, for what other
//! workers do.

use crate::queue::{Counts, FinishedOutcome, Queue, QueueError, Scope};
use std::time::{Duration, Instant};

/// Asked no more often than this …
const INTERVAL: Duration = Duration::from_millis(250);

/// … and no more rarely than this, however long it takes …
const LONGEST: Duration = Duration::from_mins(1);

/// … nor for more than a small part of the time, which all workers share.
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

    /// Asks the database, if that is due. What is known already stays where it does not answer.
    pub async fn refresh(&mut self, queue: &mut Queue, scope: &Scope) -> Result<(), QueueError> {
        if Instant::now() < self.due {
            return Ok(());
        }
        match self.ask(queue, scope).await {
            Err(error) if error.is_transient() => {
                self.due = Instant::now() + INTERVAL;
                Ok(())
            }
            asked => asked,
        }
    }

    /// Asks the database.
    pub async fn ask(&mut self, queue: &mut Queue, scope: &Scope) -> Result<(), QueueError> {
        let begun = Instant::now();
        self.counts = queue.counts(scope).await?;
        self.remaining_cost = queue.remaining_cost(scope).await?;
        let took = begun.elapsed();
        let workers = u32::try_from(queue.active_workers().await?.workers).unwrap_or(u32::MAX).max(1);
        self.due = Instant::now()
            + took.saturating_mul(SHARE.saturating_mul(workers)).clamp(INTERVAL, LONGEST.max(took * SHARE));
        Ok(())
    }

    /// Something has changed: the next refresh asks.
    pub fn is_outdated(&mut self) {
        self.due = Instant::now();
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

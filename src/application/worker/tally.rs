//! Job counts for the display. To count a hundred thousand jobs takes the database longer than to store the results of
//! a turn. So the changes by this worker are counted here, and the database is queried now and then for the changes by
//! other workers.

use crate::queue::{Counts, FinishedOutcome, Queue, QueueError, Remaining, Scope};
use std::time::{Duration, Instant};

/// Shortest time between two queries.
const SHORTEST_PAUSE: Duration = Duration::from_millis(250);

/// Longest time between two queries, unless [`QUERY_SHARE`] demands more.
const LONGEST_PAUSE: Duration = Duration::from_mins(1);

/// Queries take at most one part in this many of the time, shared by all workers.
const QUERY_SHARE: u32 = 20;

/// Jobs by state and the cost of what is left.
#[derive(Debug)]
pub struct Tally {
    /// Jobs in each state.
    pub counts: Counts,
    /// What pending and running jobs cost.
    pub remaining: Remaining,
    next_query: Instant,
}

impl Tally {
    /// Queries the database.
    pub async fn new(queue: &mut Queue, scope: &Scope) -> Result<Self, QueueError> {
        let mut tally =
            Self { counts: Counts::default(), remaining: Remaining::default(), next_query: Instant::now() };
        tally.query(queue, scope).await?;
        Ok(tally)
    }

    /// Queries the database if a query is due. If it does not answer, the counts stay as they are.
    pub async fn refresh(&mut self, queue: &mut Queue, scope: &Scope) -> Result<(), QueueError> {
        if Instant::now() < self.next_query {
            return Ok(());
        }
        match self.query(queue, scope).await {
            Err(error) if error.is_transient() => {
                self.next_query = Instant::now() + SHORTEST_PAUSE;
                Ok(())
            }
            queried => queried,
        }
    }

    /// Queries the database.
    pub async fn query(&mut self, queue: &mut Queue, scope: &Scope) -> Result<(), QueueError> {
        let begun = Instant::now();
        self.counts = queue.counts(scope).await?;
        self.remaining = queue.remaining(scope).await?;
        let took = begun.elapsed();
        let workers = u32::try_from(queue.active_workers().await?.workers).unwrap_or(u32::MAX).max(1);
        self.next_query = Instant::now()
            + took
                .saturating_mul(QUERY_SHARE.saturating_mul(workers))
                .clamp(SHORTEST_PAUSE, LONGEST_PAUSE.max(took * QUERY_SHARE));
        Ok(())
    }

    /// Makes the next refresh query the database.
    pub fn invalidate(&mut self) {
        self.next_query = Instant::now();
    }

    /// Counts jobs that were claimed.
    pub fn add_claimed(&mut self, jobs: u64) {
        self.counts.pending = self.counts.pending.saturating_sub(jobs);
        self.counts.running += jobs;
    }

    /// Counts the end of a job, which was stored.
    pub fn add_ended(&mut self, outcome: &FinishedOutcome, cost: f64) {
        self.counts.running = self.counts.running.saturating_sub(1);
        match outcome {
            FinishedOutcome::Done { .. } => self.counts.done += 1,
            FinishedOutcome::Failed { .. } => self.counts.failed += 1,
            FinishedOutcome::Released | FinishedOutcome::Unstarted => {
                self.counts.pending += 1;
                return;
            }
        }
        if cost == 0.0 {
            self.remaining.without_cost = self.remaining.without_cost.saturating_sub(1);
        } else {
            self.remaining.cost = (self.remaining.cost - cost).max(0.0);
        }
    }
}

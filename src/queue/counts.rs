//! How many jobs there are, what they cost, and how long they took: what says how far the work is.

use super::engine::{Connection, Statement, query};
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;
use super::scope::Scope;
use super::state::JobState;
use serde::Serialize;

/// The number of jobs in each state. A job that several rows of a study point to counts once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Counts {
    /// Jobs that wait to be claimed.
    pub pending: u64,
    /// Claimed jobs.
    pub running: u64,
    /// Jobs that ended with a record.
    pub done: u64,
    /// Jobs that ended with an error.
    pub failed: u64,
    /// Jobs that no study requests any more.
    pub cancelled: u64,
}

/// The inner query comes first, so that the work depends on the size of the study and not on that of the database.
const OF_STUDY: &str = "
    SELECT j.state, COUNT(*)
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1) AS m
    JOIN jobs AS j ON j.id = m.job_id
    GROUP BY j.state";

const OF_ALL: &str = "SELECT state, COUNT(*) FROM jobs GROUP BY state";

const STARTS: &str = "
    SELECT CAST(COALESCE(SUM(j.attempt), 0) AS BIGINT)
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1) AS m
    JOIN jobs AS j ON j.id = m.job_id";

/// The costs of jobs differ by orders of magnitude, so their number is no measure of the time.
const REMAINING: &str = "
    SELECT COALESCE(SUM(cost), 0.0), COUNT(*) FILTER (WHERE cost = 0)
    FROM jobs WHERE state IN ('pending', 'running')";

const REMAINING_OF_STUDY: Statement = Statement::each(
    "
    SELECT p.cost + r.cost, p.without_cost + r.without_cost
    FROM (SELECT COALESCE(SUM(cost), 0.0) AS cost, COUNT(*) FILTER (WHERE cost = 0) AS without_cost
          FROM study_pending WHERE study_id = $1) AS p,
         (SELECT COALESCE(SUM(j.cost), 0.0) AS cost, COUNT(*) FILTER (WHERE j.cost = 0) AS without_cost
          FROM jobs AS j INDEXED BY jobs_owner
          WHERE j.state = 'running' AND j.owner IS NOT NULL
            AND EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id = $1)) AS r",
    "
    SELECT p.cost + r.cost, p.without_cost + r.without_cost
    FROM (SELECT COALESCE(SUM(cost), 0.0) AS cost, COUNT(*) FILTER (WHERE cost = 0) AS without_cost
          FROM study_pending WHERE study_id = $1) AS p,
         (SELECT COALESCE(SUM(j.cost), 0.0) AS cost, COUNT(*) FILTER (WHERE j.cost = 0) AS without_cost
          FROM jobs AS j
          WHERE j.state = 'running'
            AND EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id = $1)) AS r",
);

/// Every so many rows only: reading a row costs as much as its record is long.
const TIMINGS: &str = "
    SELECT j.cost, r.wall_s
    FROM jobs AS j
    JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt
    WHERE j.id % $1 = 0 AND j.state = 'done' AND r.wall_s IS NOT NULL";

const TIMINGS_OF_STUDY: &str = "
    SELECT j.cost, r.wall_s
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt
    WHERE m.study_id = $1 AND m.ordinal % $2 = 0 AND j.state = 'done' AND r.wall_s IS NOT NULL";

/// The largest number of sampled rows. More rows would not improve an estimate.
const MAX_SAMPLES: i64 = 1_000;

const COUNT_ROWS: &str = "SELECT COUNT(*) FROM jobs";

const COUNT_ROWS_OF_STUDY: &str = "SELECT COUNT(*) FROM study_jobs WHERE study_id = $1";

/// What the jobs that are pending or running cost.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Remaining {
    /// The sum of their costs.
    pub cost: f64,
    /// The number of jobs whose cost is zero.
    pub without_cost: u64,
}

impl Counts {
    /// The number of all jobs.
    pub fn total(&self) -> u64 {
        self.pending + self.running + self.done + self.failed + self.cancelled
    }

    fn from_rows(rows: Vec<(String, i64)>) -> Result<Self, QueueError> {
        let mut counts = Self::default();
        for (state, count) in rows {
            let count = count.unsigned_abs();
            match JobState::from_column(&state)? {
                JobState::Pending => counts.pending = count,
                JobState::Running => counts.running = count,
                JobState::Done => counts.done = count,
                JobState::Failed => counts.failed = count,
                JobState::Cancelled => counts.cancelled = count,
            }
        }
        Ok(counts)
    }
}

impl Queue {
    /// Counts the jobs of `scope` by state.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn counts(&mut self, scope: &Scope) -> Result<Counts, QueueError> {
        if let Some(id) = scope.study_id(&mut self.connection).await? {
            return of_study(&mut self.connection, id).await;
        }
        let rows = query(OF_ALL);
        Counts::from_rows(rows.all(&mut self.connection).await?)
    }

    /// How many times jobs of a study were started. While the study stays the same, this never decreases, except for
    /// jobs that are given back unstarted. Together with the counts by state it shows whether anything has changed,
    /// without reading results.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn starts(&mut self, study: &str) -> Result<u64, QueueError> {
        let study_id = lookup::require(&mut self.connection, study).await?;
        let starts: i64 = query(STARTS).bind(study_id).scalar(&mut self.connection).await?;
        Ok(starts.unsigned_abs())
    }

    /// The costs of all jobs of `scope` that are pending or running.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn remaining(&mut self, scope: &Scope) -> Result<Remaining, QueueError> {
        let study_id = scope.study_id(&mut self.connection).await?;
        let remaining = match study_id {
            None => query(REMAINING),
            Some(id) => query(REMAINING_OF_STUDY).bind(id),
        };
        let (cost, without_cost): (f64, i64) = remaining.one(&mut self.connection).await?;
        Ok(Remaining { cost, without_cost: without_cost.unsigned_abs() })
    }

    /// The cost and the run time in seconds of the done jobs of `scope`; of many, those of an even sample.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn timings(&mut self, scope: &Scope) -> Result<Vec<(f64, f64)>, QueueError> {
        let study_id = scope.study_id(&mut self.connection).await?;
        let rows = study_id.map_or_else(|| query(COUNT_ROWS), |id| query(COUNT_ROWS_OF_STUDY).bind(id));
        let rows: i64 = rows.scalar(&mut self.connection).await?;
        let every = 1 + rows / MAX_SAMPLES;
        let timings = match study_id {
            None => query(TIMINGS).bind(every),
            Some(id) => query(TIMINGS_OF_STUDY).bind(id).bind(every),
        };
        timings.all(&mut self.connection).await
    }
}

pub(super) async fn of_study(connection: &mut Connection, study_id: i64) -> Result<Counts, QueueError> {
    let rows = query(OF_STUDY).bind(study_id).all(connection).await?;
    Counts::from_rows(rows)
}

#[cfg(test)]
mod tests {
    use super::OF_ALL;
    use crate::queue::{Clock, Queue};

    /// Protects: jobs are counted from an index, and not from all rows of the table.
    #[tokio::test]
    async fn jobs_are_counted_from_an_index() {
        let folder = tempfile::TempDir::new().unwrap();
        let mut queue = Queue::open(folder.path().join("db"), Clock::OfDatabase).await.unwrap();
        let explain = sqlx::AssertSqlSafe(format!("EXPLAIN QUERY PLAN {OF_ALL}"));
        let plan: Vec<(i64, i64, i64, String)> =
            sqlx::query_as(explain).fetch_all(queue.connection.sqlite()).await.unwrap();
        let steps: Vec<_> = plan.iter().map(|(_, _, _, step)| step.as_str()).collect();
        assert_eq!(steps, ["SCAN jobs USING COVERING INDEX jobs_state"]);
    }
}

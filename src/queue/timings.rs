//! What an honest estimate of the time left needs: jobs differ in cost by orders of magnitude, so a mean
//! time per job says nothing, but time per cost does.

use super::{Queue, QueueError, Scope};

/// Failed jobs are left out: most of them stop early, and would make the rest look cheap.
const FINISHED: &str = "
    SELECT j.cost, r.wall_s
    FROM jobs AS j JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt
    WHERE j.state = 'done'
      AND (?1 IS NULL OR EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id = ?1))
    ORDER BY r.finished_ms, j.id";

const REMAINING: &str = "SELECT COALESCE(SUM(cost), 0.0) FROM jobs WHERE state IN ('pending', 'running')";

const REMAINING_OF_STUDY: &str = "
    SELECT (SELECT COALESCE(SUM(cost), 0.0) FROM study_pending WHERE study_id = ?1)
         + (SELECT COALESCE(SUM(j.cost), 0.0) FROM jobs AS j INDEXED BY jobs_owner
            WHERE j.state = 'running' AND j.owner IS NOT NULL
              AND EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id = ?1))";

impl Queue {
    /// Cost and wall time in seconds of every job of `scope` that is done, in the order they ended.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn finished_timings(&mut self, scope: &Scope) -> Result<Vec<(f64, f64)>, QueueError> {
        let study_id = scope.study_id(&mut self.connection).await?;
        Ok(sqlx::query_as(FINISHED).bind(study_id).fetch_all(&mut self.connection).await?)
    }

    /// The cost of all jobs of `scope` that are pending or running.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn remaining_cost(&mut self, scope: &Scope) -> Result<f64, QueueError> {
        let study_id = scope.study_id(&mut self.connection).await?;
        let remaining = match study_id {
            None => sqlx::query_scalar(REMAINING),
            Some(id) => sqlx::query_scalar(REMAINING_OF_STUDY).bind(id),
        };
        Ok(remaining.fetch_one(&mut self.connection).await?)
    }
}

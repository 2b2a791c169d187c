//! The cost of the jobs that are left. The costs of jobs differ by orders of magnitude, so their number is no measure
//! of the time.

use super::engine::{Statement, query};
use super::error::QueueError;
use super::handle::Queue;
use super::scope::Scope;

const REMAINING: &str = "SELECT COALESCE(SUM(cost), 0.0) FROM jobs WHERE state IN ('pending', 'running')";

const REMAINING_OF_STUDY: Statement = Statement::each(
    "
    SELECT (SELECT COALESCE(SUM(cost), 0.0) FROM study_pending WHERE study_id = $1)
         + (SELECT COALESCE(SUM(j.cost), 0.0) FROM jobs AS j INDEXED BY jobs_owner
            WHERE j.state = 'running' AND j.owner IS NOT NULL
              AND EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id = $1))",
    "
    SELECT (SELECT COALESCE(SUM(cost), 0.0) FROM study_pending WHERE study_id = $1)
         + (SELECT COALESCE(SUM(j.cost), 0.0) FROM jobs AS j
            WHERE j.state = 'running'
              AND EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id = $1))",
);

impl Queue {
    /// The sum of the costs of all jobs of `scope` that are pending or running.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn remaining_cost(&mut self, scope: &Scope) -> Result<f64, QueueError> {
        let study_id = scope.study_id(&mut self.connection).await?;
        let remaining = match study_id {
            None => query(REMAINING),
            Some(id) => query(REMAINING_OF_STUDY).bind(id),
        };
        remaining.scalar(&mut self.connection).await
    }
}

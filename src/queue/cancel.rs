use super::engine::{Statement, query};
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;

/// What a cancellation changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cancelled {
    /// Pending jobs that became cancelled.
    pub cancelled: u64,
    /// Jobs that stay pending because another study requests them.
    pub shared: u64,
    /// Running jobs. They run to their end, and their results are kept.
    pub running: u64,
}

const CANCEL_STUDY: &str = "UPDATE studies SET cancelled_ms = $2 WHERE id = $1";

/// A cancelled study requests no jobs.
const CANCEL_JOBS: &str = "
    UPDATE jobs SET state = 'cancelled', note = $2
    WHERE id IN (SELECT job_id FROM study_pending WHERE study_id = $1)
      AND NOT EXISTS (
          SELECT 1 FROM study_jobs AS m JOIN studies AS s ON s.id = m.study_id
          WHERE m.job_id = jobs.id AND s.cancelled_ms IS NULL
      )";

const SHARED: &str = "SELECT COUNT(*) FROM study_pending WHERE study_id = $1";

const RUNNING: Statement = Statement::each(
    "
    SELECT COUNT(*) FROM jobs AS j INDEXED BY jobs_owner
    WHERE j.state = 'running' AND j.owner IS NOT NULL
      AND EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id = $1)",
    "
    SELECT COUNT(*) FROM jobs AS j
    WHERE j.state = 'running'
      AND EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id = $1)",
);

const NOTE: &str = "cancelled: asked for by its user";

impl Queue {
    /// Cancels the pending jobs of a study that no other study requests.
    ///
    /// Running jobs continue, because their computing time is already spent. To stop a worker, interrupt its process.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be written.
    pub async fn cancel(&mut self, study: &str) -> Result<Cancelled, QueueError> {
        self.write(async |connection, now_ms| {
            let study_id = lookup::require(connection, study).await?;
            query(CANCEL_STUDY).bind(study_id).bind(now_ms).run(connection).await?;
            let cancelled = query(CANCEL_JOBS).bind(study_id).bind(NOTE).run(connection).await?;
            let shared: i64 = query(SHARED).bind(study_id).scalar(connection).await?;
            let running: i64 = query(RUNNING).bind(study_id).scalar(connection).await?;
            Ok(Cancelled { cancelled, shared: shared.unsigned_abs(), running: running.unsigned_abs() })
        })
        .await
    }
}

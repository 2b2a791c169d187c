use super::engine::query;
use super::{Queue, QueueError, studies};

/// What was removed with a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Removed {
    /// Rows of the study.
    pub rows: u64,
    /// Pending jobs that nobody asks for any more, which are cancelled.
    pub cancelled: u64,
}

const CANCEL_UNASKED: &str = "
    UPDATE jobs SET state = 'cancelled', note = $2
    WHERE id IN (SELECT job_id FROM study_pending WHERE study_id = $1)
      AND NOT EXISTS (
          SELECT 1 FROM study_jobs AS m JOIN studies AS s ON s.id = m.study_id
          WHERE m.job_id = jobs.id AND m.study_id <> $1 AND s.cancelled_ms IS NULL
      )";

const NOTE: &str = "cancelled: its study was removed";

impl Queue {
    /// Removes a study: its document and rows. Its jobs and their results stay until [`Queue::collect_garbage`].
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be written.
    pub async fn remove(&mut self, study: &str) -> Result<Removed, QueueError> {
        self.write(async |connection, _| {
            let study_id = studies::require(connection, study).await?;
            let cancelled = query(CANCEL_UNASKED).bind(study_id).bind(NOTE).run(connection).await?;
            let rows = query("DELETE FROM study_jobs WHERE study_id = $1").bind(study_id);
            let rows = rows.run(connection).await?;
            query("DELETE FROM studies WHERE id = $1").bind(study_id).run(connection).await?;
            Ok(Removed { rows, cancelled })
        })
        .await
    }
}

use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;

/// What the removal of a study changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Removed {
    /// Removed rows of the study.
    pub rows: u64,
    /// Pending jobs that became cancelled because no study requests them any more.
    pub cancelled: u64,
}

const CANCEL_UNREQUESTED: &str = "
    UPDATE jobs SET state = 'cancelled', note = $2
    WHERE id IN (SELECT job_id FROM study_pending WHERE study_id = $1)
      AND NOT EXISTS (
          SELECT 1 FROM study_jobs AS m JOIN studies AS s ON s.id = m.study_id
          WHERE m.job_id = jobs.id AND m.study_id <> $1 AND s.cancelled_ms IS NULL
      )";

const NOTE: &str = "cancelled: its study was removed";

impl Queue {
    /// Removes a study: its document and its rows. Its jobs and their results stay until [`Queue::collect_garbage`].
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be written.
    pub async fn remove(&mut self, study: &str) -> Result<Removed, QueueError> {
        self.write(async |connection, _| {
            let study_id = lookup::require(connection, study).await?;
            let cancelled = query(CANCEL_UNREQUESTED).bind(study_id).bind(NOTE).run(connection).await?;
            let rows = query("DELETE FROM study_jobs WHERE study_id = $1").bind(study_id);
            let rows = rows.run(connection).await?;
            query("DELETE FROM studies WHERE id = $1").bind(study_id).run(connection).await?;
            Ok(Removed { rows, cancelled })
        })
        .await
    }
}

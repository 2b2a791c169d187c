use super::engine::query;
use super::{Queue, QueueError};

/// What was dropped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Garbage {
    /// Jobs that no study refers to.
    pub jobs: u64,
    /// Their results.
    pub results: u64,
    /// Workers that have ended.
    pub workers: u64,
    /// Bytes by which the database became smaller.
    pub bytes: u64,
}

/// A running job is its worker's; it is dropped next time.
const UNREFERENCED: &str = "
    CREATE TEMP TABLE garbage AS
    SELECT id FROM jobs WHERE state <> 'running' AND id NOT IN (SELECT job_id FROM study_jobs)";

const WORKERS: &str = "
    DELETE FROM workers
    WHERE ended_ms IS NOT NULL AND id NOT IN (SELECT owner FROM jobs WHERE owner IS NOT NULL)";

impl Queue {
    /// Drops jobs that no study refers to, with their results, and gives their space back.
    ///
    /// # Errors
    /// If the database cannot be written.
    pub async fn collect_garbage(&mut self) -> Result<Garbage, QueueError> {
        let before = self.connection.size().await?;
        let mut garbage = self
            .write(async |connection, _| {
                query(UNREFERENCED).run(connection).await?;
                let mut deleted = async |statement: &'static str| query(statement).run(connection).await;
                deleted("DELETE FROM checkpoints WHERE job_id IN (SELECT id FROM garbage)").await?;
                deleted("DELETE FROM payloads WHERE job_id IN (SELECT id FROM garbage)").await?;
                let garbage = Garbage {
                    results: deleted("DELETE FROM results WHERE job_id IN (SELECT id FROM garbage)").await?,
                    jobs: deleted("DELETE FROM jobs WHERE id IN (SELECT id FROM garbage)").await?,
                    workers: deleted(WORKERS).await?,
                    bytes: 0,
                };
                deleted("DROP TABLE garbage").await?;
                Ok(garbage)
            })
            .await?;
        if garbage.jobs > 0 {
            self.connection.compact().await?;
        }
        garbage.bytes = before.saturating_sub(self.connection.size().await?);
        Ok(garbage)
    }
}

use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;

/// What garbage collection deleted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Garbage {
    /// Jobs that no study referred to.
    pub jobs: u64,
    /// Their results.
    pub results: u64,
    /// Workers that have ended.
    pub workers: u64,
    /// Bytes by which the database became smaller.
    pub bytes: u64,
}

/// A running job belongs to its worker. It is deleted by a later garbage collection.
const UNREFERENCED: &str = "
    CREATE TEMP TABLE garbage AS
    SELECT id FROM jobs WHERE state <> 'running' AND NOT EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = jobs.id)";

/// A worker that was declared dead may only have been disconnected. It is kept for a day (until $1) in case it comes
/// back.
const WORKERS: &str = "
    DELETE FROM workers
    WHERE ended_ms IS NOT NULL AND (ended_ms = heartbeat_ms OR heartbeat_ms < $1)
      AND NOT EXISTS (SELECT 1 FROM jobs AS j WHERE j.owner = workers.id AND j.state = 'running')";

const DAY_MS: i64 = 24 * 3600 * 1000;

impl Queue {
    /// Deletes jobs that no study refers to, with their results, and frees their space.
    ///
    /// # Errors
    /// If the database cannot be written.
    pub async fn collect_garbage(&mut self) -> Result<Garbage, QueueError> {
        let before = self.connection.size().await?;
        let mut garbage = self
            .write(async |connection, now_ms| {
                let workers = query(WORKERS).bind(now_ms - DAY_MS).run(connection).await?;
                query(UNREFERENCED).run(connection).await?;
                let mut deleted = async |statement: &'static str| query(statement).run(connection).await;
                deleted("DELETE FROM checkpoints WHERE job_id IN (SELECT id FROM garbage)").await?;
                deleted("DELETE FROM payloads WHERE job_id IN (SELECT id FROM garbage)").await?;
                let garbage = Garbage {
                    results: deleted("DELETE FROM results WHERE job_id IN (SELECT id FROM garbage)").await?,
                    jobs: deleted("DELETE FROM jobs WHERE id IN (SELECT id FROM garbage)").await?,
                    workers,
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

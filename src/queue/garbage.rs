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
        let before = self.pages().await?;
        let mut garbage = self
            .write(async |connection| {
                sqlx::query(UNREFERENCED).execute(&mut *connection).await?;
                let mut deleted = async |statement: &'static str| {
                    sqlx::query(statement).execute(&mut *connection).await.map(|done| done.rows_affected())
                };
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
            // The new database is built in the temporary store: not in memory.
            sqlx::query("PRAGMA temp_store = FILE").execute(&mut self.connection).await?;
            sqlx::query("VACUUM").execute(&mut self.connection).await?;
            sqlx::query("PRAGMA temp_store = MEMORY").execute(&mut self.connection).await?;
        }
        garbage.bytes = before.saturating_sub(self.pages().await?);
        Ok(garbage)
    }

    /// The size of the database in bytes.
    async fn pages(&mut self) -> Result<u64, QueueError> {
        let pages: i64 = sqlx::query_scalar("PRAGMA page_count").fetch_one(&mut self.connection).await?;
        let size: i64 = sqlx::query_scalar("PRAGMA page_size").fetch_one(&mut self.connection).await?;
        Ok((pages * size).unsigned_abs())
    }
}

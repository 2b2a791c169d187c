use super::engine::{Statement, query};
use super::error::QueueError;
use super::handle::Queue;

/// What garbage collection deleted, or would delete.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Garbage {
    /// Jobs that no study referred to.
    pub jobs: u64,
    /// Their results.
    pub results: u64,
    /// Workers that have ended.
    pub workers: u64,
    /// Bytes by which the database became smaller. In a preview, the bytes of the payloads, results and checkpoints: the
    /// database becomes smaller by about as much, or by more if it had free space.
    pub bytes: u64,
}

/// Jobs that no study refers to. A running job belongs to its worker. It is deleted by a later garbage collection.
macro_rules! unreferenced {
    () => {
        "
    SELECT id FROM jobs WHERE state <> 'running' AND NOT EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = jobs.id)"
    };
}

const UNREFERENCED: &str = concat!("CREATE TEMP TABLE garbage AS", unreferenced!());

/// A worker that was declared dead may only have been disconnected. It is kept for a day (until $1) in case it comes
/// back.
macro_rules! ended_workers {
    () => {
        "
    FROM workers
    WHERE ended_ms IS NOT NULL AND (ended_ms = heartbeat_ms OR heartbeat_ms < $1)
      AND NOT EXISTS (SELECT 1 FROM jobs AS j WHERE j.owner = workers.id AND j.state = 'running')"
    };
}

const WORKERS: &str = concat!("DELETE", ended_workers!());

/// Jobs, results, workers, and bytes of payloads, results and checkpoints. `SQLite`: the length of a text is in
/// characters, and that of a blob in bytes.
const PREVIEW: Statement = Statement::each(
    concat!(
        "
    WITH garbage AS (",
        unreferenced!(),
        ")
    SELECT (SELECT COUNT(*) FROM garbage),
           (SELECT COUNT(*) FROM results WHERE job_id IN (SELECT id FROM garbage)),
           (SELECT COUNT(*)",
        ended_workers!(),
        "),
           (SELECT COALESCE(SUM(length(CAST(payload AS BLOB))), 0) FROM payloads
            WHERE job_id IN (SELECT id FROM garbage))
           + (SELECT COALESCE(SUM(length(CAST(COALESCE(record, error) AS BLOB))), 0) FROM results
              WHERE job_id IN (SELECT id FROM garbage))
           + (SELECT COALESCE(SUM(length(bytes)), 0) FROM checkpoints WHERE job_id IN (SELECT id FROM garbage))"
    ),
    concat!(
        "
    WITH garbage AS (",
        unreferenced!(),
        ")
    SELECT (SELECT COUNT(*) FROM garbage),
           (SELECT COUNT(*) FROM results WHERE job_id IN (SELECT id FROM garbage)),
           (SELECT COUNT(*)",
        ended_workers!(),
        "),
           ((SELECT COALESCE(SUM(octet_length(payload)), 0) FROM payloads
             WHERE job_id IN (SELECT id FROM garbage))
            + (SELECT COALESCE(SUM(octet_length(COALESCE(record, error))), 0) FROM results
               WHERE job_id IN (SELECT id FROM garbage))
            + (SELECT COALESCE(SUM(octet_length(bytes)), 0) FROM checkpoints
               WHERE job_id IN (SELECT id FROM garbage)))::bigint"
    ),
);

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
                deleted("DELETE FROM final_states WHERE job_id IN (SELECT id FROM garbage)").await?;
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

    /// What [`Queue::collect_garbage`] would delete. Nothing is changed.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn preview_garbage(&mut self) -> Result<Garbage, QueueError> {
        let now_ms = self.now_ms().await?;
        let preview = query(PREVIEW).bind(now_ms - DAY_MS);
        let counts: (i64, i64, i64, i64) = preview.one(&mut self.connection).await?;
        let [jobs, results, workers, bytes] = [counts.0, counts.1, counts.2, counts.3].map(i64::unsigned_abs);
        Ok(Garbage { jobs, results, workers, bytes })
    }
}

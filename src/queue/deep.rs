//! Reading everything that a database has, to find what is damaged.

use super::digest::{self, Integrity};
use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;

/// A result of any attempt of any job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredResult {
    /// The job's key; empty if the job is missing.
    pub key: String,
    /// The number of the attempt.
    pub attempt: i64,
    /// Whether it is the result that counts, and not that of an earlier attempt.
    pub counts: bool,
    /// The record, of an attempt that ended with one.
    pub record: Option<String>,
    /// Whether record or error are as they were stored.
    pub integrity: Integrity,
}

/// What the executor of a job gets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredPayload {
    /// The job's key.
    pub key: String,
    /// The payload; none if it is missing.
    pub payload: Option<String>,
}

/// Rows that are read at a time.
const PAGE: i64 = 1_000;

/// A result after the attempt $2 of the job with the number $1.
const RESULTS: &str = "
    SELECT r.job_id, r.attempt, j.key, r.record, r.error, r.digest,
           CASE WHEN j.attempt = r.attempt AND j.state IN ('done', 'failed') THEN 1 ELSE 0 END
    FROM results AS r LEFT JOIN jobs AS j ON j.id = r.job_id
    WHERE r.job_id > $1 OR r.job_id = $1 AND r.attempt > $2
    ORDER BY r.job_id, r.attempt LIMIT $3";

type ResultColumns = (i64, i64, Option<String>, Option<String>, Option<String>, Option<String>, i32);

const PAYLOADS: &str = "
    SELECT j.id, j.key, p.payload FROM jobs AS j LEFT JOIN payloads AS p ON p.job_id = j.id
    WHERE j.id > $1 ORDER BY j.id LIMIT $2";

const FINAL_STATES: &str = "
    SELECT f.job_id, j.key, f.bytes, f.digest FROM final_states AS f LEFT JOIN jobs AS j ON j.id = f.job_id
    WHERE f.job_id > $1 ORDER BY f.job_id LIMIT 20";

type StateColumns = (i64, Option<String>, Vec<u8>, Option<String>);

const CHECKPOINTS: &str = "SELECT job_id, bytes FROM checkpoints WHERE job_id > $1 ORDER BY job_id LIMIT 20";

impl Queue {
    /// Calls `visit` with every result of every attempt.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn each_result(&mut self, mut visit: impl FnMut(StoredResult)) -> Result<(), QueueError> {
        let mut last = (i64::MIN, i64::MIN);
        loop {
            let page = query(RESULTS).bind(last.0).bind(last.1).bind(PAGE);
            let page: Vec<ResultColumns> = page.all(&mut self.connection).await?;
            let Some(row) = page.last() else { return Ok(()) };
            last = (row.0, row.1);
            for (_, attempt, key, record, error, digest, counts) in page {
                let key = key.unwrap_or_default();
                let expected = || digest::of_result(&key, record.as_deref(), error.as_deref());
                let integrity = Integrity::of(digest.as_deref(), expected);
                visit(StoredResult { key, attempt, counts: counts == 1, record, integrity });
            }
        }
    }

    /// Calls `visit` with every job's payload.
    ///
    /// # Errors
    /// As [`Self::each_result`].
    pub async fn each_payload(&mut self, mut visit: impl FnMut(StoredPayload)) -> Result<(), QueueError> {
        let mut last = i64::MIN;
        loop {
            let page = query(PAYLOADS).bind(last).bind(PAGE);
            let page: Vec<(i64, String, Option<String>)> = page.all(&mut self.connection).await?;
            let Some(row) = page.last() else { return Ok(()) };
            last = row.0;
            for (_, key, payload) in page {
                visit(StoredPayload { key, payload });
            }
        }
    }

    /// Calls `visit` with the key of every job whose final state is stored, and with whether that state is intact.
    ///
    /// # Errors
    /// As [`Self::each_result`].
    pub async fn each_final_state(
        &mut self,
        mut visit: impl FnMut(String, Integrity),
    ) -> Result<(), QueueError> {
        let mut last = i64::MIN;
        loop {
            let page: Vec<StateColumns> = query(FINAL_STATES).bind(last).all(&mut self.connection).await?;
            let Some(row) = page.last() else { return Ok(()) };
            last = row.0;
            for (_, key, bytes, digest) in page {
                let key = key.unwrap_or_default();
                let integrity = Integrity::of(digest.as_deref(), || digest::of_state(&key, &bytes));
                visit(key, integrity);
            }
        }
    }

    /// Reads all checkpoints and returns their number. Only their job can tell whether they are intact; if they are not, it
    /// begins anew.
    ///
    /// # Errors
    /// As [`Self::each_result`].
    pub async fn read_checkpoints(&mut self) -> Result<u64, QueueError> {
        let (mut last, mut read) = (i64::MIN, 0);
        loop {
            let page: Vec<(i64, Vec<u8>)> = query(CHECKPOINTS).bind(last).all(&mut self.connection).await?;
            let Some(row) = page.last() else { return Ok(read) };
            last = row.0;
            read += page.len() as u64;
        }
    }
}

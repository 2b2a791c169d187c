//! Reading everything that a database has, to find what is damaged.

use super::digest::{self, Integrity};
use super::engine::{columns, query};
use super::pages::Pages;

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

/// Whether the final state of a job is as it was stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredState {
    /// The job's key; empty if the job is missing.
    pub key: String,
    /// Whether it is as it was stored.
    pub integrity: Integrity,
}

/// Rows that are read at a time.
const PAGE: i64 = 1_000;

/// Rows that are read at a time if each of them may be large.
const LARGE_PAGE: i64 = 20;

/// A result after the attempt $2 of the job with the number $1.
const RESULTS: &str = "
    SELECT r.job_id, r.attempt, j.key, r.record, r.error, r.digest,
           CASE WHEN j.attempt = r.attempt AND j.state IN ('done', 'failed') THEN 1 ELSE 0 END AS counts
    FROM results AS r LEFT JOIN jobs AS j ON j.id = r.job_id
    WHERE r.job_id > $1 OR r.job_id = $1 AND r.attempt > $2
    ORDER BY r.job_id, r.attempt LIMIT $3";

columns! {
    struct ResultColumns {
        job_id: i64,
        attempt: i64,
        key: Option<String>,
        record: Option<String>,
        error: Option<String>,
        digest: Option<String>,
        counts: i32,
    }
}

impl ResultColumns {
    fn item(self) -> (Vec<i64>, StoredResult) {
        let Self { job_id, attempt, key, record, error, digest, counts } = self;
        let key = key.unwrap_or_default();
        let expected = || digest::of_result(&key, record.as_deref(), error.as_deref());
        let integrity = Integrity::of(digest.as_deref(), expected);
        let result = StoredResult { key, attempt, counts: counts == 1, record, integrity };
        (vec![job_id, attempt], result)
    }
}

const PAYLOADS: &str = "
    SELECT j.id, j.key, p.payload FROM jobs AS j LEFT JOIN payloads AS p ON p.job_id = j.id
    WHERE j.id > $1 ORDER BY j.id LIMIT $2";

const FINAL_STATES: &str = "
    SELECT f.job_id, j.key, f.bytes, f.digest FROM final_states AS f LEFT JOIN jobs AS j ON j.id = f.job_id
    WHERE f.job_id > $1 ORDER BY f.job_id LIMIT $2";

const CHECKPOINTS: &str = "SELECT job_id, bytes FROM checkpoints WHERE job_id > $1 ORDER BY job_id LIMIT $2";

/// Before all numbers of jobs and attempts, also those of a damaged table.
const BEFORE_ALL: i64 = i64::MIN;

impl Pages<StoredResult> {
    /// Every result of every attempt.
    pub fn of_results() -> Self {
        Self::of(query(RESULTS), &[BEFORE_ALL, BEFORE_ALL], PAGE, |row: ResultColumns| Ok(row.item()))
    }
}

impl Pages<StoredPayload> {
    /// Every job's payload.
    pub fn of_payloads() -> Self {
        let item = |(id, key, payload): (i64, _, _)| Ok((vec![id], StoredPayload { key, payload }));
        Self::of(query(PAYLOADS), &[BEFORE_ALL], PAGE, item)
    }
}

impl Pages<StoredState> {
    /// Every final state.
    pub fn of_final_states() -> Self {
        let item = |(id, key, bytes, digest): (i64, Option<String>, Vec<u8>, Option<String>)| {
            let key = key.unwrap_or_default();
            let integrity = Integrity::of(digest.as_deref(), || digest::of_state(&key, &bytes));
            Ok((vec![id], StoredState { key, integrity }))
        };
        Self::of(query(FINAL_STATES), &[BEFORE_ALL], LARGE_PAGE, item)
    }
}

impl Pages<usize> {
    /// The sizes of all checkpoints in bytes. Only their job can tell whether they are intact; if they are not, it begins anew.
    pub fn of_checkpoints() -> Self {
        Self::of(query(CHECKPOINTS), &[BEFORE_ALL], LARGE_PAGE, |(id, bytes): (i64, Vec<u8>)| {
            Ok((vec![id], bytes.len()))
        })
    }
}

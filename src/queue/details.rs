use sqlx::sqlite::SqliteRow;
use sqlx::{FromRow, Row};

use super::{JobState, Queue, QueueError};

/// All that is known of a job but its payload and record.
#[derive(Debug, Clone, PartialEq)]
pub struct JobDetails {
    /// Its key.
    pub key: String,
    /// Its state.
    pub state: JobState,
    /// Its priority.
    pub priority: i64,
    /// Its expected effort.
    pub cost: f64,
    /// What it can be run together with.
    pub batch: String,
    /// How many times it was started.
    pub attempt: u32,
    /// How many of its processes died in a row.
    pub crashes: u32,
    /// Why it last went back to pending, if it ever did.
    pub note: Option<String>,
    /// Why it failed, if it did.
    pub error: Option<String>,
    /// How long the attempt that ended took, in seconds, if that is known.
    pub wall_s: Option<f64>,
    /// When the last attempt began, in milliseconds since 1970-01-01 UTC.
    pub started_ms: Option<i64>,
    /// When it ended.
    pub finished_ms: Option<i64>,
    /// What the result was made with, as its worker told it.
    pub provenance: Option<String>,
    /// The names of the studies that have it.
    pub studies: Vec<String>,
}

/// Keys that begin with ?1: a range, so that the index is used, and no character of the key is a wildcard.
const JOBS: &str = "
    SELECT j.id, j.key, j.state, j.priority, j.cost, j.batch, j.attempt, j.crashes, j.note, j.started_ms,
           r.error, r.wall_s, r.finished_ms, r.provenance
    FROM jobs AS j
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt AND j.state IN ('done', 'failed')
    WHERE j.key >= ?1 AND substr(j.key, 1, length(?1)) = ?1
    ORDER BY j.key LIMIT ?2";

const STUDIES: &str = "
    SELECT name FROM studies WHERE id IN (SELECT study_id FROM study_jobs WHERE job_id = ?1) ORDER BY id";

struct Found {
    id: i64,
    details: JobDetails,
}

impl Queue {
    /// The jobs whose keys begin with `key`, at most `limit` of them.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn jobs(&mut self, key: &str, limit: u32) -> Result<Vec<JobDetails>, QueueError> {
        let found = sqlx::query_as(JOBS).bind(key).bind(limit);
        let found: Vec<Found> = found.fetch_all(&mut self.connection).await?;
        let mut jobs = Vec::with_capacity(found.len());
        for Found { id, mut details } in found {
            let studies = sqlx::query_scalar(STUDIES).bind(id);
            details.studies = studies.fetch_all(&mut self.connection).await?;
            jobs.push(details);
        }
        Ok(jobs)
    }
}

impl FromRow<'_, SqliteRow> for Found {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        let details = JobDetails {
            key: row.try_get("key")?,
            state: JobState::from_column(row.try_get("state")?),
            priority: row.try_get("priority")?,
            cost: row.try_get("cost")?,
            batch: row.try_get("batch")?,
            attempt: row.try_get("attempt")?,
            crashes: row.try_get("crashes")?,
            note: row.try_get("note")?,
            error: row.try_get("error")?,
            wall_s: row.try_get("wall_s")?,
            started_ms: row.try_get("started_ms")?,
            finished_ms: row.try_get("finished_ms")?,
            provenance: row.try_get("provenance")?,
            studies: Vec::new(),
        };
        Ok(Self { id: row.try_get("id")?, details })
    }
}

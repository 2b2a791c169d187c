use super::digest::{self, Integrity};
use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;
use super::state::JobState;
use super::unsigned::unsigned;
use serde::Serialize;

/// Everything about a job.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JobDetails {
    /// Its key.
    #[serde(rename = "job")]
    pub key: String,
    /// Its state.
    pub state: JobState,
    /// Its priority.
    pub priority: i64,
    /// Its expected effort.
    pub cost: f64,
    /// Its batch: jobs of the same batch can be run together.
    pub batch: String,
    /// How many times it was started.
    pub attempt: u32,
    /// How many of its processes died in succession, without a checkpoint in between.
    pub crashes: u32,
    /// Why it last went back to pending, if it ever did.
    pub note: Option<String>,
    /// Why it failed, if it did.
    pub error: Option<String>,
    /// How long the attempt that ended took, in seconds, if that is known.
    pub wall_s: Option<f64>,
    /// When the last attempt began, in milliseconds since 1970-01-01 UTC.
    pub started_ms: Option<i64>,
    /// When that attempt ended, in milliseconds since 1970-01-01 UTC.
    pub finished_ms: Option<i64>,
    /// What the result was made with, as its worker declared it.
    #[serde(skip)]
    pub provenance: Option<String>,
    /// What the executor needs to run the job.
    #[serde(skip)]
    pub payload: String,
    /// Its result, if it is done.
    #[serde(skip)]
    pub record: Option<String>,
    /// Whether the result is as it was stored.
    #[serde(skip)]
    pub integrity: Integrity,
    /// The names of the studies that contain it.
    #[serde(skip)]
    pub studies: Vec<String>,
}

/// Keys that begin with $1. The range condition makes the database use the index. `substr` is used instead of LIKE
/// because a key may contain wildcards. If $3 is not null, only jobs of that study.
const JOBS: &str = "
    SELECT j.id, j.key, j.state, j.priority, j.cost, j.batch, j.attempt, j.crashes, j.note, j.started_ms,
           r.error, r.wall_s, r.finished_ms, r.provenance, p.payload, r.record
    FROM jobs AS j
    JOIN payloads AS p ON p.job_id = j.id
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt AND j.state IN ('done', 'failed')
    WHERE j.key >= $1 AND substr(j.key, 1, length($1)) = $1
      AND ($3 IS NULL OR EXISTS (
          SELECT 1 FROM study_jobs AS m JOIN studies AS s ON s.id = m.study_id WHERE m.job_id = j.id AND s.name = $3))
    ORDER BY j.key LIMIT $2";

/// Of the attempt that ended.
const DIGEST: &str = "
    SELECT r.digest FROM results AS r JOIN jobs AS j ON j.id = r.job_id WHERE j.id = $1 AND r.attempt = j.attempt";

const STUDIES: &str = "
    SELECT name FROM studies WHERE id IN (SELECT study_id FROM study_jobs WHERE job_id = $1) ORDER BY id";

type Columns = (
    i64,
    String,
    String,
    i64,
    f64,
    String,
    i64,
    i64,
    Option<String>,
    Option<i64>,
    Option<String>,
    Option<f64>,
    Option<i64>,
    Option<String>,
    String,
    Option<String>,
);

impl Queue {
    /// The jobs whose keys begin with `key`, at most `limit` of them.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn jobs(&mut self, key: &str, limit: u32) -> Result<Vec<JobDetails>, QueueError> {
        self.jobs_of(None, key, limit).await
    }

    /// As [`Queue::jobs`], but only jobs of a study.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn jobs_in(
        &mut self,
        study: &str,
        key: &str,
        limit: u32,
    ) -> Result<Vec<JobDetails>, QueueError> {
        lookup::require(&mut self.connection, study).await?;
        self.jobs_of(Some(study), key, limit).await
    }

    async fn jobs_of(
        &mut self,
        study: Option<&str>,
        key: &str,
        limit: u32,
    ) -> Result<Vec<JobDetails>, QueueError> {
        let found = query(JOBS).bind(key).bind(limit).bind(study);
        let found: Vec<Columns> = found.all(&mut self.connection).await?;
        let mut jobs = Vec::with_capacity(found.len());
        for columns in found {
            let studies = query(STUDIES).bind(columns.0).scalars(&mut self.connection).await?;
            let digest: Option<(Option<String>,)> =
                query(DIGEST).bind(columns.0).optional(&mut self.connection).await?;
            jobs.push(details(columns, studies, digest.as_ref().and_then(|(digest,)| digest.as_deref()))?);
        }
        Ok(jobs)
    }
}

fn details(columns: Columns, studies: Vec<String>, digest: Option<&str>) -> Result<JobDetails, QueueError> {
    let (
        _,
        key,
        state,
        priority,
        cost,
        batch,
        attempt,
        crashes,
        note,
        started_ms,
        error,
        wall_s,
        finished_ms,
        provenance,
        payload,
        record,
    ) = columns;
    let has_result = record.is_some() || error.is_some();
    let expected = || digest::of_result(&key, record.as_deref(), error.as_deref());
    let integrity = Integrity::of(digest.filter(|_| has_result), expected);
    Ok(JobDetails {
        key,
        state: JobState::from_column(&state)?,
        priority,
        cost,
        batch,
        attempt: unsigned(attempt),
        crashes: unsigned(crashes),
        note,
        error,
        wall_s,
        started_ms,
        finished_ms,
        provenance,
        payload,
        record,
        integrity,
        studies,
    })
}

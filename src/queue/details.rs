use super::digest::{self, Integrity};
use super::engine::{columns, query};
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
           r.error, r.wall_s, r.finished_ms, r.provenance, p.payload, r.record, r.digest
    FROM jobs AS j
    JOIN payloads AS p ON p.job_id = j.id
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt AND j.state IN ('done', 'failed')
    WHERE j.key >= $1 AND substr(j.key, 1, length($1)) = $1
      AND ($3 IS NULL OR EXISTS (
          SELECT 1 FROM study_jobs AS m JOIN studies AS s ON s.id = m.study_id WHERE m.job_id = j.id AND s.name = $3))
    ORDER BY j.key LIMIT $2";

const STUDIES: &str = "
    SELECT name FROM studies WHERE id IN (SELECT study_id FROM study_jobs WHERE job_id = $1) ORDER BY id";

columns! {
    struct JobColumns {
        id: i64,
        key: String,
        state: String,
        priority: i64,
        cost: f64,
        batch: String,
        attempt: i64,
        crashes: i64,
        note: Option<String>,
        started_ms: Option<i64>,
        error: Option<String>,
        wall_s: Option<f64>,
        finished_ms: Option<i64>,
        provenance: Option<String>,
        payload: String,
        record: Option<String>,
        digest: Option<String>,
    }
}

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
        let found: Vec<JobColumns> = found.all(&mut self.connection).await?;
        let mut jobs = Vec::with_capacity(found.len());
        for job in found {
            let studies = query(STUDIES).bind(job.id).scalars(&mut self.connection).await?;
            jobs.push(job.with_studies(studies)?);
        }
        Ok(jobs)
    }
}

impl JobColumns {
    fn with_studies(self, studies: Vec<String>) -> Result<JobDetails, QueueError> {
        let has_result = self.record.is_some() || self.error.is_some();
        let expected = || digest::of_result(&self.key, self.record.as_deref(), self.error.as_deref());
        let integrity = Integrity::of(self.digest.as_deref().filter(|_| has_result), expected);
        Ok(JobDetails {
            key: self.key,
            state: JobState::from_column(&self.state)?,
            priority: self.priority,
            cost: self.cost,
            batch: self.batch,
            attempt: unsigned(self.attempt),
            crashes: unsigned(self.crashes),
            note: self.note,
            error: self.error,
            wall_s: self.wall_s,
            started_ms: self.started_ms,
            finished_ms: self.finished_ms,
            provenance: self.provenance,
            payload: self.payload,
            record: self.record,
            integrity,
            studies,
        })
    }
}

use super::digest::{self, Integrity};
use super::engine::{Statement, columns, query};
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;
use super::pages::Pages;
use super::state::JobState;
use super::unsigned::unsigned;
use serde::Deserialize;

/// One row of a study with the data of its job that reports need. [`Queue::jobs`] returns more about a single job.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRow {
    /// The row's number in the study, from 0.
    pub ordinal: u64,
    /// The job's key; several rows may share it.
    pub key: String,
    /// The row's parameters as submitted.
    pub parameters: String,
    /// The job's state.
    pub state: JobState,
    /// The job's result, if it is done.
    pub record: Option<String>,
    /// Why the job failed, if it did.
    pub error: Option<String>,
    /// Whether the record or the error is as it was stored.
    pub integrity: Integrity,
    /// How long the attempt that ended took, in seconds, if that is known.
    pub wall_s: Option<f64>,
    /// How many times the job was started.
    pub attempt: u32,
    /// How many of its processes died in succession, without a checkpoint in between.
    pub crashes: u32,
    /// Why the job last went back to pending, if it ever did.
    pub note: Option<String>,
    /// What the executor needs to run the job, if it was asked for.
    pub payload: Option<String>,
}

/// The result of the job's last attempt. A job that is pending again may have results of earlier attempts, which do not
/// count.
///
/// The short values are one column in JSON, because reading a column costs more than the value in it. (Except the time:
/// in JSON it would have 15 digits only.)
///
/// If $2 is not null, only rows whose jobs are in that state; if $3 is not null, only those whose jobs have that label. The
/// payloads are read only if $4 is 1.
const ROWS: Statement = Statement::each(
    "
    SELECT json_array(j.key, j.state, r.error, j.attempt, j.crashes, j.note, r.digest) AS short,
           m.ordinal, m.parameters, r.record, r.wall_s,
           CASE WHEN $4 = 1 THEN (SELECT p.payload FROM payloads AS p WHERE p.job_id = j.id) END AS payload
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt AND j.state IN ('done', 'failed')
    WHERE m.study_id = $1 AND m.ordinal > $5 AND ($2 IS NULL OR j.state = $2)
      AND ($3 IS NULL OR j.label = $3)
    ORDER BY m.ordinal
    LIMIT $6",
    "
    SELECT json_build_array(j.key, j.state, r.error, j.attempt, j.crashes, j.note, r.digest)::text AS short,
           m.ordinal, m.parameters, r.record, r.wall_s,
           CASE WHEN $4 = 1 THEN (SELECT p.payload FROM payloads AS p WHERE p.job_id = j.id) END AS payload
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt AND j.state IN ('done', 'failed')
    WHERE m.study_id = $1 AND m.ordinal > $5 AND ($2 IS NULL OR j.state = $2)
      AND ($3 IS NULL OR j.label = $3)
    ORDER BY m.ordinal
    LIMIT $6",
);

/// The first row of study $1 with the job $2.
const PARAMETERS_OF_JOB: &str = "
    SELECT m.parameters
    FROM study_jobs AS m
    JOIN studies AS s ON s.id = m.study_id
    JOIN jobs AS j ON j.id = m.job_id
    WHERE s.name = $1 AND j.key = $2
    ORDER BY m.ordinal LIMIT 1";

const PARAMETERS: &str = "
    SELECT ordinal, parameters FROM study_jobs WHERE study_id = $1 AND ordinal > $2 ORDER BY ordinal LIMIT $3";

/// Rows that are read at a time.
const PAGE: i64 = 1_000;

/// The number before that of a study's first row.
const BEFORE_ALL: [i64; 1] = [-1];

/// Which rows of a study.
#[derive(Debug, Clone, Copy)]
pub enum Rows<'a> {
    /// All of them.
    All,
    /// Rows whose jobs have failed.
    Failed,
    /// Rows whose jobs are done with this label.
    Done(&'a str),
}

columns! {
    struct RowColumns {
        short: String,
        ordinal: i64,
        parameters: String,
        record: Option<String>,
        wall_s: Option<f64>,
        payload: Option<String>,
    }
}

/// The short values, in the order of the list in JSON.
#[derive(Deserialize)]
struct Short {
    key: String,
    state: String,
    error: Option<String>,
    attempt: i64,
    crashes: i64,
    note: Option<String>,
    digest: Option<String>,
}

impl RowColumns {
    fn item(self) -> Result<(Vec<i64>, StudyRow), QueueError> {
        let Self { short, ordinal, parameters, record, wall_s, payload } = self;
        let Short { key, state, error, attempt, crashes, note, digest } =
            serde_json::from_str(&short).map_err(|error| QueueError::Database(error.into()))?;
        let expected = || digest::of_result(&key, record.as_deref(), error.as_deref());
        let integrity = Integrity::of(digest.as_deref(), expected);
        let row = StudyRow {
            ordinal: ordinal.unsigned_abs(),
            key,
            parameters,
            state: JobState::from_column(&state)?,
            record,
            error,
            integrity,
            wall_s,
            attempt: unsigned(attempt),
            crashes: unsigned(crashes),
            note,
            payload,
        };
        Ok((vec![ordinal], row))
    }
}

impl Queue {
    /// The rows of a study, in the order of its document.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn rows(&mut self, study: &str) -> Result<Vec<StudyRow>, QueueError> {
        let pages = self.pages_of_rows(study, Rows::All).await?;
        self.all_pages(pages).await
    }

    /// The rows of a study page by page, in the order of its document.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn pages_of_rows(
        &mut self,
        study: &str,
        which: Rows<'_>,
    ) -> Result<Pages<StudyRow>, QueueError> {
        self.pages(study, which, false).await
    }

    /// All rows of a study, as [`Queue::pages_of_rows`], with the payloads of the jobs.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn pages_with_payloads(&mut self, study: &str) -> Result<Pages<StudyRow>, QueueError> {
        self.pages(study, Rows::All, true).await
    }

    async fn pages(
        &mut self,
        study: &str,
        which: Rows<'_>,
        with_payloads: bool,
    ) -> Result<Pages<StudyRow>, QueueError> {
        let study_id = lookup::require(&mut self.connection, study).await?;
        let (state, label) = match which {
            Rows::All => (None, None),
            Rows::Failed => (Some(JobState::Failed), None),
            Rows::Done(label) => (Some(JobState::Done), Some(label.to_owned())),
        };
        let rows = query(ROWS).bind(study_id).bind(state.map(JobState::as_str)).bind(label);
        Ok(Pages::of(rows.bind(i64::from(with_payloads)), &BEFORE_ALL, PAGE, RowColumns::item))
    }

    /// The parameters of each row of a study page by page, in the order of its document. Records, which are most of the data of rows,
    /// are not read.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn pages_of_parameters(&mut self, study: &str) -> Result<Pages<String>, QueueError> {
        let study_id = lookup::require(&mut self.connection, study).await?;
        let item = |(ordinal, parameters): (i64, String)| Ok((vec![ordinal], parameters));
        Ok(Pages::of(query(PARAMETERS).bind(study_id), &BEFORE_ALL, PAGE, item))
    }

    /// The parameters of a job in a study: those of its first row there, if it has one.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn parameters(&mut self, study: &str, key: &str) -> Result<Option<String>, QueueError> {
        let found = query(PARAMETERS_OF_JOB).bind(study).bind(key);
        Ok(found.optional(&mut self.connection).await?.map(|(parameters,)| parameters))
    }
}

use std::ops::ControlFlow;

use super::digest::{self, Integrity};
use super::engine::{Statement, query};
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;
use super::state::JobState;
use super::unsigned::unsigned;

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
/// If $4 is not null, only rows whose jobs are in that state; if $5 is not null, only those whose jobs have that label. The
/// payloads are read only if $6 is 1.
const ROWS: Statement = Statement::each(
    "
    SELECT json_array(m.ordinal, j.key, j.state, r.error, j.attempt, j.crashes, j.note, r.digest), m.parameters, r.record, r.wall_s,
           CASE WHEN $6 = 1 THEN (SELECT p.payload FROM payloads AS p WHERE p.job_id = j.id) END
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt AND j.state IN ('done', 'failed')
    WHERE m.study_id = $1 AND m.ordinal > $2 AND ($4 IS NULL OR j.state = $4)
      AND ($5 IS NULL OR j.label = $5)
    ORDER BY m.ordinal
    LIMIT $3",
    "
    SELECT json_build_array(m.ordinal, j.key, j.state, r.error, j.attempt, j.crashes, j.note, r.digest)::text,
           m.parameters, r.record, r.wall_s,
           CASE WHEN $6 = 1 THEN (SELECT p.payload FROM payloads AS p WHERE p.job_id = j.id) END
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt AND j.state IN ('done', 'failed')
    WHERE m.study_id = $1 AND m.ordinal > $2 AND ($4 IS NULL OR j.state = $4)
      AND ($5 IS NULL OR j.label = $5)
    ORDER BY m.ordinal
    LIMIT $3",
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

/// Rows that are read at a time. Reading all rows at once would prevent checkpoints of the write-ahead log meanwhile,
/// and would need memory for all of them.
const PAGE: i64 = 1_000;

/// The number before that of a study's first row.
const BEFORE_ALL: i64 = -1;

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

impl Queue {
    /// The rows of a study, in the order of its document.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn rows(&mut self, study: &str) -> Result<Vec<StudyRow>, QueueError> {
        let mut rows = Vec::new();
        self.each_page(study, Rows::All, |page| {
            rows.extend(page);
            ControlFlow::Continue(())
        })
        .await?;
        Ok(rows)
    }

    /// Calls `visit` with the rows of a study, page by page, in the order of its document. `visit` can stop the
    /// reading.
    ///
    /// A change that is made meanwhile is visible in later pages only.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn each_page(
        &mut self,
        study: &str,
        which: Rows<'_>,
        visit: impl FnMut(Vec<StudyRow>) -> ControlFlow<()>,
    ) -> Result<(), QueueError> {
        self.pages(study, which, false, visit).await
    }

    /// As [`Queue::each_page`], with the payloads of the jobs.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn each_page_with_payloads(
        &mut self,
        study: &str,
        which: Rows<'_>,
        visit: impl FnMut(Vec<StudyRow>) -> ControlFlow<()>,
    ) -> Result<(), QueueError> {
        self.pages(study, which, true, visit).await
    }

    async fn pages(
        &mut self,
        study: &str,
        which: Rows<'_>,
        with_payloads: bool,
        mut visit: impl FnMut(Vec<StudyRow>) -> ControlFlow<()>,
    ) -> Result<(), QueueError> {
        let study_id = lookup::require(&mut self.connection, study).await?;
        let (state, label) = match which {
            Rows::All => (None, None),
            Rows::Failed => (Some(JobState::Failed), None),
            Rows::Done(label) => (Some(JobState::Done), Some(label)),
        };
        // Rows are read after the last one, because the largest number has none after it.
        let mut last = BEFORE_ALL;
        loop {
            let page = query(ROWS).bind(study_id).bind(last).bind(PAGE);
            let page = page.bind(state.map(JobState::as_str)).bind(label).bind(i64::from(with_payloads));
            let page: Vec<Columns> = page.all(&mut self.connection).await?;
            let page = page.into_iter().map(StudyRow::from_columns).collect::<Result<Vec<_>, _>>()?;
            let Some(row) = page.last() else { return Ok(()) };
            last = row.ordinal.cast_signed();
            if visit(page).is_break() {
                return Ok(());
            }
        }
    }

    /// The parameters of a job in a study: those of its first row there, if it has one.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn parameters(&mut self, study: &str, key: &str) -> Result<Option<String>, QueueError> {
        let found = query(PARAMETERS_OF_JOB).bind(study).bind(key);
        Ok(found.optional(&mut self.connection).await?.map(|(parameters,)| parameters))
    }

    /// Calls `visit` with the parameters of each row of a study, in the order of its document. It does not read the
    /// records, which are most of the data of rows.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn each_parameters(
        &mut self,
        study: &str,
        mut visit: impl FnMut(&str),
    ) -> Result<(), QueueError> {
        let study_id = lookup::require(&mut self.connection, study).await?;
        // Rows are read after the last one, because the largest number has none after it.
        let mut last = BEFORE_ALL;
        loop {
            let page = query(PARAMETERS).bind(study_id).bind(last).bind(PAGE);
            let page: Vec<(i64, String)> = page.all(&mut self.connection).await?;
            let Some((ordinal, _)) = page.last() else { return Ok(()) };
            last = *ordinal;
            for (_, parameters) in &page {
                visit(parameters);
            }
        }
    }
}

/// The short values, parameters, record, time and payload.
type Columns = (String, String, Option<String>, Option<f64>, Option<String>);

impl StudyRow {
    fn from_columns((short, parameters, record, wall_s, payload): Columns) -> Result<Self, QueueError> {
        type Short = (u64, String, String, Option<String>, i64, i64, Option<String>, Option<String>);
        let (ordinal, key, state, error, attempt, crashes, note, digest): Short =
            serde_json::from_str(&short).map_err(|error| QueueError::Database(error.into()))?;
        let state = JobState::from_column(&state)?;
        let expected = || digest::of_result(&key, record.as_deref(), error.as_deref());
        let integrity = Integrity::of(digest.as_deref(), expected);
        let (attempt, crashes) = (unsigned(attempt), unsigned(crashes));
        Ok(Self {
            ordinal,
            key,
            parameters,
            state,
            record,
            error,
            integrity,
            wall_s,
            attempt,
            crashes,
            note,
            payload,
        })
    }
}

use std::ops::ControlFlow;

use sqlx::sqlite::SqliteRow;
use sqlx::{FromRow, Row};

use super::{JobState, Queue, QueueError, studies};

/// One row of a study with what is known of its job.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRow {
    /// Place in the study, from 0.
    pub ordinal: u64,
    /// The job's key; several rows may share it.
    pub key: String,
    /// The row's parameters as submitted.
    pub parameters: String,
    /// The job's state.
    pub state: JobState,
    /// What the job found, if it is done.
    pub record: Option<String>,
    /// Why the job failed, if it did.
    pub error: Option<String>,
    /// How long the attempt that ended took, in seconds, if that is known.
    pub wall_s: Option<f64>,
    /// How many times the job was started.
    pub attempt: u32,
    /// How many of its processes died in a row.
    pub crashes: u32,
    /// Why the job last went back to pending, if it ever did.
    pub note: Option<String>,
    /// When the attempt that ended began, in milliseconds since 1970-01-01 UTC, if that is known.
    pub started_ms: Option<i64>,
    /// When it ended.
    pub finished_ms: Option<i64>,
    /// What the result was made with, as its worker told it.
    pub provenance: Option<String>,
}

/// A job that is to be tried again has results of earlier attempts, which say nothing of this one.
///
/// Without ?4, all rows; with it, those whose jobs are in that state, and with ?5 those of them whose records have ?6
/// there.
const ROWS: &str = "
    SELECT m.ordinal, j.key, m.parameters, j.state, r.record, r.error, r.wall_s, j.attempt, j.crashes, j.note,
           r.started_ms, r.finished_ms, r.provenance
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt AND j.state IN ('done', 'failed')
    WHERE m.study_id = ?1 AND m.ordinal >= ?2 AND (?4 IS NULL OR j.state = ?4)
      AND (?5 IS NULL OR IIF(json_valid(r.record), r.record ->> ?5, NULL) = ?6)
    ORDER BY m.ordinal
    LIMIT ?3";

const PARAMETERS: &str = "
    SELECT ordinal, parameters FROM study_jobs WHERE study_id = ?1 AND ordinal >= ?2 ORDER BY ordinal LIMIT ?3";

/// Rows that are read at a time: a reader that takes all at once keeps the write-ahead log from being folded back
/// meanwhile, and needs the memory for all.
const PAGE: i64 = 1_000;

/// Which rows.
#[derive(Clone, Copy)]
enum Filter<'a> {
    All,
    Failed,
    Recorded { path: &'a str, value: &'a str },
}

impl Queue {
    /// The rows of a study, in the order of its document.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn rows(&mut self, study: &str) -> Result<Vec<StudyRow>, QueueError> {
        self.collect(study, Filter::All).await
    }

    /// Those rows of a study whose jobs have failed, in the order of its document.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn failed_rows(&mut self, study: &str) -> Result<Vec<StudyRow>, QueueError> {
        self.collect(study, Filter::Failed).await
    }

    /// Those done rows of a study whose records, which are JSON to whoever asks, have that value at `path`, in the order
    /// of its document.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn recorded_rows(
        &mut self,
        study: &str,
        path: &str,
        value: &str,
    ) -> Result<Vec<StudyRow>, QueueError> {
        self.collect(study, Filter::Recorded { path, value }).await
    }

    /// Shows the rows of a study to `look`, in the order of its document, some at a time: for those who do not need
    /// them all at once. It may say that it has seen enough.
    ///
    /// What changes meanwhile is seen in later rows and not in earlier ones.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn each_page(
        &mut self,
        study: &str,
        look: impl FnMut(Vec<StudyRow>) -> ControlFlow<()>,
    ) -> Result<(), QueueError> {
        self.row_pages(study, Filter::All, look).await
    }

    /// Shows the parameters of a study's rows to `look`, in the order of its document: without what their jobs have
    /// found, which is most of what rows are.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn each_parameters(
        &mut self,
        study: &str,
        mut look: impl FnMut(&str),
    ) -> Result<(), QueueError> {
        let study_id = studies::require(&mut self.connection, study).await?;
        let mut next = 0_i64;
        loop {
            let page = sqlx::query_as(PARAMETERS).bind(study_id).bind(next).bind(PAGE);
            let page: Vec<(i64, String)> = page.fetch_all(&mut self.connection).await?;
            let Some((last, _)) = page.last() else { return Ok(()) };
            next = last + 1;
            for (_, parameters) in &page {
                look(parameters);
            }
        }
    }

    async fn collect(&mut self, study: &str, filter: Filter<'_>) -> Result<Vec<StudyRow>, QueueError> {
        let mut rows = Vec::new();
        self.row_pages(study, filter, |page| {
            rows.extend(page);
            ControlFlow::Continue(())
        })
        .await?;
        Ok(rows)
    }

    async fn row_pages(
        &mut self,
        study: &str,
        filter: Filter<'_>,
        mut look: impl FnMut(Vec<StudyRow>) -> ControlFlow<()>,
    ) -> Result<(), QueueError> {
        let study_id = studies::require(&mut self.connection, study).await?;
        let (state, path, value) = match filter {
            Filter::All => (None, None, None),
            Filter::Failed => (Some(JobState::Failed), None, None),
            Filter::Recorded { path, value } => (Some(JobState::Done), Some(path), Some(value)),
        };
        let mut next = 0_i64;
        loop {
            let page = sqlx::query_as(ROWS).bind(study_id).bind(next).bind(PAGE);
            let page = page.bind(state.map(JobState::as_str)).bind(path).bind(value);
            let page: Vec<StudyRow> = page.fetch_all(&mut self.connection).await?;
            let Some(last) = page.last() else { return Ok(()) };
            next = last.ordinal.cast_signed() + 1;
            if look(page).is_break() {
                return Ok(());
            }
        }
    }
}

impl FromRow<'_, SqliteRow> for StudyRow {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        // By place, not by name: looking names up takes as long as reading.
        Ok(Self {
            ordinal: row.try_get::<i64, _>(0)?.unsigned_abs(),
            key: row.try_get(1)?,
            parameters: row.try_get(2)?,
            state: JobState::from_column(row.try_get(3)?),
            record: row.try_get(4)?,
            error: row.try_get(5)?,
            wall_s: row.try_get(6)?,
            attempt: row.try_get(7)?,
            crashes: row.try_get(8)?,
            note: row.try_get(9)?,
            started_ms: row.try_get(10)?,
            finished_ms: row.try_get(11)?,
            provenance: row.try_get(12)?,
        })
    }
}

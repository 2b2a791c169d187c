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
const ROWS: &str = "
    SELECT m.ordinal, j.key, m.parameters, j.state, r.record, r.error, r.wall_s, j.attempt, j.crashes, j.note,
           r.started_ms, r.finished_ms, r.provenance
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt AND j.state IN ('done', 'failed')
    WHERE m.study_id = ?1 AND m.ordinal >= ?2
    ORDER BY m.ordinal
    LIMIT ?3";

/// Rows that are read at a time: a reader that takes all at once keeps the write-ahead log from being folded back
/// meanwhile, and needs the memory for all.
const PAGE: i64 = 1_000;

impl Queue {
    /// The rows of a study, in the order of its document.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn rows(&mut self, study: &str) -> Result<Vec<StudyRow>, QueueError> {
        let mut rows = Vec::new();
        self.each_row(study, |row| rows.push(row)).await?;
        Ok(rows)
    }

    /// Shows the rows of a study to `look`, in the order of its document, one at a time: for those who do not need
    /// them all at once.
    ///
    /// What changes meanwhile is seen in later rows and not in earlier ones.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn each_row(&mut self, study: &str, mut look: impl FnMut(StudyRow)) -> Result<(), QueueError> {
        let study_id = studies::require(&mut self.connection, study).await?;
        let mut next = 0_i64;
        loop {
            let page = sqlx::query_as(ROWS).bind(study_id).bind(next).bind(PAGE);
            let page: Vec<StudyRow> = page.fetch_all(&mut self.connection).await?;
            let Some(last) = page.last() else { return Ok(()) };
            next = last.ordinal.cast_signed() + 1;
            page.into_iter().for_each(&mut look);
        }
    }
}

impl FromRow<'_, SqliteRow> for StudyRow {
    fn from_row(row: &SqliteRow) -> Result<Self, sqlx::Error> {
        Ok(Self {
            ordinal: row.try_get::<i64, _>("ordinal")?.unsigned_abs(),
            key: row.try_get("key")?,
            parameters: row.try_get("parameters")?,
            state: JobState::from_column(row.try_get("state")?),
            record: row.try_get("record")?,
            error: row.try_get("error")?,
            wall_s: row.try_get("wall_s")?,
            attempt: row.try_get("attempt")?,
            crashes: row.try_get("crashes")?,
            note: row.try_get("note")?,
            started_ms: row.try_get("started_ms")?,
            finished_ms: row.try_get("finished_ms")?,
            provenance: row.try_get("provenance")?,
        })
    }
}

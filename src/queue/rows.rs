use std::ops::ControlFlow;

use super::engine::{Statement, query};
use super::{JobState, Queue, QueueError, studies};

/// One row of a study with what reports show of its job; [`Queue::jobs`] knows more of a single one.
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
}

/// A job that is to be tried again has results of earlier attempts, which say nothing of this one.
///
/// All that is short comes in one column: every value that is handed on costs more than what is in it. (Not the time:
/// JSON has it to 15 digits.)
///
/// Without $4, all rows; with it, those whose jobs are in that state, and with $5 those of them with that label.
const ROWS: Statement = Statement::each(
    "
    SELECT json_array(m.ordinal, j.key, j.state, r.error, j.attempt, j.crashes, j.note), m.parameters, r.record, r.wall_s
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt AND j.state IN ('done', 'failed')
    WHERE m.study_id = $1 AND m.ordinal >= $2 AND ($4 IS NULL OR j.state = $4)
      AND ($5 IS NULL OR j.label = $5)
    ORDER BY m.ordinal
    LIMIT $3",
    "
    SELECT json_build_array(m.ordinal, j.key, j.state, r.error, j.attempt, j.crashes, j.note)::text,
           m.parameters, r.record, r.wall_s
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt AND j.state IN ('done', 'failed')
    WHERE m.study_id = $1 AND m.ordinal >= $2 AND ($4 IS NULL OR j.state = $4)
      AND ($5 IS NULL OR j.label = $5)
    ORDER BY m.ordinal
    LIMIT $3",
);

const PARAMETERS: &str = "
    SELECT ordinal, parameters FROM study_jobs WHERE study_id = $1 AND ordinal >= $2 ORDER BY ordinal LIMIT $3";

/// Rows that are read at a time: a reader that takes all at once keeps the write-ahead log from being folded back
/// meanwhile, and needs the memory for all.
const PAGE: i64 = 1_000;

/// Which rows of a study.
#[derive(Debug, Clone, Copy)]
pub enum Rows<'a> {
    /// All of them.
    All,
    /// Those whose jobs have failed.
    Failed,
    /// Those whose jobs are done with this label.
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

    /// Shows rows of a study to `look`, in the order of its document, some at a time: for those who do not need them all
    /// at once. It may say that it has seen enough.
    ///
    /// What changes meanwhile is seen in later rows and not in earlier ones.
    ///
    /// # Errors
    /// As [`Queue::rows`].
    pub async fn each_page(
        &mut self,
        study: &str,
        which: Rows<'_>,
        mut look: impl FnMut(Vec<StudyRow>) -> ControlFlow<()>,
    ) -> Result<(), QueueError> {
        let study_id = studies::require(&mut self.connection, study).await?;
        let (state, label) = match which {
            Rows::All => (None, None),
            Rows::Failed => (Some(JobState::Failed), None),
            Rows::Done(label) => (Some(JobState::Done), Some(label)),
        };
        let mut next = 0_i64;
        loop {
            let page = query(ROWS).bind(study_id).bind(next).bind(PAGE);
            let page = page.bind(state.map(JobState::as_str)).bind(label);
            let page: Vec<Columns> = page.all(&mut self.connection).await?;
            let page = page.into_iter().map(StudyRow::from_columns).collect::<Result<Vec<_>, _>>()?;
            let Some(last) = page.last() else { return Ok(()) };
            next = last.ordinal.cast_signed() + 1;
            if look(page).is_break() {
                return Ok(());
            }
        }
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
            let page = query(PARAMETERS).bind(study_id).bind(next).bind(PAGE);
            let page: Vec<(i64, String)> = page.all(&mut self.connection).await?;
            let Some((last, _)) = page.last() else { return Ok(()) };
            next = last + 1;
            for (_, parameters) in &page {
                look(parameters);
            }
        }
    }
}

/// The short ones, parameters, record and time.
type Columns = (String, String, Option<String>, Option<f64>);

impl StudyRow {
    fn from_columns((short, parameters, record, wall_s): Columns) -> Result<Self, QueueError> {
        type Short = (u64, String, String, Option<String>, u32, u32, Option<String>);
        let (ordinal, key, state, error, attempt, crashes, note): Short =
            serde_json::from_str(&short).map_err(|error| sqlx::Error::Decode(error.into()))?;
        let state = JobState::from_column(&state);
        Ok(Self { ordinal, key, parameters, state, record, error, wall_s, attempt, crashes, note })
    }
}

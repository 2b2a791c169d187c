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
    /// How long the attempt that ended took, in seconds.
    pub wall_s: Option<f64>,
    /// How many times the job was started.
    pub attempt: u32,
    /// Why the job last went back to pending, if it ever did.
    pub note: Option<String>,
}

const ROWS: &str = "
    SELECT m.ordinal, j.key, m.parameters, j.state, r.record, r.error, r.wall_s, j.attempt, j.note
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    LEFT JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt
    WHERE m.study_id = ?1
    ORDER BY m.ordinal";

type Columns =
    (i64, String, String, String, Option<String>, Option<String>, Option<f64>, u32, Option<String>);

impl Queue {
    /// The rows of a study, in the order of its document.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn rows(&mut self, study: &str) -> Result<Vec<StudyRow>, QueueError> {
        let study_id = studies::require(&mut self.connection, study).await?;
        let rows: Vec<Columns> = sqlx::query_as(ROWS).bind(study_id).fetch_all(&mut self.connection).await?;
        Ok(rows.into_iter().map(StudyRow::from).collect())
    }
}

impl From<Columns> for StudyRow {
    fn from((ordinal, key, parameters, state, record, error, wall_s, attempt, note): Columns) -> Self {
        Self {
            ordinal: ordinal.unsigned_abs(),
            key,
            parameters,
            state: JobState::from_column(&state),
            record,
            error,
            wall_s,
            attempt,
            note,
        }
    }
}

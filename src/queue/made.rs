use super::engine::query;
use super::{Queue, QueueError, studies};

/// Results of a study that were made with the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MadeWith {
    /// What they were made with, as their worker told it.
    pub provenance: Option<String>,
    /// How many jobs they belong to.
    pub jobs: u64,
    /// When the first of them was finished, in milliseconds since 1970-01-01 UTC.
    pub first_finished_ms: i64,
    /// When the last of them was finished.
    pub last_finished_ms: i64,
}

/// Of the attempts of a job, the one that counts. A job that several rows point to counts once.
const MADE: &str = "
    SELECT r.provenance, COUNT(*), MIN(r.finished_ms), MAX(r.finished_ms)
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1) AS m
    JOIN jobs AS j ON j.id = m.job_id
    JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt
    WHERE j.state IN ('done', 'failed')
    GROUP BY r.provenance
    ORDER BY MIN(r.finished_ms)";

impl Queue {
    /// What the results of a study were made with, the earliest first.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn made_with(&mut self, study: &str) -> Result<Vec<MadeWith>, QueueError> {
        let study_id = studies::require(&mut self.connection, study).await?;
        let made = query(MADE).bind(study_id);
        let made: Vec<(Option<String>, i64, i64, i64)> = made.all(&mut self.connection).await?;
        let made = made.into_iter().map(|(provenance, jobs, first_finished_ms, last_finished_ms)| MadeWith {
            provenance,
            jobs: jobs.unsigned_abs(),
            first_finished_ms,
            last_finished_ms,
        });
        Ok(made.collect())
    }
}

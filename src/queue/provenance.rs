use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;

/// Results of a study that have the same provenance.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProvenanceGroup {
    /// What the results were made with, as their worker declared it.
    pub provenance: Option<String>,
    /// How many jobs have these results.
    pub jobs: u64,
    /// When the first of the jobs was finished, in milliseconds since 1970-01-01 UTC.
    pub first_finished_ms: i64,
    /// When the last of the jobs was finished, in milliseconds since 1970-01-01 UTC.
    pub last_finished_ms: i64,
}

/// Only the last attempt of a job counts. A job that several rows point to counts once.
const GROUPS: &str = "
    SELECT r.provenance, COUNT(*), MIN(r.finished_ms), MAX(r.finished_ms)
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1) AS m
    JOIN jobs AS j ON j.id = m.job_id
    JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt
    WHERE j.state IN ('done', 'failed')
    GROUP BY r.provenance
    ORDER BY MIN(r.finished_ms)";

impl Queue {
    /// The results of a study, grouped by provenance and ordered by the groups' first finish.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn provenance_groups(&mut self, study: &str) -> Result<Vec<ProvenanceGroup>, QueueError> {
        let study_id = lookup::require(&mut self.connection, study).await?;
        let groups: Vec<(Option<String>, i64, i64, i64)> =
            query(GROUPS).bind(study_id).all(&mut self.connection).await?;
        let group = |(provenance, jobs, first_finished_ms, last_finished_ms): (_, i64, _, _)| {
            ProvenanceGroup { provenance, jobs: jobs.unsigned_abs(), first_finished_ms, last_finished_ms }
        };
        Ok(groups.into_iter().map(group).collect())
    }
}

use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;

const STARTS: &str = "
    SELECT CAST(COALESCE(SUM(j.attempt), 0) AS BIGINT)
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1) AS m
    JOIN jobs AS j ON j.id = m.job_id";

impl Queue {
    /// How many times jobs of a study were started. While the study stays the same, this never decreases, except for
    /// jobs that are given back unstarted. Together with the counts by state it shows whether anything has changed,
    /// without reading results.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn starts(&mut self, study: &str) -> Result<u64, QueueError> {
        let study_id = lookup::require(&mut self.connection, study).await?;
        let starts: i64 = query(STARTS).bind(study_id).scalar(&mut self.connection).await?;
        Ok(starts.unsigned_abs())
    }
}

use super::engine::query;
use super::{Queue, QueueError, studies};

const STARTS: &str = "
    SELECT CAST(COALESCE(SUM(j.attempt), 0) AS BIGINT)
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1) AS m
    JOIN jobs AS j ON j.id = m.job_id";

impl Queue {
    /// How many times jobs of a study were started. It never falls while the study is the same: with the counts by state
    /// it tells whether anything has changed, without reading results.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn starts(&mut self, study: &str) -> Result<u64, QueueError> {
        let study_id = studies::require(&mut self.connection, study).await?;
        let starts: i64 = query(STARTS).bind(study_id).scalar(&mut self.connection).await?;
        Ok(starts.unsigned_abs())
    }
}

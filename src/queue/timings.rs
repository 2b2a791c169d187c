use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;

/// Every $2-th row only: reading a row costs as much as its record is long.
const TIMINGS: &str = "
    SELECT j.cost, r.wall_s
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt
    WHERE m.study_id = $1 AND m.ordinal % $2 = 0 AND j.state = 'done' AND r.wall_s IS NOT NULL";

/// The largest number of sampled rows. More rows would not improve an estimate.
const MAX_SAMPLES: i64 = 1_000;

const ROWS: &str = "SELECT COUNT(*) FROM study_jobs WHERE study_id = $1";

impl Queue {
    /// The cost and the run time in seconds of a study's done jobs; for a large study, those of an even sample.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn timings(&mut self, study: &str) -> Result<Vec<(f64, f64)>, QueueError> {
        let study_id = lookup::require(&mut self.connection, study).await?;
        let rows: i64 = query(ROWS).bind(study_id).scalar(&mut self.connection).await?;
        let every = 1 + rows / MAX_SAMPLES;
        query(TIMINGS).bind(study_id).bind(every).all(&mut self.connection).await
    }
}

use super::engine::query;
use super::{Queue, QueueError, studies};

/// Every $2-th row: the rows of a large study are read at the length of their records.
const TIMINGS: &str = "
    SELECT j.cost, r.wall_s
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt
    WHERE m.study_id = $1 AND m.ordinal % $2 = 0 AND j.state = 'done' AND r.wall_s IS NOT NULL";

/// No more rows than this are looked at: more would make no estimate better.
const LOOKED_AT: i64 = 1_000;

const ROWS: &str = "SELECT COUNT(*) FROM study_jobs WHERE study_id = $1";

impl Queue {
    /// The cost and the seconds of jobs of a study that are done; of a large study an even sample.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn timings(&mut self, study: &str) -> Result<Vec<(f64, f64)>, QueueError> {
        let study_id = studies::require(&mut self.connection, study).await?;
        let rows: i64 = query(ROWS).bind(study_id).scalar(&mut self.connection).await?;
        let every = 1 + rows / LOOKED_AT;
        query(TIMINGS).bind(study_id).bind(every).all(&mut self.connection).await
    }
}

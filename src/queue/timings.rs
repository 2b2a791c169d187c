use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::scope::Scope;

/// Every so many rows only: reading a row costs as much as its record is long.
const TIMINGS: &str = "
    SELECT j.cost, r.wall_s
    FROM jobs AS j
    JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt
    WHERE j.id % $1 = 0 AND j.state = 'done' AND r.wall_s IS NOT NULL";

const TIMINGS_OF_STUDY: &str = "
    SELECT j.cost, r.wall_s
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    JOIN results AS r ON r.job_id = j.id AND r.attempt = j.attempt
    WHERE m.study_id = $1 AND m.ordinal % $2 = 0 AND j.state = 'done' AND r.wall_s IS NOT NULL";

/// The largest number of sampled rows. More rows would not improve an estimate.
const MAX_SAMPLES: i64 = 1_000;

const ROWS: &str = "SELECT COUNT(*) FROM jobs";

const ROWS_OF_STUDY: &str = "SELECT COUNT(*) FROM study_jobs WHERE study_id = $1";

impl Queue {
    /// The cost and the run time in seconds of the done jobs of `scope`; of many, those of an even sample.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn timings(&mut self, scope: &Scope) -> Result<Vec<(f64, f64)>, QueueError> {
        let study_id = scope.study_id(&mut self.connection).await?;
        let rows = study_id.map_or_else(|| query(ROWS), |id| query(ROWS_OF_STUDY).bind(id));
        let rows: i64 = rows.scalar(&mut self.connection).await?;
        let every = 1 + rows / MAX_SAMPLES;
        let timings = match study_id {
            None => query(TIMINGS).bind(every),
            Some(id) => query(TIMINGS_OF_STUDY).bind(id).bind(every),
        };
        timings.all(&mut self.connection).await
    }
}

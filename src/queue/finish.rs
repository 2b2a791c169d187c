use sqlx::SqliteConnection;

use super::{JobState, QueueError};

/// The end of one attempt.
#[derive(Debug, Clone, PartialEq)]
pub struct Finished {
    /// The job.
    pub key: String,
    /// The attempt, as it was claimed.
    pub attempt: u32,
    /// How it ended.
    pub outcome: FinishedOutcome,
    /// How long it took, in seconds.
    pub wall_s: f64,
}

/// How an attempt ended.
#[derive(Debug, Clone, PartialEq)]
pub enum FinishedOutcome {
    /// With a result.
    Done {
        /// The result.
        record: String,
    },
    /// Without a result, and the same would happen again.
    Failed {
        /// What went wrong.
        error: String,
    },
    /// Stopped or never begun because of an interruption: the job is pending again.
    Released,
}

const RELEASED: &str = "released: the work was interrupted before the job ended";

// The fence, `state = 'running' AND attempt = …`, is in every statement that ends an attempt: whoever lost
// the job in the meantime changes nothing, and learns of it from the number of rows.
const INSERT_RESULT: &str = "
    INSERT INTO results (job_id, attempt, record, error, wall_s, finished_ms)
    SELECT id, attempt, ?3, ?4, ?5, ?6 FROM jobs WHERE key = ?1 AND state = 'running' AND attempt = ?2";

const END: &str = "UPDATE jobs SET state = ?3 WHERE key = ?1 AND state = 'running' AND attempt = ?2";

const RELEASE: &str =
    "UPDATE jobs SET state = 'pending', note = ?3 WHERE key = ?1 AND state = 'running' AND attempt = ?2";

/// Stores the end of an attempt; `false` if the job is not running that attempt.
pub(super) async fn store(
    connection: &mut SqliteConnection,
    finished: &Finished,
    now_ms: i64,
) -> Result<bool, QueueError> {
    let (state, record, error) = match &finished.outcome {
        FinishedOutcome::Done { record } => (JobState::Done, Some(record), None),
        FinishedOutcome::Failed { error } => (JobState::Failed, None, Some(error)),
        FinishedOutcome::Released => {
            let released = sqlx::query(RELEASE).bind(&finished.key).bind(finished.attempt).bind(RELEASED);
            return Ok(released.execute(connection).await?.rows_affected() == 1);
        }
    };
    let inserted = sqlx::query(INSERT_RESULT)
        .bind(&finished.key)
        .bind(finished.attempt)
        .bind(record)
        .bind(error)
        .bind(finished.wall_s)
        .bind(now_ms)
        .execute(&mut *connection)
        .await?;
    if inserted.rows_affected() == 0 {
        return Ok(false);
    }
    let ended = sqlx::query(END).bind(&finished.key).bind(finished.attempt).bind(state.as_str());
    Ok(ended.execute(connection).await?.rows_affected() == 1)
}

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
    /// Stopped because of an interruption: the job is pending again, with its checkpoint if it has one.
    Released,
    /// Claimed, but not begun: the job is pending again, as if it had not been claimed.
    Unstarted,
}

/// Which attempt of whom an operation is about.
///
/// Its condition, `state = 'running' AND owner = … AND attempt = …`, is in every statement that speaks for an
/// attempt: whoever lost the job in the meantime changes nothing, and learns of it from the number of rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fence<'a> {
    pub key: &'a str,
    pub attempt: u32,
    pub owner: i64,
}

const RELEASED: &str = "released: the work was interrupted before the job ended";

const INSERT_RESULT: &str = "
    INSERT INTO results (job_id, attempt, record, error, wall_s, started_ms, finished_ms, provenance)
    SELECT id, attempt, ?4, ?5, ?6, started_ms, ?7, ?8 FROM jobs
    WHERE key = ?1 AND state = 'running' AND attempt = ?2 AND owner = ?3";

const END: &str = "
    UPDATE jobs SET state = ?4, owner = NULL, lease_until_ms = NULL
    WHERE key = ?1 AND state = 'running' AND attempt = ?2 AND owner = ?3";

const RELEASE: &str = "
    UPDATE jobs SET state = 'pending', owner = NULL, lease_until_ms = NULL, note = ?4
    WHERE key = ?1 AND state = 'running' AND attempt = ?2 AND owner = ?3";

const UNDO: &str = "
    UPDATE jobs SET state = 'pending', owner = NULL, lease_until_ms = NULL, attempt = attempt - 1
    WHERE key = ?1 AND state = 'running' AND attempt = ?2 AND owner = ?3";

/// Stores the end of an attempt; `false` if the job is not running that attempt.
pub(super) async fn store(
    connection: &mut SqliteConnection,
    fence: Fence<'_>,
    finished: &Finished,
    provenance: &str,
    now_ms: i64,
) -> Result<bool, QueueError> {
    let Fence { key, attempt, owner } = fence;
    let fenced = |statement: &'static str| sqlx::query(statement).bind(key).bind(attempt).bind(owner);
    let (state, record, error) = match &finished.outcome {
        FinishedOutcome::Done { record } => (JobState::Done, Some(record), None),
        FinishedOutcome::Failed { error } => (JobState::Failed, None, Some(error)),
        FinishedOutcome::Released => {
            return Ok(fenced(RELEASE).bind(RELEASED).execute(connection).await?.rows_affected() == 1);
        }
        FinishedOutcome::Unstarted => {
            return Ok(fenced(UNDO).execute(connection).await?.rows_affected() == 1);
        }
    };
    let inserted = fenced(INSERT_RESULT)
        .bind(record)
        .bind(error)
        .bind(finished.wall_s)
        .bind(now_ms)
        .bind(provenance)
        .execute(&mut *connection)
        .await?;
    if inserted.rows_affected() == 0 {
        return Ok(false);
    }
    let ended = fenced(END).bind(state.as_str()).execute(connection).await?;
    Ok(ended.rows_affected() == 1)
}

use super::engine::query;
use super::{Queue, QueueError, studies};

/// Which jobs to try again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Retry {
    /// Those that failed.
    Failed,
    /// Those that failed or were cancelled.
    All,
}

/// What a retry changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Retried {
    /// Failed jobs that are pending now.
    pub failed: u64,
    /// Cancelled jobs that are pending now.
    pub cancelled: u64,
}

const ASK_AGAIN: &str = "UPDATE studies SET cancelled_ms = NULL WHERE id = $1";

/// Old results stay as what they are, the ends of earlier attempts.
const PENDING_AGAIN: &str = "
    UPDATE jobs SET state = 'pending', crashes = 0, note = $3
    WHERE state = $2 AND id IN (SELECT job_id FROM study_jobs WHERE study_id = $1)";

const NOTE: &str = "to be tried again: asked for by its user";

impl Queue {
    /// Makes jobs of a study that have failed or were cancelled pending again, in their crash count as if new.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be written.
    pub async fn retry(&mut self, study: &str, which: Retry) -> Result<Retried, QueueError> {
        self.write(async |connection, _| {
            let study_id = studies::require(connection, study).await?;
            let mut retried = Retried::default();
            let again = |state: &'static str| query(PENDING_AGAIN).bind(study_id).bind(state).bind(NOTE);
            retried.failed = again("failed").run(connection).await?;
            if which == Retry::All {
                query(ASK_AGAIN).bind(study_id).run(connection).await?;
                retried.cancelled = again("cancelled").run(connection).await?;
            }
            Ok(retried)
        })
        .await
    }
}

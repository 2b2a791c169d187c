use super::engine::query;
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;
use super::plan_rows;
use super::take_back::TakenBack;

/// Which jobs to run again.
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
    /// Jobs of workers that are gone, of any study. They were taken back first.
    pub taken_back: TakenBack,
    /// Failed jobs that became pending.
    pub failed: u64,
    /// Cancelled jobs that became pending.
    pub cancelled: u64,
}

const UNDO_CANCELLATION: &str = "UPDATE studies SET cancelled_ms = NULL WHERE id = $1";

/// Old results stay as the results of earlier attempts.
const PENDING_AGAIN: &str = "
    UPDATE jobs SET state = 'pending', crashes = 0, note = $3
    WHERE state = $2 AND id IN (SELECT job_id FROM study_jobs WHERE study_id = $1)";

const NOTE: &str = "to be tried again: asked for by its user";

impl Queue {
    /// Makes failed, or failed and cancelled, jobs of a study pending again and resets their crash counts. Before that,
    /// it takes back the jobs of workers that are gone ([`Queue::take_back`]): a job may count as failed only then.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be written.
    pub async fn retry(&mut self, study: &str, which: Retry) -> Result<Retried, QueueError> {
        lookup::require(&mut self.connection, study).await?;
        let taken_back = self.take_back().await?;
        self.write(async |connection, _| {
            let study_id = lookup::require(connection, study).await?;
            let mut retried = Retried { taken_back, ..Retried::default() };
            let again = |state: &'static str| query(PENDING_AGAIN).bind(study_id).bind(state).bind(NOTE);
            retried.failed = again("failed").run(connection).await?;
            plan_rows::reopen(connection, study_id).await?;
            if which == Retry::All {
                query(UNDO_CANCELLATION).bind(study_id).run(connection).await?;
                retried.cancelled = again("cancelled").run(connection).await?;
            }
            Ok(retried)
        })
        .await
    }
}

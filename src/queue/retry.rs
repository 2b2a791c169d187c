use super::bulk::json;
use super::engine::{Statement, query};
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

/// Results that cannot be used are not kept as those of earlier attempts.
const DELETE_RESULTS: Statement = Statement::each(
    "
    DELETE FROM results WHERE (job_id, attempt) IN (
        SELECT j.id, j.attempt FROM json_each($1) AS e CROSS JOIN jobs AS j ON j.key = e.value
        WHERE j.state IN ('done', 'failed'))",
    "
    DELETE FROM results WHERE (job_id, attempt) IN (
        SELECT j.id, j.attempt FROM json_array_elements_text($1::json) AS e (key) JOIN jobs AS j ON j.key = e.key
        WHERE j.state IN ('done', 'failed'))",
);

const RUN_AGAIN: Statement = Statement::each(
    "
    UPDATE jobs SET state = 'pending', crashes = 0, note = $2
    WHERE key IN (SELECT e.value FROM json_each($1) AS e) AND +state IN ('done', 'failed')",
    "
    UPDATE jobs SET state = 'pending', crashes = 0, note = $2
    WHERE key IN (SELECT e.key FROM json_array_elements_text($1::json) AS e (key)) AND state || '' IN ('done', 'failed')",
);

const UNREADABLE: &str = "to be run again: what was stored could not be read";

const NOTE: &str = "to be tried again: asked for by its user";

impl Queue {
    /// Makes jobs of a study that have ended pending again, whose results cannot be used, and deletes these results. Returns
    /// the number of jobs.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be written.
    pub async fn run_again(&mut self, study: &str, keys: &[String]) -> Result<u64, QueueError> {
        let keys = json(&keys);
        self.write(async |connection, _| {
            let study_id = lookup::require(connection, study).await?;
            query(DELETE_RESULTS).bind(&keys).run(connection).await?;
            let again = query(RUN_AGAIN).bind(&keys).bind(UNREADABLE).run(connection).await?;
            plan_rows::reopen(connection, study_id).await?;
            Ok(again)
        })
        .await
    }

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

use super::engine::{Connection, query};
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;
use super::plan_rows;

/// What the removal of a study changed, or would change. A job that several rows point to counts once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Removed {
    /// Rows of the study.
    pub rows: u64,
    /// Jobs that the rows point to.
    pub jobs: u64,
    /// Those of the jobs that are done: their results go out of this study's view.
    pub done: u64,
    /// Those of the jobs that are done and that other studies have too.
    pub shared_done: u64,
    /// Pending jobs that become cancelled because no study requests them any more.
    pub cancelled: u64,
}

/// The pending jobs that only the study $1 requests.
macro_rules! unrequested {
    () => {
        "
        id IN (SELECT job_id FROM study_pending WHERE study_id = $1)
        AND NOT EXISTS (
            SELECT 1 FROM study_jobs AS m JOIN studies AS s ON s.id = m.study_id
            WHERE m.job_id = jobs.id AND m.study_id <> $1 AND s.cancelled_ms IS NULL
        )"
    };
}

const CANCEL_UNREQUESTED: &str =
    concat!("UPDATE jobs SET state = 'cancelled', note = $2 WHERE", unrequested!());

/// Rows, jobs, jobs that are done, those of them that other studies have too, and jobs that become cancelled.
const EXTENT: &str = concat!(
    "
    SELECT (SELECT COUNT(*) FROM study_jobs WHERE study_id = $1),
           COUNT(*),
           COUNT(*) FILTER (WHERE j.state = 'done'),
           COUNT(*) FILTER (WHERE j.state = 'done' AND EXISTS (
               SELECT 1 FROM study_jobs AS o WHERE o.job_id = j.id AND o.study_id <> $1)),
           (SELECT COUNT(*) FROM jobs WHERE",
    unrequested!(),
    ")
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1) AS m
    JOIN jobs AS j ON j.id = m.job_id"
);

const NOTE: &str = "cancelled: its study was removed";

impl Queue {
    /// Removes a study: its document and its rows. Its jobs and their results stay until [`Queue::collect_garbage`].
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be written.
    pub async fn remove(&mut self, study: &str) -> Result<Removed, QueueError> {
        self.write(async |connection, _| {
            let study_id = lookup::require(connection, study).await?;
            let removed = extent(connection, study_id).await?;
            query(CANCEL_UNREQUESTED).bind(study_id).bind(NOTE).run(connection).await?;
            query("DELETE FROM study_jobs WHERE study_id = $1").bind(study_id).run(connection).await?;
            plan_rows::delete(connection, study_id).await?;
            query("DELETE FROM studies WHERE id = $1").bind(study_id).run(connection).await?;
            Ok(removed)
        })
        .await
    }

    /// What [`Queue::remove`] would change. Nothing is changed.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn preview_removal(&mut self, study: &str) -> Result<Removed, QueueError> {
        let study_id = lookup::require(&mut self.connection, study).await?;
        extent(&mut self.connection, study_id).await
    }
}

async fn extent(connection: &mut Connection, study_id: i64) -> Result<Removed, QueueError> {
    let counts: (i64, i64, i64, i64, i64) = query(EXTENT).bind(study_id).one(connection).await?;
    let [rows, jobs, done, shared_done, cancelled] =
        [counts.0, counts.1, counts.2, counts.3, counts.4].map(i64::unsigned_abs);
    Ok(Removed { rows, jobs, done, shared_done, cancelled })
}

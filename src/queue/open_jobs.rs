use super::engine::{Connection, query};
use super::error::QueueError;
use super::handle::Queue;
use super::plan_rows;
use super::scope::Scope;
use super::sqlite;

const ALL: &str = "
    SELECT (SELECT COUNT(*) FROM (SELECT 1 FROM jobs WHERE state = 'pending' LIMIT 1) AS p),
           (SELECT COUNT(*) FROM (SELECT 1 FROM jobs WHERE state = 'running' LIMIT 1) AS r)";

/// `study_id + 0` makes PostgreSQL look up the studies of each running job instead of all jobs of the study.
const OF_STUDY: &str = "
    SELECT (SELECT COUNT(*) FROM (SELECT 1 FROM study_pending WHERE study_id = $1 LIMIT 1) AS p),
           (SELECT COUNT(*) FROM (
                SELECT 1 FROM jobs AS j
                WHERE j.state = 'running'
                  AND EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id + 0 = $1)
                LIMIT 1) AS r)";

/// Whether there are unfinished jobs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OpenJobs {
    /// Whether jobs wait to be claimed.
    pub has_pending: bool,
    /// Whether jobs run on some worker.
    pub has_running: bool,
    /// Whether there are studies that may still grow.
    pub has_plans: bool,
}

impl Queue {
    /// Whether `scope` has pending and running jobs. Workers that wait for jobs call this often, so it does not count
    /// them, which would keep the database busy.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn open_jobs(&mut self, scope: &Scope) -> Result<OpenJobs, QueueError> {
        let study_id = scope.study_id(&mut self.connection).await?;
        let open = match study_id {
            None => query(ALL),
            Some(id) => query(OF_STUDY).bind(id),
        };
        let (pending, running): (i64, i64) = open.one(&mut self.connection).await?;
        let has_plans = plan_rows::has_open(&mut self.connection, study_id).await?;
        Ok(OpenJobs { has_pending: pending > 0, has_running: running > 0, has_plans })
    }

    /// Why a worker that is alone sees jobs that it can neither claim nor take back: parts of the database contradict each
    /// other. To be asked after some time only, because it reads the whole file.
    ///
    /// # Errors
    /// If the database cannot be read.
    pub async fn contradiction(&mut self) -> Result<QueueError, QueueError> {
        let damage = match &mut self.connection {
            Connection::Sqlite(file) => sqlite::integrity(file.connection()).await?,
            #[cfg(feature = "postgres")]
            Connection::Postgres(_) => Vec::new(),
        };
        Ok(if damage.is_empty() {
            QueueError::Inconsistent(
                "there are unfinished jobs that no worker runs and that cannot be claimed".to_owned(),
            )
        } else {
            QueueError::Damaged(damage.join("; ").into())
        })
    }
}

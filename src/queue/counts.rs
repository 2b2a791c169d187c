use super::engine::{Connection, query};
use super::error::QueueError;
use super::handle::Queue;
use super::scope::Scope;
use super::state::JobState;
use serde::Serialize;

/// The number of jobs in each state. A job that several rows of a study point to counts once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Counts {
    /// Jobs that wait to be claimed.
    pub pending: u64,
    /// Claimed jobs.
    pub running: u64,
    /// Jobs that ended with a record.
    pub done: u64,
    /// Jobs that ended with an error.
    pub failed: u64,
    /// Jobs that no study requests any more.
    pub cancelled: u64,
}

/// The inner query comes first, so that the work depends on the size of the study and not on that of the database.
const OF_STUDY: &str = "
    SELECT j.state, COUNT(*)
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1) AS m
    JOIN jobs AS j ON j.id = m.job_id
    GROUP BY j.state";

const OF_ALL: &str = "SELECT state, COUNT(*) FROM jobs GROUP BY state";

impl Counts {
    /// The number of all jobs.
    pub fn total(&self) -> u64 {
        self.pending + self.running + self.done + self.failed + self.cancelled
    }

    fn from_rows(rows: Vec<(String, i64)>) -> Result<Self, QueueError> {
        let mut counts = Self::default();
        for (state, count) in rows {
            let count = count.unsigned_abs();
            match JobState::from_column(&state)? {
                JobState::Pending => counts.pending = count,
                JobState::Running => counts.running = count,
                JobState::Done => counts.done = count,
                JobState::Failed => counts.failed = count,
                JobState::Cancelled => counts.cancelled = count,
            }
        }
        Ok(counts)
    }
}

impl Queue {
    /// Counts the jobs of `scope` by state.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`], or if the database cannot be read.
    pub async fn counts(&mut self, scope: &Scope) -> Result<Counts, QueueError> {
        if let Some(id) = scope.study_id(&mut self.connection).await? {
            return of_study(&mut self.connection, id).await;
        }
        let rows = query(OF_ALL);
        Counts::from_rows(rows.all(&mut self.connection).await?)
    }
}

pub(super) async fn of_study(connection: &mut Connection, study_id: i64) -> Result<Counts, QueueError> {
    let rows = query(OF_STUDY).bind(study_id).all(connection).await?;
    Counts::from_rows(rows)
}

#[cfg(test)]
mod tests {
    use super::OF_ALL;
    use crate::queue::{Clock, Queue};

    /// Protects: jobs are counted from an index, and not from all rows of the table.
    #[tokio::test]
    async fn jobs_are_counted_from_an_index() {
        let folder = tempfile::TempDir::new().unwrap();
        let mut queue = Queue::open(folder.path().join("db"), Clock::OfDatabase).await.unwrap();
        let explain = sqlx::AssertSqlSafe(format!("EXPLAIN QUERY PLAN {OF_ALL}"));
        let plan: Vec<(i64, i64, i64, String)> =
            sqlx::query_as(explain).fetch_all(queue.connection.sqlite()).await.unwrap();
        let steps: Vec<_> = plan.iter().map(|(_, _, _, step)| step.as_str()).collect();
        assert_eq!(steps, ["SCAN jobs USING COVERING INDEX jobs_state"]);
    }
}

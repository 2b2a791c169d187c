use sqlx::SqliteConnection;

use super::{QueueError, Scope};

/// How many jobs to take, and from where: all of one batch, so that they can be run together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    /// Whose jobs.
    pub scope: Scope,
    /// At most so many. An attempt counts from its claim: what is not started is to be handed back.
    pub limit: usize,
    /// The batch; otherwise that of the job that comes first. While a job of a higher priority waits, a batch without
    /// one gives nothing.
    pub batch: Option<String>,
}

/// A job to run.
#[derive(Debug, Clone, PartialEq)]
pub struct ClaimedJob {
    /// Identifies the job.
    pub key: String,
    /// What the executor needs.
    pub payload: String,
    /// Which start of the job this is, from 1; to be given back when it ends.
    pub attempt: u32,
    /// Expected effort.
    pub cost: f64,
    /// The name of what it can be run together with.
    pub batch: String,
    /// Where an earlier attempt got to.
    pub checkpoint: Option<Vec<u8>>,
}

/// Batch and priority of the job that comes first.
const FIRST: &str = "
    SELECT batch, priority FROM jobs INDEXED BY jobs_pending
    WHERE state = 'pending' ORDER BY priority DESC, cost DESC, id LIMIT 1";

const FIRST_OF_STUDY: &str = "
    SELECT batch, priority FROM study_pending
    WHERE study_id = ?1 ORDER BY priority DESC, cost DESC, job_id LIMIT 1";

/// Dear jobs first within a priority, so that no long one is left to a single worker at the end; then by age.
/// INDEXED BY: without it the planner prefers the index of all states and sorts every pending job, which makes each
/// claim as slow as the queue is long.
const TAKE: &str = "
    UPDATE jobs SET state = 'running', attempt = attempt + 1, started_ms = ?2, owner = ?1, lease_until_ms = ?3
    WHERE id IN (
        SELECT id FROM jobs INDEXED BY jobs_pending_batch
        WHERE state = 'pending' AND batch = ?5 AND priority >= ?7 ORDER BY priority DESC, cost DESC, id LIMIT ?4
    )
    RETURNING id, key, (SELECT payload FROM payloads WHERE job_id = jobs.id), attempt, cost, priority,
              (SELECT bytes FROM checkpoints WHERE job_id = jobs.id)";

const TAKE_OF_STUDY: &str = "
    UPDATE jobs SET state = 'running', attempt = attempt + 1, started_ms = ?2, owner = ?1, lease_until_ms = ?3
    WHERE id IN (
        SELECT job_id FROM study_pending INDEXED BY study_pending_batch
        WHERE study_id = ?6 AND batch = ?5 AND priority >= ?7 ORDER BY priority DESC, cost DESC, job_id LIMIT ?4
    )
    RETURNING id, key, (SELECT payload FROM payloads WHERE job_id = jobs.id), attempt, cost, priority,
              (SELECT bytes FROM checkpoints WHERE job_id = jobs.id)";

type Columns = (i64, String, String, u32, f64, i64, Option<Vec<u8>>);

/// What all claims of a transaction have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lease {
    pub owner: i64,
    pub now_ms: i64,
    pub until_ms: i64,
}

/// Marks the next jobs as running and returns them in the order of the claim.
pub(super) async fn take(
    connection: &mut SqliteConnection,
    claim: &Claim,
    lease: Lease,
) -> Result<Vec<ClaimedJob>, QueueError> {
    let study_id = claim.scope.study_id(connection).await?;
    if claim.limit == 0 {
        return Ok(Vec::new());
    }
    let first: Option<(String, i64)> = match study_id {
        None => sqlx::query_as(FIRST).fetch_optional(&mut *connection).await?,
        Some(id) => sqlx::query_as(FIRST_OF_STUDY).bind(id).fetch_optional(&mut *connection).await?,
    };
    let Some((first_batch, priority)) = first else { return Ok(Vec::new()) };
    let (batch, lowest_priority) = match &claim.batch {
        Some(batch) => (batch.clone(), priority),
        None => (first_batch, i64::MIN),
    };
    let mut rows: Vec<Columns> = sqlx::query_as(if study_id.is_some() { TAKE_OF_STUDY } else { TAKE })
        .bind(lease.owner)
        .bind(lease.now_ms)
        .bind(lease.until_ms)
        .bind(i64::try_from(claim.limit).unwrap_or(i64::MAX))
        .bind(&batch)
        .bind(study_id)
        .bind(lowest_priority)
        .fetch_all(connection)
        .await?;
    // RETURNING promises no order.
    rows.sort_by(|a, b| b.5.cmp(&a.5).then(b.4.total_cmp(&a.4)).then(a.0.cmp(&b.0)));
    let job = |(_, key, payload, attempt, cost, _, checkpoint): Columns| ClaimedJob {
        key,
        payload,
        attempt,
        cost,
        batch: batch.clone(),
        checkpoint,
    };
    Ok(rows.into_iter().map(job).collect())
}

#[cfg(test)]
mod tests {
    use super::{FIRST, FIRST_OF_STUDY, TAKE, TAKE_OF_STUDY};
    use crate::queue::{Queue, SystemClock};
    use std::sync::Arc;

    /// Protects: no claim looks at every pending job or sorts them: each reads as many entries of an index as it takes
    /// jobs.
    #[tokio::test]
    async fn claims_use_their_indexes() {
        let folder = tempfile::TempDir::new().unwrap();
        let mut queue = Queue::open(&folder.path().join("db"), Arc::new(SystemClock)).await.unwrap();
        for (statement, index) in [
            (FIRST, "jobs_pending"),
            (FIRST_OF_STUDY, "PRIMARY KEY (study_id=?)"),
            (TAKE, "jobs_pending_batch (batch=? AND priority>?)"),
            (TAKE_OF_STUDY, "study_pending_batch (study_id=? AND batch=? AND priority>?)"),
        ] {
            let explain = sqlx::AssertSqlSafe(format!("EXPLAIN QUERY PLAN {statement}"));
            let plan: Vec<(i64, i64, i64, String)> =
                sqlx::query_as(explain).fetch_all(&mut queue.connection).await.unwrap();
            let plan: Vec<_> = plan.into_iter().map(|(_, _, _, step)| step).collect();
            assert!(plan.iter().any(|step| step.ends_with(index)), "{index}: {plan:#?}");
            for step in &plan {
                assert!(!step.contains("TEMP B-TREE"), "{plan:#?}");
                assert!(!step.starts_with("SCAN") || step.ends_with("INDEX jobs_pending"), "{plan:#?}");
            }
        }
    }
}

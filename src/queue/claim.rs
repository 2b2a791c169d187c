use super::engine::{Connection, Statement, query};
use super::{QueueError, Scope};

/// How many jobs to take, and from where: all of one batch, so that they can be run together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    /// Whose jobs.
    pub scope: Scope,
    /// At most so many. An attempt counts from its claim: what is not started is to be handed back.
    pub limit: usize,
    /// The batch; otherwise that of the job that comes first, whatever the priority of its further jobs. While a job of a
    /// higher priority waits, a batch that is named gives only jobs of that priority.
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

/// One statement a claim, since handing a statement to the database costs more than what it does for one job.
///
/// Dear jobs first within a priority, so that no long one is left to a single worker at the end; then by age. Without
/// a batch ($5) it is that of the job that comes first; with one, nothing of a lower priority than that job's is taken.
///
/// `SQLite`: INDEXED BY, since without it the planner may sort every pending job, which makes each claim as slow as the
/// queue is long.
///
/// PostgreSQL: what another worker is just claiming is locked, and is passed over. Never waiting for it, claims cannot
/// wait for each other in a circle.
const TAKE: Statement = Statement::each(
    "
    UPDATE jobs SET state = 'running', attempt = attempt + 1, started_ms = $2, owner = $1, lease_until_ms = $3
    WHERE id IN (
        SELECT id FROM jobs INDEXED BY jobs_pending_batch
        WHERE state = 'pending'
          AND batch = COALESCE($5, (
              SELECT batch FROM jobs INDEXED BY jobs_pending
              WHERE state = 'pending' ORDER BY priority DESC, cost DESC, id LIMIT 1))
          AND priority >= (
              SELECT IIF($5 IS NULL, -9223372036854775808, priority) FROM jobs INDEXED BY jobs_pending
              WHERE state = 'pending' ORDER BY priority DESC, cost DESC, id LIMIT 1)
        ORDER BY priority DESC, cost DESC, id LIMIT $4
    )
    RETURNING id, key, (SELECT payload FROM payloads WHERE job_id = jobs.id), attempt, cost, priority, batch,
              (SELECT bytes FROM checkpoints WHERE job_id = jobs.id)",
    "
    WITH first AS MATERIALIZED (
        SELECT batch, priority FROM jobs
        WHERE state = 'pending' ORDER BY priority DESC, cost DESC, id LIMIT 1
        FOR UPDATE SKIP LOCKED
    ), next AS MATERIALIZED (
        SELECT id FROM jobs
        WHERE state = 'pending'
          AND batch = COALESCE($5, (SELECT batch FROM first))
          AND priority >= (
              SELECT CASE WHEN $5 IS NULL THEN -9223372036854775808 ELSE priority END FROM first)
        ORDER BY priority DESC, cost DESC, id LIMIT $4
        FOR UPDATE SKIP LOCKED
    )
    UPDATE jobs SET state = 'running', attempt = attempt + 1, started_ms = $2, owner = $1, lease_until_ms = $3
    FROM next WHERE jobs.id = next.id
    RETURNING jobs.id, key, (SELECT payload FROM payloads WHERE job_id = jobs.id), attempt, cost, priority, batch,
              (SELECT bytes FROM checkpoints WHERE job_id = jobs.id)",
);

/// As above, of the study named $6.
///
/// PostgreSQL: LATERAL keeps the order of the loops, and what is added to the state leaves only the number to look a job
/// up by; otherwise all pending jobs may be looked through for each row, where none was pending when they were last
/// counted.
const TAKE_OF_STUDY: Statement = Statement::each(
    "
    UPDATE jobs SET state = 'running', attempt = attempt + 1, started_ms = $2, owner = $1, lease_until_ms = $3
    WHERE id IN (
        SELECT job_id FROM study_pending INDEXED BY study_pending_batch
        WHERE study_id = (SELECT id FROM studies WHERE name = $6)
          AND batch = COALESCE($5, (
              SELECT batch FROM study_pending WHERE study_id = (SELECT id FROM studies WHERE name = $6)
              ORDER BY priority DESC, cost DESC, job_id LIMIT 1))
          AND priority >= (
              SELECT IIF($5 IS NULL, -9223372036854775808, priority) FROM study_pending
              WHERE study_id = (SELECT id FROM studies WHERE name = $6)
              ORDER BY priority DESC, cost DESC, job_id LIMIT 1)
        ORDER BY priority DESC, cost DESC, job_id LIMIT $4
    )
    RETURNING id, key, (SELECT payload FROM payloads WHERE job_id = jobs.id), attempt, cost, priority, batch,
              (SELECT bytes FROM checkpoints WHERE job_id = jobs.id)",
    "
    WITH first AS MATERIALIZED (
        SELECT p.batch, p.priority
        FROM study_pending AS p CROSS JOIN LATERAL (
            SELECT id FROM jobs WHERE id = p.job_id AND state || '' = 'pending' FOR UPDATE SKIP LOCKED) AS j
        WHERE p.study_id = (SELECT id FROM studies WHERE name = $6)
        ORDER BY p.priority DESC, p.cost DESC, p.job_id + 0 LIMIT 1
    ), next AS MATERIALIZED (
        SELECT j.id
        FROM study_pending AS p CROSS JOIN LATERAL (
            SELECT id FROM jobs WHERE id = p.job_id AND state || '' = 'pending' FOR UPDATE SKIP LOCKED) AS j
        WHERE p.study_id = (SELECT id FROM studies WHERE name = $6)
          AND p.batch = COALESCE($5, (SELECT batch FROM first))
          AND p.priority >= (
              SELECT CASE WHEN $5 IS NULL THEN -9223372036854775808 ELSE priority END FROM first)
        ORDER BY p.priority DESC, p.cost DESC, p.job_id + 0 LIMIT $4
    )
    UPDATE jobs SET state = 'running', attempt = attempt + 1, started_ms = $2, owner = $1, lease_until_ms = $3
    FROM next WHERE jobs.id = next.id
    RETURNING jobs.id, key, (SELECT payload FROM payloads WHERE job_id = jobs.id), attempt, cost, priority, batch,
              (SELECT bytes FROM checkpoints WHERE job_id = jobs.id)",
);

type Columns = (i64, String, String, i64, f64, i64, String, Option<Vec<u8>>);

/// What all claims of a transaction have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lease {
    pub owner: i64,
    pub now_ms: i64,
    pub until_ms: i64,
}

/// Marks the next jobs as running and returns them in the order of the claim.
pub(super) async fn take(
    connection: &mut Connection,
    claim: &Claim,
    lease: Lease,
) -> Result<Vec<ClaimedJob>, QueueError> {
    let mut rows: Vec<Columns> = Vec::new();
    if claim.limit > 0 {
        let take = match &claim.scope {
            Scope::All => query(TAKE),
            Scope::Study(_) => query(TAKE_OF_STUDY),
        };
        let mut take = take
            .bind(lease.owner)
            .bind(lease.now_ms)
            .bind(lease.until_ms)
            .bind(i64::try_from(claim.limit).unwrap_or(i64::MAX))
            .bind(&claim.batch);
        if let Scope::Study(name) = &claim.scope {
            take = take.bind(name);
        }
        rows = take.all(connection).await?;
    }
    if rows.is_empty() {
        // A study that is not there has no jobs either.
        claim.scope.study_id(connection).await?;
    }
    // RETURNING promises no order.
    rows.sort_by(|a, b| b.5.cmp(&a.5).then(b.4.total_cmp(&a.4)).then(a.0.cmp(&b.0)));
    let job = |(_, key, payload, attempt, cost, _, batch, checkpoint): Columns| ClaimedJob {
        key,
        payload,
        attempt: attempt as u32,
        cost,
        batch,
        checkpoint,
    };
    Ok(rows.into_iter().map(job).collect())
}

#[cfg(test)]
mod tests {
    use super::{TAKE, TAKE_OF_STUDY};
    use crate::queue::{Clock, Queue};

    /// Protects: no claim looks at every pending job or sorts them: each reads as many entries of an index as it takes
    /// jobs.
    #[tokio::test]
    async fn claims_use_their_indexes() {
        let folder = tempfile::TempDir::new().unwrap();
        let mut queue = Queue::open(folder.path().join("db"), Clock::OfDatabase).await.unwrap();
        for (statement, indexes) in [
            (TAKE, ["jobs_pending_batch (batch=? AND priority>?)", "INDEX jobs_pending"]),
            (
                TAKE_OF_STUDY,
                ["study_pending_batch (study_id=? AND batch=? AND priority>?)", "PRIMARY KEY (study_id=?)"],
            ),
        ] {
            let explain = sqlx::AssertSqlSafe(format!("EXPLAIN QUERY PLAN {}", statement.sqlite()));
            let plan: Vec<(i64, i64, i64, String)> =
                sqlx::query_as(explain).fetch_all(queue.connection.sqlite()).await.unwrap();
            let plan: Vec<_> = plan.into_iter().map(|(_, _, _, step)| step).collect();
            for index in indexes {
                assert!(plan.iter().any(|step| step.ends_with(index)), "{index}: {plan:#?}");
            }
            for step in &plan {
                assert!(!step.contains("TEMP B-TREE"), "{plan:#?}");
                assert!(!step.starts_with("SCAN") || step.ends_with("INDEX jobs_pending"), "{plan:#?}");
            }
        }
    }
}

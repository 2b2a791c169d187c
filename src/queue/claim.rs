use super::digest::{self, Integrity};
use super::engine::{Connection, Statement, columns, query};
use super::error::QueueError;
use super::scope::Scope;

/// How many jobs to claim, and which. All claimed jobs are of one batch, so that they can be run together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    /// Which jobs may be claimed.
    pub scope: Scope,
    /// The largest number of jobs. An attempt counts from its claim, so jobs that are not started must be given back as
    /// `FinishedOutcome::Unstarted`.
    pub limit: usize,
    /// The batch. With `None`, it is the batch of the first job in the order of claims, and jobs of all priorities are
    /// claimed from it. A named batch yields only jobs that have at least the highest priority of all pending jobs.
    pub batch: Option<String>,
}

/// A job to run.
#[derive(Debug, Clone, PartialEq)]
pub struct ClaimedJob {
    /// Identifies the job.
    pub key: String,
    /// What the executor needs to run the job.
    pub payload: String,
    /// The number of this start of the job, from 1. The finish must name it.
    pub attempt: u32,
    /// The expected effort.
    pub cost: f64,
    /// The batch: jobs of the same batch can be run together.
    pub batch: String,
    /// The last checkpoint of an earlier attempt.
    pub checkpoint: Option<Vec<u8>>,
    /// The key of the job that it continues, if it continues one.
    pub parent: Option<String>,
    /// The final state of that job; none if that state is not there any more, or is damaged.
    pub parent_state: Option<Vec<u8>>,
    /// Whether that state is there and damaged.
    pub parent_is_damaged: bool,
}

/// What a claim returns.
macro_rules! claimed_columns {
    () => {
        "
    RETURNING jobs.id, key, (SELECT payload FROM payloads WHERE job_id = jobs.id) AS payload, attempt, cost, priority,
              batch, (SELECT bytes FROM checkpoints WHERE job_id = jobs.id) AS checkpoint, parent,
              (SELECT bytes FROM final_states
               WHERE job_id = (SELECT p.id FROM jobs AS p WHERE p.key = jobs.parent)) AS parent_state,
              (SELECT digest FROM final_states
               WHERE job_id = (SELECT p.id FROM jobs AS p WHERE p.key = jobs.parent)) AS parent_digest"
    };
}

columns! {
    struct ClaimedColumns {
        id: i64,
        key: String,
        payload: Option<String>,
        attempt: i64,
        cost: f64,
        priority: i64,
        batch: String,
        checkpoint: Option<Vec<u8>>,
        parent: Option<String>,
        parent_state: Option<Vec<u8>>,
        parent_digest: Option<String>,
    }
}

/// A claim is one statement, because sending a statement to the database costs more than its work for one job.
///
/// Within a priority, expensive jobs come first, so that at the end no long job is left to a single worker. Jobs of
/// equal cost are ordered by age. If the batch ($5) is null, it is the batch of the first job. If it is not null, no
/// job with a lower priority than the first job's is claimed.
///
/// `SQLite`: without INDEXED BY, the planner may sort all pending jobs, and the time of a claim grows with the length
/// of the queue.
///
/// PostgreSQL: SKIP LOCKED passes over the jobs that another worker is claiming. Deadlock is impossible because a claim
/// never waits for a row.
const TAKE: Statement = Statement::each(
    concat!(
        "
    UPDATE jobs SET state = 'running', attempt = MAX(attempt, 0) + 1, started_ms = $2, owner = $1,
           lease_until_ms = $3
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
    )",
        claimed_columns!()
    ),
    concat!(
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
    UPDATE jobs SET state = 'running', attempt = GREATEST(attempt, 0) + 1, started_ms = $2, owner = $1,
           lease_until_ms = $3
    FROM next WHERE jobs.id = next.id",
        claimed_columns!()
    ),
);

/// As above, for the study named $6.
///
/// PostgreSQL: LATERAL fixes the order of the loops. The expression on the state leaves only the primary key for
/// looking a job up. Without it, the planner may scan all pending jobs for each row if no job was pending when it last
/// collected statistics.
const TAKE_OF_STUDY: Statement = Statement::each(
    concat!(
        "
    UPDATE jobs SET state = 'running', attempt = MAX(attempt, 0) + 1, started_ms = $2, owner = $1,
           lease_until_ms = $3
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
    )",
        claimed_columns!()
    ),
    concat!(
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
    UPDATE jobs SET state = 'running', attempt = GREATEST(attempt, 0) + 1, started_ms = $2, owner = $1,
           lease_until_ms = $3
    FROM next WHERE jobs.id = next.id",
        claimed_columns!()
    ),
);

/// What all claims of a transaction share.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lease {
    pub owner: i64,
    pub now_ms: i64,
    pub until_ms: i64,
}

/// Marks the next jobs as running. Returns them in the order of claims.
pub(super) async fn take(
    connection: &mut Connection,
    claim: &Claim,
    lease: Lease,
) -> Result<Vec<ClaimedJob>, QueueError> {
    let mut rows: Vec<ClaimedColumns> = Vec::new();
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
        // The reason may be that the study does not exist, which is an error.
        claim.scope.study_id(connection).await?;
    }
    // RETURNING does not guarantee an order.
    rows.sort_by(|a, b| b.priority.cmp(&a.priority).then(b.cost.total_cmp(&a.cost)).then(a.id.cmp(&b.id)));
    rows.into_iter().map(claimed).collect()
}

fn claimed(columns: ClaimedColumns) -> Result<ClaimedJob, QueueError> {
    let ClaimedColumns { key, payload, attempt, cost, batch, checkpoint, parent, .. } = columns;
    let (state, digest) = (columns.parent_state, columns.parent_digest);
    let Ok(attempt) = u32::try_from(attempt) else {
        return Err(QueueError::Inconsistent(format!("job {key} was started {attempt} times")));
    };
    let expected =
        || digest::of_state(parent.as_deref().unwrap_or_default(), state.as_deref().unwrap_or_default());
    let parent_is_damaged =
        state.is_some() && Integrity::of(digest.as_deref(), expected) == Integrity::Damaged;
    Ok(ClaimedJob {
        // A job without a payload is reported by its executor, which cannot read it.
        payload: payload.unwrap_or_default(),
        key,
        attempt,
        cost,
        batch,
        checkpoint,
        parent,
        parent_state: state.filter(|_| !parent_is_damaged),
        parent_is_damaged,
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU64, Ordering};

    use super::{Claim, TAKE, TAKE_OF_STUDY};
    use crate::queue::{Clock, Finished, FinishedOutcome, NewJob, NewStudy, Queue, Scope, Worker};

    /// How many instructions of its virtual machine `SQLite` executes for ten claims of four jobs, which are given back
    /// unstarted.
    async fn steps(jobs: usize, scope: &Scope, batch: Option<&str>) -> u64 {
        let folder = tempfile::TempDir::new().unwrap();
        let mut queue = Queue::open(folder.path().join("db"), Clock::OfDatabase).await.unwrap();
        queue.register(&Worker::this_process(1, "test", "provenance")).await.unwrap();
        for (name, cost) in [("over", 5.0), ("before", 9.0), ("mine", 1.0)] {
            let job = |index: usize| NewJob {
                key: format!("{name} {index}"),
                payload: "payload".into(),
                parameters: String::new(),
                // Scattered costs, so that the order of claims is not the order of storage.
                cost: cost + (index * 7919 % 97) as f64 / 100.0,
                batch: format!("batch {}", index % 7),
                priority: None,
                parent: None,
            };
            let jobs = (0..jobs).map(job).collect();
            queue
                .submit(&NewStudy { name: name.into(), document: String::new(), jobs, grows: false })
                .await
                .unwrap();
            if name == "over" {
                // The database collects its statistics at a time when no job is pending.
                queue.cancel(name).await.unwrap();
                sqlx::query("ANALYZE").execute(queue.connection.sqlite()).await.unwrap();
            }
        }
        let steps = Arc::new(AtomicU64::new(0));
        let counted = Arc::clone(&steps);
        queue.connection.sqlite().lock_handle().await.unwrap().set_progress_handler(1, move || {
            counted.fetch_add(1, Ordering::Relaxed);
            true
        });
        let claim = Claim { scope: scope.clone(), limit: 4, batch: batch.map(str::to_owned) };
        for _ in 0..10 {
            let claimed = queue.exchange(&[], std::slice::from_ref(&claim)).await.unwrap().claimed.remove(0);
            assert_eq!(claimed.len(), 4);
            let back = claimed.into_iter().map(|job| Finished {
                key: job.key,
                attempt: job.attempt,
                outcome: FinishedOutcome::Unstarted,
                wall_s: 0.0,
            });
            queue.exchange(&back.collect::<Vec<_>>(), &[]).await.unwrap();
        }
        steps.load(Ordering::Relaxed)
    }

    /// Protects: with forty times as many pending jobs, a claim takes no more steps: a claim of all jobs, of a study whose
    /// jobs come after those of another study, and of a named batch; even if the database's statistics say that nothing
    /// is pending.
    #[tokio::test]
    async fn claims_take_no_more_steps_in_a_long_queue() {
        let mine = || Scope::Study("mine".into());
        for (scope, batch) in [(Scope::All, None), (mine(), None), (mine(), Some("batch 3"))] {
            let short = steps(500, &scope, batch).await;
            let long = steps(20_000, &scope, batch).await;
            assert!(
                short > 0 && long < 2 * short,
                "{scope:?} {batch:?}: {short} for 1000 jobs, {long} for 40 000"
            );
        }
    }

    /// Protects: a claim neither scans nor sorts all pending jobs. It reads as many index entries as it claims jobs.
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

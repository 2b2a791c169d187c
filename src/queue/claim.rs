use sqlx::SqliteConnection;

use super::{QueueError, Scope};

/// How many jobs to take, and from where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    /// Whose jobs.
    pub scope: Scope,
    /// At most so many: the number of free workers, since an attempt counts from its claim.
    pub limit: usize,
}

impl Claim {
    /// Takes nothing: for an exchange that only stores.
    pub fn nothing() -> Self {
        Self { scope: Scope::All, limit: 0 }
    }
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
}

/// Dear jobs first, so that no long one is left to a single worker at the end; then by age.
///
/// Membership is asked of each candidate in that order, so a claim ends after `limit` hits. `IN (…)` would
/// collect the whole study first, and without INDEXED BY the planner prefers the index of all states and
/// sorts every pending job: either makes each claim as slow as the study is large (220 jobs a second at
/// 100 000 pending).
const CLAIM: &str = "
    UPDATE jobs SET state = 'running', attempt = attempt + 1, started_ms = ?2
    WHERE id IN (
        SELECT j.id FROM jobs AS j INDEXED BY jobs_pending
        WHERE j.state = 'pending'
          AND (?1 IS NULL OR EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id = ?1))
        ORDER BY j.cost DESC, j.id
        LIMIT ?3
    )
    RETURNING id, key, payload, attempt, cost";

/// Marks the next jobs as running and returns them in the order of the claim.
pub(super) async fn take(
    connection: &mut SqliteConnection,
    claim: &Claim,
    now_ms: i64,
) -> Result<Vec<ClaimedJob>, QueueError> {
    let study_id = claim.scope.study_id(connection).await?;
    if claim.limit == 0 {
        return Ok(Vec::new());
    }
    let mut rows: Vec<(i64, String, String, u32, f64)> = sqlx::query_as(CLAIM)
        .bind(study_id)
        .bind(now_ms)
        .bind(i64::try_from(claim.limit).unwrap_or(i64::MAX))
        .fetch_all(connection)
        .await?;
    // RETURNING promises no order.
    rows.sort_by(|a, b| b.4.total_cmp(&a.4).then(a.0.cmp(&b.0)));
    let jobs = rows.into_iter();
    Ok(jobs.map(|(_, key, payload, attempt, cost)| ClaimedJob { key, payload, attempt, cost }).collect())
}

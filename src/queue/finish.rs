use std::collections::HashSet;

use super::bulk::json;
use super::digest;
use super::engine::{Connection, Statement, query};
use super::error::QueueError;
use super::state::JobState;

/// A finished attempt.
#[derive(Debug, Clone, PartialEq)]
pub struct Finished {
    /// The job's key.
    pub key: String,
    /// The attempt's number, as in the claim.
    pub attempt: u32,
    /// How it ended.
    pub outcome: FinishedOutcome,
    /// How long the attempt took, in seconds. Jobs that run together share their time.
    pub wall_s: f64,
}

/// How an attempt ended.
#[derive(Debug, Clone, PartialEq)]
pub enum FinishedOutcome {
    /// With a result.
    Done {
        /// The result, as an opaque text.
        record: String,
        /// A word for the kind of result, by which rows can be selected ([`Rows::Done`](super::Rows::Done)).
        label: String,
        /// The state in which it ended, for jobs that continue it; none if no job does.
        final_state: Option<Vec<u8>>,
    },
    /// Without a result. Another attempt would fail in the same way.
    Failed {
        /// What went wrong.
        error: String,
    },
    /// Interrupted. The job is pending again, with its checkpoint if it has one.
    Released,
    /// Claimed but not started. The job is pending again, and the attempt does not count.
    Unstarted,
}

impl FinishedOutcome {
    /// Whether the job has ended.
    pub(super) fn is_end(&self) -> bool {
        matches!(self, Self::Done { .. } | Self::Failed { .. })
    }
}

const RELEASED: &str = "released: the work was interrupted before the job ended";

/// One statement for all outcomes of an exchange, because sending a statement to the database costs more than its work
/// for one job. $1 contains the results and $5 the outcomes.
///
/// Every statement on behalf of an attempt has the fence `state = 'running' AND owner = … AND attempt = …`: a worker
/// that has lost the job changes nothing.
///
/// The database must look up one key per outcome. `SQLite`: CROSS JOIN fixes the order of the loops, and the plus signs
/// leave only the key's index. PostgreSQL: the expressions on the other columns have the same effect.
const STORE: Statement = Statement::each(
    "
    INSERT INTO results (job_id, attempt, record, error, wall_s, started_ms, finished_ms, provenance, digest)
    SELECT j.id, j.attempt, e.value ->> 2, e.value ->> 3, e.value ->> 4, j.started_ms, $3, $4, e.value ->> 5
    FROM json_each($1) AS e CROSS JOIN jobs AS j ON j.key = e.value ->> 0
    WHERE j.state = 'running' AND j.owner = $2 AND j.attempt = e.value ->> 1
    ON CONFLICT DO NOTHING;

    UPDATE jobs
    SET state = e.value ->> 2, note = COALESCE(e.value ->> 3, jobs.note), attempt = jobs.attempt - (e.value ->> 4),
        label = e.value ->> 5, owner = NULL, lease_until_ms = NULL
    FROM json_each($5) AS e
    WHERE jobs.key = e.value ->> 0
      AND +jobs.state = 'running' AND +jobs.owner = $2 AND jobs.attempt = e.value ->> 1
    RETURNING key",
    "
    WITH ended AS (
        UPDATE jobs
        SET state = e.value ->> 2, note = COALESCE(e.value ->> 3, jobs.note),
            attempt = jobs.attempt - (e.value ->> 4)::bigint, label = e.value ->> 5,
            owner = NULL, lease_until_ms = NULL
        FROM json_array_elements($5::json) AS e (value)
        WHERE jobs.key = e.value ->> 0
          AND jobs.state || '' = 'running' AND jobs.owner + 0 = $2 AND jobs.attempt = (e.value ->> 1)::bigint
        RETURNING jobs.id, jobs.key, jobs.attempt, jobs.started_ms
    ), stored AS (
        INSERT INTO results (job_id, attempt, record, error, wall_s, started_ms, finished_ms, provenance, digest)
        SELECT ended.id, ended.attempt, r.value ->> 2, r.value ->> 3, (r.value ->> 4)::double precision,
               ended.started_ms, $3, $4, r.value ->> 5
        FROM json_array_elements($1::json) AS r (value)
        JOIN ended ON ended.key = r.value ->> 0 AND ended.attempt = (r.value ->> 1)::bigint
        ON CONFLICT DO NOTHING
    )
    SELECT key FROM ended",
);

/// For a job that has just ended with this attempt.
const KEEP_STATE: &str = "
    INSERT INTO final_states (job_id, bytes, digest)
    SELECT id, $3, $4 FROM jobs WHERE key = $1 AND state = 'done' AND attempt = $2
    ON CONFLICT (job_id) DO UPDATE SET bytes = excluded.bytes, digest = excluded.digest";

/// Stores the outcomes of attempts. Returns the keys of those that `owner` does not run.
pub(super) async fn store(
    connection: &mut Connection,
    finished: &[Finished],
    owner: i64,
    provenance: &str,
    now_ms: i64,
) -> Result<Vec<String>, QueueError> {
    let mut ended: HashSet<String> = HashSet::new();
    for part in messages(finished, connection.max_message_bytes().saturating_sub(provenance.len())) {
        let results: Vec<_> = part.iter().filter_map(result_row).collect();
        let outcomes: Vec<_> = part.iter().map(outcome_row).collect();
        let keys: Vec<String> = query(STORE)
            .bind(json(&results))
            .bind(owner)
            .bind(now_ms)
            .bind(provenance)
            .bind(json(&outcomes))
            .scalars(connection)
            .await?;
        ended.extend(keys);
    }
    for job in finished.iter().filter(|job| ended.contains(&job.key)) {
        if let FinishedOutcome::Done { final_state: Some(bytes), .. } = &job.outcome {
            let keep = query(KEEP_STATE).bind(&job.key).bind(job.attempt).bind(bytes.as_slice());
            keep.bind(digest::of_state(&job.key, bytes)).run(connection).await?;
        }
    }
    let keys = finished.iter().map(|job| &job.key);
    Ok(keys.filter(|key| !ended.contains(*key)).cloned().collect())
}

/// Splits the attempts into messages that have at most `max_bytes` in the form in which they are sent. An attempt that
/// is larger than that is a message of its own.
fn messages(mut finished: &[Finished], max_bytes: usize) -> Vec<&[Finished]> {
    let mut messages = Vec::new();
    while !finished.is_empty() {
        let mut bytes = 0;
        let fits = |job: &&Finished| {
            bytes += json(&result_row(job)).len() + json(&outcome_row(job)).len() + 2;
            bytes <= max_bytes
        };
        let count = finished.iter().take_while(fits).count();
        let (message, rest) = finished.split_at(count.max(1));
        messages.push(message);
        finished = rest;
    }
    messages
}

/// Key, attempt, record, error, time and digest.
type ResultRow<'a> = (&'a str, u32, Option<&'a str>, Option<&'a str>, f64, String);

fn result_row(job: &Finished) -> Option<ResultRow<'_>> {
    let (record, error) = match &job.outcome {
        FinishedOutcome::Done { record, .. } => (Some(record.as_str()), None),
        FinishedOutcome::Failed { error } => (None, Some(error.as_str())),
        FinishedOutcome::Released | FinishedOutcome::Unstarted => return None,
    };
    Some((&job.key, job.attempt, record, error, job.wall_s, digest::of_result(&job.key, record, error)))
}

/// Key, attempt, state, note, the number of attempts that do not count, and label.
type OutcomeRow<'a> = (&'a str, u32, &'static str, Option<&'static str>, u32, Option<&'a str>);

fn outcome_row(job: &Finished) -> OutcomeRow<'_> {
    let (state, note, undone, label) = match &job.outcome {
        FinishedOutcome::Done { label, .. } => (JobState::Done, None, 0, Some(label.as_str())),
        FinishedOutcome::Failed { .. } => (JobState::Failed, None, 0, None),
        FinishedOutcome::Released => (JobState::Pending, Some(RELEASED), 0, None),
        FinishedOutcome::Unstarted => (JobState::Pending, None, 1, None),
    };
    (&job.key, job.attempt, state.as_str(), note, undone, label)
}

#[cfg(test)]
mod tests {
    use super::{Finished, FinishedOutcome, STORE, json, messages, outcome_row, result_row};
    use crate::queue::{Clock, Queue};

    /// Protects: no message is longer than the limit in the form in which it is sent, unless it has a single attempt;
    /// and no attempt is left out or sent twice.
    #[test]
    fn messages_are_within_the_limit() {
        let done = |index: usize| {
            let outcome = FinishedOutcome::Done {
                record: "\"".repeat(100 * (index % 7)),
                label: "periodic".to_owned(),
                final_state: None,
            };
            Finished { key: format!("job {index}"), attempt: 1, outcome, wall_s: 0.25 }
        };
        let finished: Vec<_> = (0..40).map(done).collect();
        let sent = |part: &[Finished]| {
            let results: Vec<_> = part.iter().filter_map(result_row).collect();
            json(&results).len() + json(&part.iter().map(outcome_row).collect::<Vec<_>>()).len()
        };
        for max_bytes in [1, 1000, 3000, usize::MAX] {
            let messages = messages(&finished, max_bytes);
            assert_eq!(messages.concat(), finished);
            assert!(
                messages.iter().all(|part| part.len() == 1 || sent(part) <= max_bytes.saturating_add(2)),
                "{max_bytes}"
            );
        }
        assert_eq!(messages(&finished, usize::MAX).len(), 1);
        assert_eq!(messages(&finished, 1).len(), 40);
        assert!(messages(&finished, 3000).len() < 20);
        assert!(messages(&[], 1000).is_empty());
    }

    /// Protects: the jobs of outcomes are looked up by their keys, so that an exchange does not scan all jobs.
    #[tokio::test]
    async fn outcomes_look_jobs_up_by_key() {
        let folder = tempfile::TempDir::new().unwrap();
        let mut queue = Queue::open(folder.path().join("db"), Clock::OfDatabase).await.unwrap();
        for statement in STORE.sqlite().split(';') {
            let explain = sqlx::AssertSqlSafe(format!("EXPLAIN QUERY PLAN {statement}"));
            let plan: Vec<(i64, i64, i64, String)> =
                sqlx::query_as(explain).fetch_all(queue.connection.sqlite()).await.unwrap();
            let steps: Vec<_> = plan.iter().map(|(_, _, _, step)| step.as_str()).collect();
            assert!(steps[0].starts_with("SCAN e "), "{steps:?}");
            assert!(steps[1].starts_with("SEARCH ") && steps[1].ends_with("jobs_1 (key=?)"), "{steps:?}");
        }
    }
}

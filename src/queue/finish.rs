use std::collections::HashSet;

use super::bulk::json;
use super::engine::{Connection, Statement, query};
use super::{JobState, QueueError};

/// The end of one attempt.
#[derive(Debug, Clone, PartialEq)]
pub struct Finished {
    /// The job.
    pub key: String,
    /// The attempt, as it was claimed.
    pub attempt: u32,
    /// How it ended.
    pub outcome: FinishedOutcome,
    /// How long it took, in seconds; jobs that run together share their time.
    pub wall_s: f64,
}

/// How an attempt ended.
#[derive(Debug, Clone, PartialEq)]
pub enum FinishedOutcome {
    /// With a result.
    Done {
        /// The result.
        record: String,
        /// How it ended, in a word by which such jobs are found.
        label: String,
    },
    /// Without a result, and the same would happen again.
    Failed {
        /// What went wrong.
        error: String,
    },
    /// Stopped because of an interruption: the job is pending again, with its checkpoint if it has one.
    Released,
    /// Claimed, but not begun: the job is pending again, as if it had not been claimed.
    Unstarted,
}

impl FinishedOutcome {
    /// Whether the job has come to its end.
    pub(super) fn is_end(&self) -> bool {
        matches!(self, Self::Done { .. } | Self::Failed { .. })
    }
}

const RELEASED: &str = "released: the work was interrupted before the job ended";

/// All of a turn's ends in one go, since handing a statement to the database costs more than what it does for one job:
/// $1 has the results and $5 the ends.
///
/// The fence, `state = 'running' AND owner = … AND attempt = …`, is in every statement that speaks for an attempt:
/// whoever lost the job in the meantime changes nothing.
///
/// A key is looked up for each end. `SQLite`: CROSS JOIN, and plus signs that leave only the key to look jobs up by, and so
/// keep the loops in this order. PostgreSQL: the same by what is added to the other columns.
const STORE: Statement = Statement::each(
    "
    INSERT INTO results (job_id, attempt, record, error, wall_s, started_ms, finished_ms, provenance)
    SELECT j.id, j.attempt, e.value ->> 2, e.value ->> 3, e.value ->> 4, j.started_ms, $3, $4
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
        INSERT INTO results (job_id, attempt, record, error, wall_s, started_ms, finished_ms, provenance)
        SELECT ended.id, ended.attempt, r.value ->> 2, r.value ->> 3, (r.value ->> 4)::double precision,
               ended.started_ms, $3, $4
        FROM json_array_elements($1::json) AS r (value)
        JOIN ended ON ended.key = r.value ->> 0 AND ended.attempt = (r.value ->> 1)::bigint
        ON CONFLICT DO NOTHING
    )
    SELECT key FROM ended",
);

/// Stores the ends of attempts; gives the keys of those that `owner` does not run.
pub(super) async fn store(
    connection: &mut Connection,
    finished: &[Finished],
    owner: i64,
    provenance: &str,
    now_ms: i64,
) -> Result<Vec<String>, QueueError> {
    let mut ended: HashSet<String> = HashSet::new();
    for part in parts(finished, connection.message_bytes().saturating_sub(provenance.len())) {
        let results: Vec<_> = part.iter().filter_map(result).collect();
        let ends: Vec<_> = part.iter().map(end).collect();
        let keys: Vec<String> = query(STORE)
            .bind(json(&results))
            .bind(owner)
            .bind(now_ms)
            .bind(provenance)
            .bind(json(&ends))
            .scalars(connection)
            .await?;
        ended.extend(keys);
    }
    let keys = finished.iter().map(|job| &job.key);
    Ok(keys.filter(|key| !ended.contains(*key)).cloned().collect())
}

/// Parts that are no longer than `most_bytes` each in the form that they are sent in, or of one end.
fn parts(mut finished: &[Finished], most_bytes: usize) -> Vec<&[Finished]> {
    let mut parts = Vec::new();
    while !finished.is_empty() {
        let mut bytes = 0;
        let fits = |job: &&Finished| {
            bytes += json(&result(job)).len() + json(&end(job)).len() + 2;
            bytes <= most_bytes
        };
        let count = finished.iter().take_while(fits).count();
        let (part, rest) = finished.split_at(count.max(1));
        parts.push(part);
        finished = rest;
    }
    parts
}

/// Key, attempt, record, error and time.
type ResultRow<'a> = (&'a str, u32, Option<&'a str>, Option<&'a str>, f64);

fn result(job: &Finished) -> Option<ResultRow<'_>> {
    let (record, error) = match &job.outcome {
        FinishedOutcome::Done { record, .. } => (Some(record.as_str()), None),
        FinishedOutcome::Failed { error } => (None, Some(error.as_str())),
        FinishedOutcome::Released | FinishedOutcome::Unstarted => return None,
    };
    Some((&job.key, job.attempt, record, error, job.wall_s))
}

/// Key, attempt, state, note, the attempts that do not count, and label.
type EndRow<'a> = (&'a str, u32, &'static str, Option<&'static str>, u32, Option<&'a str>);

fn end(job: &Finished) -> EndRow<'_> {
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
    use super::{Finished, FinishedOutcome, STORE, parts};
    use crate::queue::{Clock, Queue};

    /// Protects: what is sent in one message is no longer than it may be, in the form that it is sent in, unless it is a
    /// single end; and nothing is left out or sent twice.
    #[test]
    fn parts_are_as_long_as_they_may_be() {
        let done = |index: usize| {
            let outcome = FinishedOutcome::Done {
                record: "\"".repeat(100 * (index % 7)),
                label: "periodic".to_owned(),
            };
            Finished { key: format!("job {index}"), attempt: 1, outcome, wall_s: 0.25 }
        };
        let finished: Vec<_> = (0..40).map(done).collect();
        let sent = |part: &[Finished]| {
            let results: Vec<_> = part.iter().filter_map(super::result).collect();
            super::json(&results).len() + super::json(&part.iter().map(super::end).collect::<Vec<_>>()).len()
        };
        for most_bytes in [1, 1000, 3000, usize::MAX] {
            let parts = parts(&finished, most_bytes);
            assert_eq!(parts.concat(), finished);
            assert!(
                parts.iter().all(|part| part.len() == 1 || sent(part) <= most_bytes.saturating_add(2)),
                "{most_bytes}"
            );
        }
        assert_eq!(parts(&finished, usize::MAX).len(), 1);
        assert_eq!(parts(&finished, 1).len(), 40);
        assert!(parts(&finished, 3000).len() < 20);
        assert!(parts(&[], 1000).is_empty());
    }

    /// Protects: ends are looked up by their keys, and not every job is looked at for each turn.
    #[tokio::test]
    async fn ends_look_jobs_up_by_key() {
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

use std::collections::{BTreeSet, HashSet};

use super::bulk::json;
use super::counts;
use super::engine::{Connection, Statement, query};
use super::error::QueueError;
use super::handle::Queue;
use super::plan_rows;
use super::replace::{OLD, OldColumns, Replace, Replaced};

/// A study to be submitted.
#[derive(Debug, Clone, PartialEq)]
pub struct NewStudy {
    /// Identifies the study.
    pub name: String,
    /// The study as its author wrote it. It is stored for reference.
    pub document: String,
    /// Its rows, in order. Several rows may have the same key.
    pub jobs: Vec<NewJob>,
    /// Whether workers add jobs to it when these have ended ([`Queue::claim_plan`]).
    pub grows: bool,
}

/// A row of a study and the job it points to.
#[derive(Debug, Clone, PartialEq)]
pub struct NewJob {
    /// Identifies the job: two jobs with the same key have the same result.
    pub key: String,
    /// What the executor needs to run the job.
    pub payload: String,
    /// What distinguishes this row from the others of its study.
    pub parameters: String,
    /// The expected effort, in any unit. It must be finite. Expensive jobs are claimed first.
    pub cost: f64,
    /// Jobs of the same batch can be run together. The name may be empty.
    pub batch: String,
    /// Jobs with a higher priority are claimed first, whatever they cost. With `None`, an existing job keeps its
    /// priority, and a new job has priority 0.
    pub priority: Option<i64>,
    /// The key of the job that it continues: it is run when that one is done, and receives its final state with the claim.
    pub parent: Option<String>,
}

/// A part of a study's rows, for several databases that divide a study: the rows whose number modulo `of` is `index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// The number of this shard, from 0.
    pub index: u64,
    /// The number of shards.
    pub of: u64,
}

impl Shard {
    /// All rows.
    pub const WHOLE: Self = Self { index: 0, of: 1 };

    fn has(self, ordinal: i64) -> bool {
        ordinal.unsigned_abs() % self.of == self.index
    }
}

/// What a submission changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Submitted {
    /// The study that had the name before; absent if there was none.
    pub replaced: Option<Replaced>,
    /// Rows of the study.
    pub rows: u64,
    /// Different jobs that the rows point to.
    pub jobs: u64,
    /// Jobs that did not exist in the database.
    pub added: u64,
    /// Jobs that existed, in any state.
    pub already_known: u64,
    /// Jobs that existed and are done.
    pub already_done: u64,
    /// Jobs that existed and have failed.
    pub already_failed: u64,
}

/// Rows per JSON parameter. Rows in one JSON text are inserted twice as fast as row by row, but the text of a million
/// jobs would exceed `SQLite`'s limit of 10⁹ bytes.
pub(super) const CHUNK: usize = 10_000;

pub(super) const UPSERT_STUDY: &str = "
    INSERT INTO studies (name, document, submitted_ms) VALUES ($1, $2, $3)
    ON CONFLICT (name) DO UPDATE
    SET document = excluded.document, submitted_ms = excluded.submitted_ms, cancelled_ms = NULL
    RETURNING id";

/// Jobs are inserted in the order of the array, so that their numbers have the order of the study's rows.
/// (`SQLite`: `WHERE true` keeps the parser from reading ON CONFLICT as a join condition.)
///
/// The batch of an existing job is updated because another version of the program may group jobs differently.
const INSERT_JOBS: Statement = Statement::each(
    "
    INSERT INTO jobs (key, cost, batch, priority, parent, created_ms)
    SELECT e.value ->> 0, e.value ->> 2, e.value ->> 3, COALESCE(e.value ->> 4, 0), e.value ->> 5, $2
    FROM json_each($1) AS e WHERE true
    ON CONFLICT (key) DO UPDATE SET batch = excluded.batch WHERE batch <> excluded.batch",
    "
    INSERT INTO jobs (key, cost, batch, priority, parent, created_ms)
    SELECT e.value ->> 0, (e.value ->> 2)::double precision, e.value ->> 3,
           COALESCE((e.value ->> 4)::bigint, 0), e.value ->> 5, $2
    FROM (
        SELECT DISTINCT ON (value ->> 0) value, place
        FROM json_array_elements($1::json) WITH ORDINALITY AS e (value, place)
        ORDER BY value ->> 0, place
    ) AS e
    ORDER BY e.place
    ON CONFLICT (key) DO UPDATE SET batch = excluded.batch WHERE jobs.batch <> excluded.batch",
);

/// `SQLite`: CROSS JOIN fixes the order of the loops, so that a key is looked up for each row (below, too).
const INSERT_PAYLOADS: Statement = Statement::each(
    "
    INSERT INTO payloads (job_id, payload)
    SELECT j.id, e.value ->> 1 FROM json_each($1) AS e CROSS JOIN jobs AS j ON j.key = e.value ->> 0 WHERE true
    ON CONFLICT (job_id) DO NOTHING",
    "
    INSERT INTO payloads (job_id, payload)
    SELECT j.id, e.value ->> 1 FROM json_array_elements($1::json) AS e (value) JOIN jobs AS j ON j.key = e.value ->> 0
    ON CONFLICT (job_id) DO NOTHING",
);

/// A job may have failed because its payload was damaged. The study has it intact.
const REPAIR_PAYLOADS: Statement = Statement::each(
    "
    UPDATE payloads SET payload = e.value ->> 1
    FROM json_each($1) AS e CROSS JOIN jobs AS j ON j.key = e.value ->> 0
    WHERE payloads.job_id = j.id AND payloads.payload <> e.value ->> 1",
    "
    UPDATE payloads SET payload = e.value ->> 1
    FROM json_array_elements($1::json) AS e (value) JOIN jobs AS j ON j.key = e.value ->> 0
    WHERE payloads.job_id = j.id AND payloads.payload <> e.value ->> 1",
);

const FAILED: &str = "
    SELECT j.key FROM study_jobs AS m JOIN jobs AS j ON j.id = m.job_id WHERE m.study_id = $1 AND j.state = 'failed'";

const SET_PRIORITY: Statement = Statement::each(
    "
    UPDATE jobs SET priority = e.value ->> 4
    FROM json_each($1) AS e
    WHERE jobs.key = e.value ->> 0 AND e.value ->> 4 IS NOT NULL AND jobs.priority <> e.value ->> 4",
    "
    UPDATE jobs SET priority = (e.value ->> 4)::bigint
    FROM json_array_elements($1::json) AS e (value)
    WHERE jobs.key = e.value ->> 0 AND jobs.priority <> (e.value ->> 4)::bigint",
);

/// A submission requests its jobs, even if they were cancelled before.
pub(super) const UNDO_CANCELLATION: &str = "
    UPDATE jobs SET state = 'pending', note = NULL
    WHERE state = 'cancelled' AND id IN (SELECT job_id FROM study_jobs WHERE study_id = $1)";

/// Cancels the jobs that only the replaced document requested.
const CANCEL_UNREQUESTED: &str = "
    UPDATE jobs SET state = 'cancelled', note = $1
    WHERE state = 'pending' AND NOT EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = jobs.id)";

const NOTE: &str = "cancelled: its study was replaced by one without it";

/// Deletes rows beyond the end of the new document, and rows of other shards.
const DELETE_SURPLUS: &str = "
    DELETE FROM study_jobs WHERE study_id = $1 AND (ordinal >= $2 OR ordinal % $3 <> $4) RETURNING job_id";

/// How many of these jobs the study does not have any more, and how many of them are done.
const DROPPED: Statement = Statement::each(
    "
    SELECT COUNT(*), COUNT(*) FILTER (WHERE j.state = 'done')
    FROM json_each($1) AS e CROSS JOIN jobs AS j ON j.id = e.value
    WHERE NOT EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id = $2)",
    "
    SELECT COUNT(*), COUNT(*) FILTER (WHERE j.state = 'done')
    FROM json_array_elements_text($1::json) AS e (id) JOIN jobs AS j ON j.id = e.id::bigint
    WHERE NOT EXISTS (SELECT 1 FROM study_jobs AS m WHERE m.job_id = j.id AND m.study_id = $2)",
);

/// The array indices of rows that are missing or different in the database. An existing row has its job and its
/// payload.
const CHANGED: Statement = Statement::each(
    "
    SELECT e.key
    FROM json_each($1) AS e
    LEFT JOIN study_jobs AS m ON m.study_id = $2 AND m.ordinal = e.value ->> 0
    LEFT JOIN jobs AS j ON j.id = m.job_id
    WHERE j.key IS NOT e.value ->> 1 OR m.parameters IS NOT e.value ->> 2 OR j.batch IS NOT e.value ->> 3
    ORDER BY e.key",
    "
    SELECT e.place - 1
    FROM json_array_elements($1::json) WITH ORDINALITY AS e (value, place)
    LEFT JOIN study_jobs AS m ON m.study_id = $2 AND m.ordinal = (e.value ->> 0)::bigint
    LEFT JOIN jobs AS j ON j.id = m.job_id
    WHERE j.key IS DISTINCT FROM e.value ->> 1 OR m.parameters IS DISTINCT FROM e.value ->> 2
       OR j.batch IS DISTINCT FROM e.value ->> 3
    ORDER BY e.place",
);

const DELETE_ROWS: Statement = Statement::each(
    "
    DELETE FROM study_jobs
    WHERE study_id = $2 AND ordinal IN (SELECT e.value ->> 0 FROM json_each($1) AS e)
    RETURNING job_id",
    "
    DELETE FROM study_jobs
    WHERE study_id = $2
      AND ordinal IN (SELECT (e.value ->> 0)::bigint FROM json_array_elements($1::json) AS e (value))
    RETURNING job_id",
);

const INSERT_ROWS: Statement = Statement::each(
    "
    INSERT INTO study_jobs (study_id, ordinal, job_id, parameters)
    SELECT $2, e.value ->> 0, j.id, e.value ->> 2
    FROM json_each($1) AS e CROSS JOIN jobs AS j ON j.key = e.value ->> 1",
    "
    INSERT INTO study_jobs (study_id, ordinal, job_id, parameters)
    SELECT $2, (e.value ->> 0)::bigint, j.id, e.value ->> 2
    FROM json_array_elements($1::json) AS e (value) JOIN jobs AS j ON j.key = e.value ->> 1",
);

impl Queue {
    /// Adds a study, or replaces the document and rows of the one with its name, whatever that one has.
    ///
    /// Existing jobs keep their results, and cancelled ones are pending again. Jobs that no study refers to any more
    /// also stay, because the next edit may request their results again; the pending ones among them are cancelled.
    ///
    /// A study that grows keeps the jobs that workers have added if it is submitted again as it is. Otherwise it grows anew;
    /// jobs that it then asks for again have their results.
    ///
    /// # Errors
    /// [`QueueError::BadCost`], or if the database cannot be written; then nothing has changed.
    pub async fn submit(&mut self, study: &NewStudy) -> Result<Submitted, QueueError> {
        self.submit_shard(study, Shard::WHOLE, &Replace::Always).await
    }

    /// As [`Queue::submit`], for the rows of one shard only, and only if `replace` permits it. Each row keeps its number
    /// in the study.
    ///
    /// # Errors
    /// As [`Queue::submit`], and [`QueueError::ResultsWouldBeDropped`]; then nothing has changed.
    ///
    /// # Panics
    /// If the shard's index is not less than the number of shards.
    pub async fn submit_shard(
        &mut self,
        study: &NewStudy,
        shard: Shard,
        replace: &Replace,
    ) -> Result<Submitted, QueueError> {
        assert!(shard.index < shard.of, "{shard:?}");
        check_costs(&study.jobs)?;
        let rows: Vec<_> = (0_i64..).zip(&study.jobs).filter(|(ordinal, _)| shard.has(*ordinal)).collect();
        let jobs = rows.iter().map(|(_, job)| &job.key).collect::<HashSet<_>>().len() as u64;
        let (replaced, added, counts) = self
            .write(async |connection, now_ms| {
                let old: Option<OldColumns> = query(OLD).bind(&study.name).optional(connection).await?;
                let study_id: i64 = query(UPSERT_STUDY)
                    .bind(&study.name)
                    .bind(&study.document)
                    .bind(now_ms)
                    .scalar(connection)
                    .await?;
                let is_same_document =
                    old.as_ref().is_some_and(|(_, document, ..)| *document == study.document);
                let keeps_waves = study.grows
                    && is_same_document
                    && plan_rows::read(connection, study_id).await?.is_some()
                    && is_unchanged(connection, study_id, &rows).await?;
                // Jobs of deleted rows. Other rows of the study may have them still.
                let mut deleted = BTreeSet::new();
                if !keeps_waves {
                    let surplus: Vec<i64> = query(DELETE_SURPLUS)
                        .bind(study_id)
                        .bind(i64::try_from(study.jobs.len()).unwrap_or(i64::MAX))
                        .bind(shard.of.cast_signed())
                        .bind(shard.index.cast_signed())
                        .scalars(connection)
                        .await?;
                    deleted.extend(surplus);
                }
                match (study.grows, keeps_waves) {
                    (true, true) => plan_rows::reopen(connection, study_id).await?,
                    (true, false) => plan_rows::begin(connection, study_id).await?,
                    (false, _) => plan_rows::delete(connection, study_id).await?,
                }
                let before = count_jobs(connection).await?;
                for chunk in rows.chunks(CHUNK) {
                    if old.is_some() {
                        let changed = changed(connection, study_id, chunk).await?;
                        deleted.extend(delete_rows(connection, study_id, &changed).await?);
                        insert(connection, study_id, &changed, now_ms).await?;
                    } else {
                        insert(connection, study_id, chunk, now_ms).await?;
                    }
                    set_priority(connection, chunk).await?;
                }
                if old.is_some() {
                    repair_payloads(connection, study_id, &rows).await?;
                }
                let added = count_jobs(connection).await? - before;
                query(UNDO_CANCELLATION).bind(study_id).run(connection).await?;
                let mut replaced = None;
                if let Some((_, document, old_jobs, parameters)) = old {
                    let (dropped, dropped_done) = count_dropped(connection, study_id, deleted).await?;
                    let cancelled = query(CANCEL_UNREQUESTED).bind(NOTE).run(connection).await?;
                    let kept = old_jobs.unsigned_abs() - dropped;
                    let old = Replaced {
                        document,
                        parameters,
                        kept,
                        new: jobs.saturating_sub(kept),
                        dropped,
                        dropped_done,
                        cancelled,
                    };
                    if !replace.permits(&old) {
                        let name = study.name.clone();
                        return Err(QueueError::ResultsWouldBeDropped { name, replaced: Box::new(old) });
                    }
                    replaced = Some(old);
                }
                let counts = counts::of_study(connection, study_id).await?;
                Ok((replaced, added, counts))
            })
            .await?;

        Ok(Submitted {
            replaced,
            rows: rows.len() as u64,
            jobs,
            added,
            already_known: jobs - added,
            already_done: counts.done,
            already_failed: counts.failed,
        })
    }
}

/// Of the jobs with these numbers, how many the study does not have any more, and how many of those are done.
async fn count_dropped(
    connection: &mut Connection,
    study_id: i64,
    deleted: BTreeSet<i64>,
) -> Result<(u64, u64), QueueError> {
    let deleted: Vec<i64> = deleted.into_iter().collect();
    let (mut dropped, mut done) = (0, 0);
    for chunk in deleted.chunks(CHUNK) {
        let counts: (i64, i64) = query(DROPPED).bind(json(&chunk)).bind(study_id).one(connection).await?;
        dropped += counts.0.unsigned_abs();
        done += counts.1.unsigned_abs();
    }
    Ok((dropped, done))
}

/// JSON cannot represent NaN and infinity; they would become null.
pub(super) fn check_costs(jobs: &[NewJob]) -> Result<(), QueueError> {
    match jobs.iter().find(|job| !job.cost.is_finite()) {
        Some(job) => Err(QueueError::BadCost { key: job.key.clone(), cost: job.cost }),
        None => Ok(()),
    }
}

/// Whether the study has all these rows as they are.
async fn is_unchanged(
    connection: &mut Connection,
    study_id: i64,
    rows: &[Row<'_>],
) -> Result<bool, QueueError> {
    for chunk in rows.chunks(CHUNK) {
        if !changed(connection, study_id, chunk).await?.is_empty() {
            return Ok(false);
        }
    }
    Ok(true)
}

async fn count_jobs(connection: &mut Connection) -> Result<u64, QueueError> {
    let count: i64 = query("SELECT COUNT(*) FROM jobs").scalar(connection).await?;
    Ok(count.unsigned_abs())
}

/// A row of a study with its number.
pub(super) type Row<'a> = (i64, &'a NewJob);

/// Those of `rows` that the study does not have, or has in another form. An unchanged study has none, and its
/// submission writes nothing.
pub(super) async fn changed<'a>(
    connection: &mut Connection,
    study_id: i64,
    rows: &[Row<'a>],
) -> Result<Vec<Row<'a>>, QueueError> {
    let changed: Vec<i64> = query(CHANGED).bind(as_rows(rows)).bind(study_id).scalars(connection).await?;
    Ok(changed.into_iter().map(|place| rows[place as usize]).collect())
}

/// Deletes the rows with these numbers. Returns the numbers of the jobs that they pointed to.
pub(super) async fn delete_rows(
    connection: &mut Connection,
    study_id: i64,
    rows: &[Row<'_>],
) -> Result<Vec<i64>, QueueError> {
    query(DELETE_ROWS).bind(as_rows(rows)).bind(study_id).scalars(connection).await
}

pub(super) async fn insert(
    connection: &mut Connection,
    study_id: i64,
    rows: &[Row<'_>],
    now_ms: i64,
) -> Result<(), QueueError> {
    let jobs = as_jobs(rows);
    query(INSERT_JOBS).bind(&jobs).bind(now_ms).run(connection).await?;
    query(INSERT_PAYLOADS).bind(&jobs).run(connection).await?;
    query(INSERT_ROWS).bind(as_rows(rows)).bind(study_id).run(connection).await?;
    Ok(())
}

async fn repair_payloads(
    connection: &mut Connection,
    study_id: i64,
    rows: &[Row<'_>],
) -> Result<(), QueueError> {
    let failed: Vec<String> = query(FAILED).bind(study_id).scalars(connection).await?;
    let failed: HashSet<String> = failed.into_iter().collect();
    let rows: Vec<_> = rows.iter().copied().filter(|(_, job)| failed.contains(&job.key)).collect();
    for chunk in rows.chunks(CHUNK) {
        query(INSERT_PAYLOADS).bind(as_jobs(chunk)).run(connection).await?;
        query(REPAIR_PAYLOADS).bind(as_jobs(chunk)).run(connection).await?;
    }
    Ok(())
}

async fn set_priority(connection: &mut Connection, rows: &[Row<'_>]) -> Result<(), QueueError> {
    let prioritised: Vec<_> = rows.iter().copied().filter(|(_, job)| job.priority.is_some()).collect();
    if !prioritised.is_empty() {
        query(SET_PRIORITY).bind(as_jobs(&prioritised)).run(connection).await?;
    }
    Ok(())
}

fn as_jobs(rows: &[Row<'_>]) -> String {
    let jobs =
        rows.iter().map(|(_, job)| (&job.key, &job.payload, job.cost, &job.batch, job.priority, &job.parent));
    json(&jobs.collect::<Vec<_>>())
}

fn as_rows(rows: &[Row<'_>]) -> String {
    let rows = rows.iter().map(|(ordinal, job)| (ordinal, &job.key, &job.parameters, &job.batch));
    json(&rows.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::{NewJob, NewStudy};
    use crate::queue::{Clock, Queue};

    /// Protects: a study that is submitted again writes only its changes, whatever its size.
    #[tokio::test]
    async fn only_what_changed_is_written() {
        let folder = tempfile::TempDir::new().unwrap();
        let mut queue = Queue::open(folder.path().join("db"), Clock::OfDatabase).await.unwrap();
        let job = |number: usize| NewJob {
            key: format!("job {number}"),
            payload: "payload".into(),
            parameters: format!("{number}"),
            cost: 1.0,
            batch: "batch".into(),
            priority: None,
            parent: None,
        };
        let mut study = NewStudy {
            name: "a".into(),
            document: String::new(),
            jobs: (0..500).map(job).collect(),
            grows: false,
        };
        let mut written = async |study: &NewStudy| {
            let total = "SELECT total_changes()";
            let before: i64 = sqlx::query_scalar(total).fetch_one(queue.connection.sqlite()).await.unwrap();
            queue.submit(study).await.unwrap();
            let after: i64 = sqlx::query_scalar(total).fetch_one(queue.connection.sqlite()).await.unwrap();
            after - before
        };
        assert!(written(&study).await >= 500);
        assert_eq!(written(&study).await, 1, "the study itself");
        study.jobs[7].parameters = "otherwise".into();
        let one = written(&study).await;
        assert!((2..10).contains(&one), "{one} for one row");
        study.jobs.truncate(499);
        let one = written(&study).await;
        assert!((2..10).contains(&one), "{one} for one row less");
    }
}

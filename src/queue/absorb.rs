//! Copies studies from another database: to move a study, or to merge shards.

use std::collections::HashMap;

use super::bulk::json;
use super::engine::{Connection, Statement, columns, query};
use super::error::QueueError;
use super::handle::Queue;
use super::lookup;
use super::plan_rows;
use super::state::JobState;
use super::submit::{self, NewJob, UPSERT_STUDY};

/// What was copied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Absorbed {
    /// Studies that were copied.
    pub studies: u64,
    /// Their rows.
    pub rows: u64,
    /// Jobs that did not exist in this database.
    pub added: u64,
    /// Jobs whose outcome was copied: they were done or failed in the other database, and not yet in this one, or they
    /// were done there and had failed here.
    pub ended: u64,
    /// Jobs that are neither done nor failed in either database.
    pub open: u64,
}

/// Rows that are copied in one transaction.
const PAGE: i64 = 1_000;

const STUDIES: &str = "
    SELECT id, name, document, submitted_ms, cancelled_ms FROM studies
    WHERE $1 IS NULL OR name = $1 ORDER BY id";

/// Rows of a study with the definition of their jobs.
const ROWS: &str = "
    SELECT m.ordinal, m.parameters, j.key, j.batch, j.priority, j.cost, p.payload, j.parent
    FROM study_jobs AS m
    JOIN jobs AS j ON j.id = m.job_id
    JOIN payloads AS p ON p.job_id = j.id
    WHERE m.study_id = $1 AND m.ordinal > $2
    ORDER BY m.ordinal LIMIT $3";

columns! {
    struct RowColumns {
        ordinal: i64,
        parameters: String,
        key: String,
        batch: String,
        priority: i64,
        cost: f64,
        payload: String,
        parent: Option<String>,
    }
}

/// The states of the same rows' jobs.
const STATES: &str = "
    SELECT j.key, j.state, j.attempt, j.crashes, j.created_ms, j.started_ms, j.note, j.label
    FROM study_jobs AS m JOIN jobs AS j ON j.id = m.job_id
    WHERE m.study_id = $1 AND m.ordinal >= $2 AND m.ordinal <= $3";

columns! {
    struct StateColumns {
        key: String,
        state: String,
        attempt: i64,
        crashes: i64,
        created_ms: i64,
        started_ms: Option<i64>,
        note: Option<String>,
        label: Option<String>,
    }
}

const RESULTS: &str = "
    SELECT j.key, r.attempt, r.record, r.error, r.wall_s, r.started_ms, r.finished_ms, r.provenance, r.digest
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1 AND ordinal >= $2 AND ordinal <= $3) AS m
    JOIN jobs AS j ON j.id = m.job_id
    JOIN results AS r ON r.job_id = j.id";

columns! {
    /// A result that is damaged stays so.
    struct ResultColumns {
        key: String,
        attempt: i64,
        record: Option<String>,
        error: Option<String>,
        wall_s: Option<f64>,
        started_ms: Option<i64>,
        finished_ms: i64,
        provenance: Option<String>,
        digest: Option<String>,
    }
}

const CHECKPOINTS: &str = "
    SELECT j.key, c.attempt, c.bytes, c.saved_ms
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1 AND ordinal >= $2 AND ordinal <= $3) AS m
    JOIN jobs AS j ON j.id = m.job_id
    JOIN checkpoints AS c ON c.job_id = j.id";

/// The jobs in this database that have the same keys.
const HERE: Statement = Statement::each(
    "SELECT j.key, j.state, j.attempt FROM json_each($1) AS e CROSS JOIN jobs AS j ON j.key = e.value",
    "SELECT j.key, j.state, j.attempt
     FROM json_array_elements_text($1::json) AS e (key) JOIN jobs AS j ON j.key = e.key",
);

/// The rows that a study has here.
const KNOWN_ROWS: &str =
    "SELECT ordinal FROM study_jobs WHERE study_id = $1 AND ordinal >= $2 AND ordinal <= $3 ORDER BY ordinal";

const SET_STATES: Statement = Statement::each(
    "
    UPDATE jobs
    SET state = e.value ->> 1, attempt = e.value ->> 2, crashes = e.value ->> 3, created_ms = e.value ->> 4,
        started_ms = e.value ->> 5, note = e.value ->> 6, label = e.value ->> 7
    FROM json_each($1) AS e
    WHERE jobs.key = e.value ->> 0",
    "
    UPDATE jobs
    SET state = e.value ->> 1, attempt = (e.value ->> 2)::bigint, crashes = (e.value ->> 3)::bigint,
        created_ms = (e.value ->> 4)::bigint, started_ms = (e.value ->> 5)::bigint, note = e.value ->> 6,
        label = e.value ->> 7
    FROM json_array_elements($1::json) AS e (value)
    WHERE jobs.key = e.value ->> 0",
);

/// Results are inserted one by one: one of the databases reads JSON numbers with 15 digits only, and times must be
/// copied exactly.
const SET_RESULT: &str = "
    INSERT INTO results (job_id, attempt, record, error, wall_s, started_ms, finished_ms, provenance, digest)
    SELECT id, $2, $3, $4, $5, $6, $7, $8, $9 FROM jobs WHERE key = $1
    ON CONFLICT DO NOTHING";

const FINAL_STATES: &str = "
    SELECT j.key, f.bytes, f.digest
    FROM (SELECT DISTINCT job_id FROM study_jobs WHERE study_id = $1 AND ordinal >= $2 AND ordinal <= $3) AS m
    JOIN jobs AS j ON j.id = m.job_id
    JOIN final_states AS f ON f.job_id = j.id";

const SET_FINAL_STATE: &str = "
    INSERT INTO final_states (job_id, bytes, digest) SELECT id, $2, $3 FROM jobs WHERE key = $1 AND state = 'done'
    ON CONFLICT DO NOTHING";

const SET_CHECKPOINT: &str = "
    INSERT INTO checkpoints (job_id, attempt, bytes, saved_ms)
    SELECT id, $2, $3, $4 FROM jobs WHERE key = $1 AND state = 'pending'
    ON CONFLICT DO NOTHING";

const CANCELLED: &str = "UPDATE studies SET cancelled_ms = $2 WHERE id = $1";

columns! {
    /// A study in the other database.
    struct StudyColumns {
        id: i64,
        name: String,
        document: String,
        submitted_ms: i64,
        cancelled_ms: Option<i64>,
    }
}

/// A part of a study in the other database: rows, and everything about their jobs.
struct Page {
    rows: Vec<(i64, NewJob)>,
    states: Vec<StateColumns>,
    results: Vec<ResultColumns>,
    checkpoints: Vec<(String, i64, Vec<u8>, i64)>,
    final_states: Vec<(String, Vec<u8>, Option<String>)>,
}

impl Queue {
    /// Copies all studies of another database, or one of them: rows, jobs, results of all attempts, checkpoints.
    ///
    /// This database loses nothing. A job that is done here stays done. A job that has not ended here takes the outcome
    /// of the other database. A job that failed here and is done there becomes done. A job that is running there
    /// becomes pending here. A repeated call changes nothing. Each part of a study is copied completely or not at all;
    /// after an error, call this again.
    ///
    /// # Errors
    /// [`QueueError::UnknownStudy`] if the other database has no such study; [`QueueError::OtherStudy`] if
    /// this database has a different study of that name; or if one of the databases fails.
    pub async fn absorb(&mut self, other: &mut Self, study: Option<&str>) -> Result<Absorbed, QueueError> {
        if let Some(name) = study {
            lookup::require(&mut other.connection, name).await?;
        }
        let found: Vec<StudyColumns> = query(STUDIES).bind(study).all(&mut other.connection).await?;
        // Every study is checked before the first one is copied, so that a conflict changes nothing.
        for study in &found {
            let here = self.study(&study.name).await?;
            if here.is_some_and(|here| here.document != study.document) {
                return Err(QueueError::OtherStudy { name: study.name.clone() });
            }
        }
        let mut absorbed = Absorbed::default();
        for study in &found {
            self.absorb_study(other, study, &mut absorbed).await?;
        }
        Ok(absorbed)
    }

    async fn absorb_study(
        &mut self,
        other: &mut Self,
        study: &StudyColumns,
        absorbed: &mut Absorbed,
    ) -> Result<(), QueueError> {
        let StudyColumns { id: there_id, name, document, submitted_ms, cancelled_ms } = study;
        let was_here = self.study(name).await?.is_some();
        let here_id = self
            .write(async |connection, _| {
                if let Some(id) = lookup::find(connection, name).await? {
                    return Ok(id);
                }
                let id: i64 = query(UPSERT_STUDY)
                    .bind(name)
                    .bind(document)
                    .bind(*submitted_ms)
                    .scalar(connection)
                    .await?;
                query(CANCELLED).bind(id).bind(*cancelled_ms).run(connection).await?;
                Ok(id)
            })
            .await?;
        absorbed.studies += 1;
        // The plan is read before the rows: a wave that is added meanwhile is planned again here, with the same jobs.
        let plan = plan_rows::read(&mut other.connection, *there_id).await?;
        // The rows of a study that grows belong to its own plan.
        let keeps_rows = was_here && plan_rows::read(&mut self.connection, here_id).await?.is_some();
        let ended_before = absorbed.ended;
        // Rows are read after the last one, because the largest number has none after it.
        let mut last = -1;
        while let Some(page) = read(&mut other.connection, *there_id, last).await? {
            last = page.rows.last().map_or(last, |(ordinal, _)| *ordinal);
            let copied = self
                .write(async |connection, now_ms| write(connection, here_id, &page, keeps_rows, now_ms).await)
                .await?;
            absorbed.rows += page.rows.len() as u64;
            absorbed.added += copied.added;
            absorbed.ended += copied.ended;
            absorbed.open += copied.open;
        }
        if let Some(plan) = &plan {
            let has_new_results = was_here && absorbed.ended > ended_before;
            self.write(async |connection, _| {
                plan_rows::copy(connection, here_id, plan).await?;
                if has_new_results {
                    plan_rows::reopen(connection, here_id).await?;
                }
                Ok(())
            })
            .await?;
        }
        Ok(())
    }
}

async fn read(connection: &mut Connection, study_id: i64, after: i64) -> Result<Option<Page>, QueueError> {
    let rows: Vec<RowColumns> = query(ROWS).bind(study_id).bind(after).bind(PAGE).all(connection).await?;
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return Ok(None) };
    let (first, last) = (first.ordinal, last.ordinal);
    let about = |statement: &'static str| query(statement).bind(study_id).bind(first).bind(last);
    let row = |row: RowColumns| {
        let RowColumns { ordinal, parameters, key, batch, priority, cost, payload, parent } = row;
        (ordinal, NewJob { key, payload, parameters, cost, batch, priority: Some(priority), parent })
    };
    Ok(Some(Page {
        rows: rows.into_iter().map(row).collect(),
        // The states are read first. A job that ends in the meantime is copied as if it had not ended.
        states: about(STATES).all(connection).await?,
        results: about(RESULTS).all(connection).await?,
        checkpoints: about(CHECKPOINTS).all(connection).await?,
        final_states: about(FINAL_STATES).all(connection).await?,
    }))
}

async fn write(
    connection: &mut Connection,
    study_id: i64,
    page: &Page,
    keeps_rows: bool,
    now_ms: i64,
) -> Result<Absorbed, QueueError> {
    let keys: Vec<&str> = page.states.iter().map(|state| state.key.as_str()).collect();
    let here: Vec<(String, String, i64)> = query(HERE).bind(json(&keys)).all(connection).await?;
    let here: HashMap<String, (JobState, i64)> = here
        .into_iter()
        .map(|(key, state, attempt)| Ok((key, (JobState::from_column(&state)?, attempt))))
        .collect::<Result<_, QueueError>>()?;

    let rows: Vec<submit::Row<'_>> = page.rows.iter().map(|(ordinal, job)| (*ordinal, job)).collect();
    let mut changed = submit::changed(connection, study_id, &rows).await?;
    if keeps_rows && let (Some(first), Some(last)) = (rows.first(), rows.last()) {
        let known = query(KNOWN_ROWS).bind(study_id).bind(first.0).bind(last.0);
        let known: Vec<i64> = known.scalars(connection).await?;
        changed.retain(|(ordinal, _)| known.binary_search(ordinal).is_err());
    }
    submit::delete_rows(connection, study_id, &changed).await?;
    submit::insert(connection, study_id, &changed, now_ms).await?;

    // For each job that is copied: how many attempts it has here. Those of the other database are numbered after them.
    let mut copied: HashMap<&str, i64> = HashMap::new();
    let mut states = Vec::new();
    let mut absorbed = Absorbed::default();
    for of_job in &page.states {
        let StateColumns { key, state, attempt, crashes, created_ms, started_ms, note, label } = of_job;
        let there = match JobState::from_column(state)? {
            // No worker of this database runs it.
            JobState::Running => JobState::Pending,
            state => state,
        };
        let before = match here.get(key.as_str()) {
            None => 0,
            Some((state, attempts)) if is_better(there, *state) => *attempts,
            Some((state, _)) => {
                absorbed.open += u64::from(!has_ended(*state));
                continue;
            }
        };
        if copied.insert(key, before).is_some() {
            continue;
        }
        absorbed.added += u64::from(!here.contains_key(key.as_str()));
        absorbed.ended += u64::from(has_ended(there));
        absorbed.open += u64::from(!has_ended(there));
        states.push((key, there.as_str(), before + attempt, crashes, created_ms, started_ms, note, label));
    }
    query(SET_STATES).bind(json(&states)).run(connection).await?;
    for result in &page.results {
        let Some(before) = copied.get(result.key.as_str()) else { continue };
        let set = query(SET_RESULT).bind(&result.key).bind(before + result.attempt);
        let set = set.bind(&result.record).bind(&result.error).bind(result.wall_s);
        let set = set.bind(result.started_ms).bind(result.finished_ms);
        set.bind(&result.provenance).bind(&result.digest).run(connection).await?;
    }
    for (key, attempt, bytes, saved_ms) in &page.checkpoints {
        let Some(before) = copied.get(key.as_str()) else { continue };
        let checkpoint = query(SET_CHECKPOINT).bind(key).bind(before + attempt).bind(bytes.as_slice());
        checkpoint.bind(*saved_ms).run(connection).await?;
    }
    for (key, bytes, digest) in &page.final_states {
        query(SET_FINAL_STATE).bind(key).bind(bytes.as_slice()).bind(digest).run(connection).await?;
    }
    Ok(absorbed)
}

fn has_ended(state: JobState) -> bool {
    matches!(state, JobState::Done | JobState::Failed)
}

/// Whether the state in the other database replaces the state here. A job that is running here belongs to its worker.
fn is_better(there: JobState, here: JobState) -> bool {
    match here {
        JobState::Pending => has_ended(there),
        // A copied study requests its jobs, so they are no longer cancelled.
        JobState::Cancelled => there != JobState::Cancelled,
        JobState::Failed => there == JobState::Done,
        JobState::Running | JobState::Done => false,
    }
}

use std::collections::HashSet;

use serde::Serialize;
use sqlx::{Connection, SqliteConnection};

use super::{Queue, QueueError, counts, studies};

/// A study to be submitted.
#[derive(Debug, Clone, PartialEq)]
pub struct NewStudy {
    /// Identifies the study.
    pub name: String,
    /// The study as its author wrote it, kept for reference.
    pub document: String,
    /// Its rows, in order. A key may repeat.
    pub jobs: Vec<NewJob>,
}

/// A row of a study and the job it points to.
#[derive(Debug, Clone, PartialEq)]
pub struct NewJob {
    /// Identifies the job: two jobs with the same key have the same result.
    pub key: String,
    /// What the executor needs to run the job.
    pub payload: String,
    /// What distinguishes this row in its study.
    pub parameters: String,
    /// Expected effort, in any unit; dearer jobs are claimed first.
    pub cost: f64,
}

/// What a submission changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Submitted {
    /// Whether a study of that name was there and was replaced.
    pub replaced: bool,
    /// Rows of the study.
    pub rows: u64,
    /// Different jobs they point to.
    pub jobs: u64,
    /// Jobs that are new in the database.
    pub added: u64,
    /// Jobs that were there, in whatever state.
    pub already_known: u64,
    /// Jobs that were there and are done.
    pub already_done: u64,
    /// Jobs that were there and have failed.
    pub already_failed: u64,
}

/// Rows bound as one JSON text insert twice as fast as row by row; the text of a million jobs would pass
/// `SQLite`'s limit of 10⁹ bytes.
const CHUNK: usize = 10_000;

const UPSERT_STUDY: &str = "
    INSERT INTO studies (name, document, submitted_ms) VALUES (?1, ?2, ?3)
    ON CONFLICT (name) DO UPDATE SET document = excluded.document, submitted_ms = excluded.submitted_ms
    RETURNING id";

/// Array elements come in their order, so that a job's number follows its place in the study.
/// (`WHERE true` keeps the parser from reading ON CONFLICT as a join's ON.)
const INSERT_JOBS: &str = "
    INSERT INTO jobs (key, payload, cost, created_ms)
    SELECT e.value ->> 0, e.value ->> 1, e.value ->> 2, ?2 FROM json_each(?1) AS e WHERE true
    ON CONFLICT (key) DO NOTHING";

/// CROSS JOIN keeps the order of the loops: a key is looked up for each row, not the rows for each job.
const INSERT_ROWS: &str = "
    INSERT INTO study_jobs (study_id, ordinal, job_id, parameters)
    SELECT ?2, ?3 + e.key, j.id, e.value ->> 1
    FROM json_each(?1) AS e CROSS JOIN jobs AS j ON j.key = e.value ->> 0";

impl Queue {
    /// Adds a study, or replaces the document and rows of the one with its name.
    ///
    /// Jobs that are there already keep their state and result. Jobs that no study refers to any more stay
    /// too: their results are paid for, and the next edit may ask for them again.
    ///
    /// # Errors
    /// [`QueueError::BadCost`], or if the database cannot be written; then nothing has changed.
    pub async fn submit(&mut self, study: &NewStudy) -> Result<Submitted, QueueError> {
        // JSON has no NaN and no infinity: they would arrive as null.
        if let Some(job) = study.jobs.iter().find(|job| !job.cost.is_finite()) {
            return Err(QueueError::BadCost { key: job.key.clone(), cost: job.cost });
        }
        let now_ms = self.clock.now_ms();
        let mut transaction = self.connection.begin_with("BEGIN IMMEDIATE").await?;
        let replaced = studies::find(&mut transaction, &study.name).await?.is_some();
        let study_id: i64 = sqlx::query_scalar(UPSERT_STUDY)
            .bind(&study.name)
            .bind(&study.document)
            .bind(now_ms)
            .fetch_one(&mut *transaction)
            .await?;
        sqlx::query("DELETE FROM study_jobs WHERE study_id = ?1")
            .bind(study_id)
            .execute(&mut *transaction)
            .await?;
        let mut added = 0;
        for (first_ordinal, chunk) in (0_i64..).step_by(CHUNK).zip(study.jobs.chunks(CHUNK)) {
            added += insert_jobs(&mut transaction, chunk, now_ms).await?;
            insert_rows(&mut transaction, study_id, first_ordinal, chunk).await?;
        }
        let counts = counts::of_study(&mut transaction, study_id).await?;
        transaction.commit().await?;

        let jobs = study.jobs.iter().map(|job| &job.key).collect::<HashSet<_>>().len() as u64;
        Ok(Submitted {
            replaced,
            rows: study.jobs.len() as u64,
            jobs,
            added,
            already_known: jobs - added,
            already_done: counts.done,
            already_failed: counts.failed,
        })
    }
}

async fn insert_jobs(
    connection: &mut SqliteConnection,
    jobs: &[NewJob],
    now_ms: i64,
) -> Result<u64, QueueError> {
    let rows: Vec<_> = jobs.iter().map(|job| (&job.key, &job.payload, job.cost)).collect();
    let inserted = sqlx::query(INSERT_JOBS).bind(json(&rows)).bind(now_ms).execute(connection).await?;
    Ok(inserted.rows_affected())
}

async fn insert_rows(
    connection: &mut SqliteConnection,
    study_id: i64,
    first_ordinal: i64,
    jobs: &[NewJob],
) -> Result<(), QueueError> {
    let rows: Vec<_> = jobs.iter().map(|job| (&job.key, &job.parameters)).collect();
    sqlx::query(INSERT_ROWS).bind(json(&rows)).bind(study_id).bind(first_ordinal).execute(connection).await?;
    Ok(())
}

fn json(rows: &impl Serialize) -> String {
    serde_json::to_string(rows).expect("strings and finite numbers have a JSON form")
}

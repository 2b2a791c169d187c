//! Migrations of databases with earlier schemas.

use sqlx::migrate::{Migration, MigrationType, Migrator};
use sqlx::{Connection, SqlSafeStr, SqliteConnection};
use tribosweep::queue::{JobState, Queue, Settings, TakenBack};

use crate::orchestration::support::{Sandbox, claim, counts, done, finish, keys, of};

/// Data of the first schema: a job in each state, a released job, two jobs that studies share, a job that is twice in a
/// study, a job that no study refers to, and results of several attempts.
const FIRST_SCHEMA_ROWS: &str = "
    INSERT INTO studies VALUES (1, 'a', 'document of a', 1000), (2, 'b', 'document of b', 2000);
    INSERT INTO jobs (id, key, cost, state, attempt, created_ms, started_ms, note, payload) VALUES
        (1, 'pending', 1.0, 'pending', 0, 10, NULL, NULL, 'payload of pending'),
        (2, 'released', 5.0, 'pending', 2, 10, 20, 'released: …', 'payload of released'),
        (3, 'running', 3.0, 'running', 2, 10, 30, 'released: …', 'payload of running'),
        (4, 'done', 4.0, 'done', 3, 10, 40, NULL, 'payload of done'),
        (5, 'failed', 2.0, 'failed', 1, 10, 50, NULL, 'payload of failed'),
        (9, 'unreferenced', 9.0, 'done', 1, 10, 60, NULL, 'payload of unreferenced');
    INSERT INTO study_jobs VALUES
        (1, 0, 1, 'a0'), (1, 1, 3, 'a1'), (1, 2, 4, 'a2'), (1, 3, 1, 'a3'),
        (2, 0, 5, 'b0'), (2, 1, 2, 'b1'), (2, 2, 3, 'b2');
    INSERT INTO results VALUES
        (4, 3, '{\"outcome\": \"well\"}', NULL, 1.25, 100),
        (5, 1, NULL, 'error of failed', 0.5, 200),
        (9, 1, 'record of unreferenced', NULL, 9.5, 300);";

/// Creates a database with the first schema.
async fn first_schema(sandbox: &Sandbox) -> SqliteConnection {
    let mut raw = sandbox.raw().await;
    sqlx::raw_sql("PRAGMA journal_mode = WAL").execute(&mut raw).await.unwrap();
    let sql = include_str!("../../../migrations/sqlite/0001_queue.sql").into_sql_str();
    let first = Migration::new(1, "queue".into(), MigrationType::Simple, sql, false);
    Migrator::with_migrations(vec![first]).run(&mut raw).await.unwrap();
    sqlx::raw_sql(FIRST_SCHEMA_ROWS).execute(&mut raw).await.unwrap();
    raw
}

/// Protects: the migration from the first schema keeps everything: studies, rows, states, attempts, results, and the
/// references between them. Running jobs become pending, because their process has ended.
#[tokio::test]
async fn the_first_schema_is_brought_up_to_date() {
    let sandbox = Sandbox::new();
    first_schema(&sandbox).await.close().await.unwrap();
    let mut queue = sandbox.open().await;

    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(2, 0, 1, 0));
    assert_eq!(queue.counts(&of("b")).await.unwrap(), counts(2, 0, 0, 1));
    let document = queue.study("b").await.unwrap().unwrap();
    assert_eq!((document.document.as_str(), document.submitted_ms), ("document of b", 2000));
    let rows: Vec<_> =
        queue.rows("a").await.unwrap().into_iter().chain(queue.rows("b").await.unwrap()).collect();
    let found: Vec<_> = rows
        .iter()
        .map(|row| (row.key.as_str(), row.parameters.as_str(), row.state, row.attempt, row.wall_s))
        .collect();
    assert_eq!(
        found,
        [
            ("pending", "a0", JobState::Pending, 0, None),
            ("running", "a1", JobState::Pending, 2, None),
            ("done", "a2", JobState::Done, 3, Some(1.25)),
            ("pending", "a3", JobState::Pending, 0, None),
            ("failed", "b0", JobState::Failed, 1, Some(0.5)),
            ("released", "b1", JobState::Pending, 2, None),
            ("running", "b2", JobState::Pending, 2, None),
        ]
    );
    assert_eq!(rows[2].record.as_deref(), Some("{\"outcome\": \"well\"}"));
    let labels: Vec<(String, Option<String>)> =
        sqlx::query_as("SELECT key, label FROM jobs WHERE state = 'done' ORDER BY id")
            .fetch_all(&mut sandbox.raw().await)
            .await
            .unwrap();
    assert_eq!(labels, [("done".into(), Some("well".into())), ("unreferenced".into(), None)]);
    let details = &queue.jobs("done", 1).await.unwrap()[0];
    assert_eq!((details.finished_ms, &details.provenance), (Some(100), &None));
    assert_eq!(rows[4].error.as_deref(), Some("error of failed"));
    assert!(rows[1].note.as_ref().unwrap().starts_with("taken back"), "{:?}", rows[1]);
    assert!(rows[5].note.as_ref().unwrap().starts_with("released"), "{:?}", rows[5]);
    assert_eq!(queue.take_back().await.unwrap(), TakenBack::default());

    // Claims work as in a new database: of a study and of all jobs, in their order.
    assert_eq!(keys(&claim(&mut queue, of("a"), 1).await), ["running"]);
    let claimed = claim(&mut queue, tribosweep::queue::Scope::All, 9).await;
    assert_eq!(keys(&claimed), ["released", "pending"]);
    assert_eq!((claimed[0].attempt, claimed[0].payload.as_str()), (3, "payload of released"));
    assert!(finish(&mut queue, "released", 3, done("r")).await);
    assert_eq!(queue.collect_garbage().await.unwrap().jobs, 1, "the job that no study refers to");
}

/// Protects: after the migration, the other tables refer to the rebuilt tables, and foreign keys are enforced.
#[tokio::test]
async fn references_hold_after_the_migration() {
    let sandbox = Sandbox::new();
    let mut raw = first_schema(&sandbox).await;
    sandbox.open().await.close().await.unwrap();
    let wrong = sqlx::query("SELECT * FROM pragma_foreign_key_check").fetch_all(&mut raw).await.unwrap();
    assert!(wrong.is_empty());
    let whole: String = sqlx::query_scalar("PRAGMA integrity_check").fetch_one(&mut raw).await.unwrap();
    assert_eq!(whole, "ok");
    for (statement, is_allowed) in [
        ("INSERT INTO study_jobs VALUES (1, 9, 77, '')", false),
        ("INSERT INTO results (job_id, attempt, record, finished_ms) VALUES (77, 1, 'r', 0)", false),
        ("DELETE FROM jobs WHERE id = 1", false),
        ("UPDATE jobs SET state = 'lost' WHERE id = 1", false),
        ("UPDATE jobs SET state = 'running' WHERE id = 1", false),
        ("UPDATE jobs SET state = 'cancelled' WHERE id = 1", true),
    ] {
        assert_eq!(sqlx::query(statement).execute(&mut raw).await.is_ok(), is_allowed, "{statement}");
    }
}

/// Protects: a migration that fails changes nothing and reports the reason, and the next opening repeats it.
#[tokio::test]
async fn a_migration_is_atomic() {
    let sandbox = Sandbox::new();
    let mut raw = first_schema(&sandbox).await;
    sqlx::raw_sql("BEGIN IMMEDIATE").execute(&mut raw).await.unwrap();
    let settings = Settings { busy_timeout: std::time::Duration::from_millis(50), ..Settings::default() };
    let opened = Queue::open_with(sandbox.location(), sandbox.clock.clock(), settings).await;
    let error = opened.unwrap_err().to_string();
    assert!(error.contains("locked"), "{error}");
    sqlx::raw_sql("ROLLBACK").execute(&mut raw).await.unwrap();
    let tables: i64 = sqlx::query_scalar("SELECT COUNT(*) FROM sqlite_schema WHERE name = 'workers'")
        .fetch_one(&mut raw)
        .await
        .unwrap();
    assert_eq!(tables, 0);
    assert_eq!(sandbox.open().await.counts(&of("a")).await.unwrap(), counts(2, 0, 1, 0));
}

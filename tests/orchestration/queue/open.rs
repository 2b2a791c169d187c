//! Opening and creating a database.

use std::fs;
use std::path::Path;
use std::sync::Barrier;
use std::thread;

use sqlx::Connection;
use tribosweep::queue::{Clock, Queue, QueueError};

use crate::orchestration::support::{Sandbox, block_on, counts, of, study};

async fn error_of(path: &Path) -> QueueError {
    Queue::open(path, Clock::OfDatabase).await.expect_err("opening should fail")
}

/// Protects: a missing database is created, keeps its data, and uses a write-ahead log.
#[tokio::test]
async fn a_new_database_is_created_and_kept() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    queue.close().await.unwrap();

    let mut again = Queue::open_to_read(sandbox.location(), sandbox.clock.clock()).await.unwrap();
    assert_eq!(again.counts(&of("a")).await.unwrap(), counts(2, 0, 0, 0));
    assert_eq!(again.location(), &sandbox.location());
    let mode: String =
        sqlx::query_scalar("PRAGMA journal_mode").fetch_one(&mut sandbox.raw().await).await.unwrap();
    assert_eq!(mode, "wal");
}

/// Protects: opening a mistyped path for reading creates no database and no lock file, and the error says what to do.
#[tokio::test]
async fn reading_creates_nothing() {
    let sandbox = Sandbox::new();
    let error = Queue::open_to_read(sandbox.location(), sandbox.clock.clock()).await.unwrap_err();
    assert!(matches!(error, QueueError::NoDatabase { .. }), "{error:?}");
    assert!(
        error
            .to_string()
            .contains("sweep.db: `tribosweep run STUDY` makes one, and `--db` names one in another place")
    );
    assert_eq!(fs::read_dir(sandbox.folder.path()).unwrap().count(), 0);
}

/// Protects: a missing folder is named, not reported as `SQLite`'s "unable to open database file".
#[tokio::test]
async fn a_missing_folder_is_named() {
    let sandbox = Sandbox::new();
    let error = error_of(&sandbox.folder.path().join("missing/sweep.db")).await;
    assert!(matches!(error, QueueError::NoFolder { .. }), "{error:?}");
    assert!(error.to_string().contains("/missing for the database does not exist"), "{error}");
}

/// Protects: a file that is not a database, and a folder, are refused and not changed.
#[tokio::test]
async fn a_file_that_is_not_a_database_is_refused() {
    let sandbox = Sandbox::new();
    let text = "this is a study, not a database\n".repeat(100);
    fs::write(sandbox.database(), &text).unwrap();
    let error = error_of(&sandbox.database()).await;
    assert!(matches!(error, QueueError::NotADatabase { .. }), "{error:?}");
    let error = error_of(sandbox.folder.path()).await;
    assert!(matches!(error, QueueError::NotAFile { .. }), "{error:?}");
    assert_eq!(fs::read_to_string(sandbox.database()).unwrap(), text);
}

/// Protects: the database of another program is refused. Its tables and its journal mode stay as they are.
#[tokio::test]
async fn another_programs_database_is_refused() {
    let sandbox = Sandbox::new();
    let mut raw = sandbox.raw().await;
    sqlx::query("CREATE TABLE songs (title TEXT)").execute(&mut raw).await.unwrap();

    let error = error_of(&sandbox.database()).await;
    assert!(matches!(error, QueueError::ForeignDatabase { .. }), "{error:?}");
    let tables: Vec<String> =
        sqlx::query_scalar("SELECT name FROM sqlite_schema").fetch_all(&mut raw).await.unwrap();
    assert_eq!(tables, ["songs"]);
    let mode: String = sqlx::query_scalar("PRAGMA journal_mode").fetch_one(&mut raw).await.unwrap();
    assert_eq!(mode, "delete");
}

/// Protects: a database whose creation was stopped before the first migration can be opened.
#[tokio::test]
async fn an_interrupted_creation_is_completed() {
    let sandbox = Sandbox::new();
    sandbox.open().await.close().await.unwrap();
    let mut raw = sandbox.raw().await;
    for statement in [
        "PRAGMA application_id = 0",
        "DROP TABLE checkpoints",
        "DROP TABLE final_states",
        "DROP TABLE plans",
        "DROP TABLE payloads",
        "DROP TABLE study_pending",
        "DROP TABLE results",
        "DROP TABLE study_jobs",
        "DROP TABLE jobs",
        "DROP TABLE studies",
        "DROP TABLE workers",
        "DELETE FROM _sqlx_migrations",
    ] {
        sqlx::query(statement).execute(&mut raw).await.unwrap();
    }
    raw.close().await.unwrap();
    assert_eq!(sandbox.open().await.submit(&study("a", &["x"])).await.unwrap().added, 1);
}

/// Protects: an older program does not write to a schema that it does not know.
#[tokio::test]
async fn a_newer_database_is_refused() {
    let sandbox = Sandbox::new();
    sandbox.open().await.close().await.unwrap();
    sqlx::query(
        "INSERT INTO _sqlx_migrations (version, description, success, checksum, execution_time)
         VALUES (9001, 'from the future', TRUE, x'00', 0)",
    )
    .execute(&mut sandbox.raw().await)
    .await
    .unwrap();

    let error = error_of(&sandbox.database()).await;
    assert!(matches!(error, QueueError::NewerDatabase { found: 9001, .. }), "{error:?}");
    assert!(error.to_string().contains("newer tribosweep (schema 9001; this one knows up to 5)"), "{error}");
}

/// Protects: if several processes open a missing database at the same time, all of them succeed. Without the opening
/// lock, some of them fail with "database is locked" or "table already exists".
#[test]
fn first_opens_at_once_all_succeed() {
    const OPENERS: usize = 8;
    for _ in 0..4 {
        let sandbox = Sandbox::new();
        let start = Barrier::new(OPENERS);
        thread::scope(|scope| {
            for index in 0..OPENERS {
                let (sandbox, start) = (&sandbox, &start);
                scope.spawn(move || {
                    start.wait();
                    block_on(async {
                        let mut queue = sandbox.open().await;
                        queue.submit(&study(&format!("study {index}"), &["shared"])).await.unwrap();
                        queue.close().await.unwrap();
                    });
                });
            }
        });
        let studies = block_on(async { sandbox.open().await.studies().await.unwrap() });
        assert_eq!(studies.len(), OPENERS);
    }
}

/// Protects: two tasks of one single-threaded runtime that open the same database do not deadlock.
#[tokio::test]
async fn two_opens_on_one_thread_do_not_block_each_other() {
    let sandbox = Sandbox::new();
    let (mut first, mut second) = tokio::join!(sandbox.open(), sandbox.open());
    first.submit(&study("a", &["x"])).await.unwrap();
    assert_eq!(second.counts(&of("a")).await.unwrap(), counts(1, 0, 0, 0));
}

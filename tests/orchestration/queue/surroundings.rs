//! Problems of a database's environment: locks, full disks, read-only files, damage. Each one leads to a message that
//! says what to do, and nothing is lost.

use std::fs;
use std::time::Duration;

use tribosweep::queue::{Queue, QueueError, Scope, Settings, examine};

use crate::mount::Mount;
use crate::orchestration::support::{Sandbox, claim, counts, done, finish, of, study};

fn impatient() -> Settings {
    Settings { busy_timeout: Duration::from_millis(50), ..Settings::default() }
}

/// Protects: if another program holds a lock for longer than the busy timeout, the error says so. The caller can store
/// its outcomes afterwards, and readers are not blocked.
#[tokio::test]
async fn a_lock_that_is_kept() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open_with(impatient()).await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    claim(&mut queue, Scope::All, 1).await;
    let mut foreign = sandbox.raw().await;
    sqlx::raw_sql("BEGIN IMMEDIATE").execute(&mut foreign).await.unwrap();
    let errors = [
        queue.submit(&study("b", &["z"])).await.unwrap_err(),
        queue.exchange(&[], &[]).await.unwrap_err(),
        queue.heartbeat().await.unwrap_err(),
        queue.cancel("a").await.unwrap_err(),
    ];
    for error in errors {
        assert!(matches!(error, QueueError::Locked { .. }), "{error:?}");
        assert!(error.to_string().contains("another program holds a lock"), "{error}");
    }
    let mut reader = Queue::open_with(sandbox.location(), sandbox.clock.clock(), impatient()).await.unwrap();
    assert_eq!(reader.counts(&of("a")).await.unwrap(), counts(1, 1, 0, 0));
    sqlx::raw_sql("ROLLBACK").execute(&mut foreign).await.unwrap();
    assert!(finish(&mut queue, "x", 1, done("r")).await);
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(1, 0, 1, 0));
}

/// Protects: a full disk is reported as such. Stored results are kept, and the same queue continues when there is room
/// again.
#[tokio::test]
async fn a_full_disk() {
    let sandbox = Sandbox::new();
    let Some(mount) = Mount::new(sandbox.folder.path(), "size=1M") else { return };
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    claim(&mut queue, Scope::All, 2).await;
    assert!(finish(&mut queue, "x", 1, done("r")).await);
    // The record is larger than the free space.
    let large = "r".repeat(2_000_000);
    let finished =
        tribosweep::queue::Finished { key: "y".into(), attempt: 1, outcome: done(&large), wall_s: 1.0 };
    let error = queue.exchange(std::slice::from_ref(&finished), &[]).await.unwrap_err();
    assert!(matches!(error, QueueError::DiskFull(_)), "{error:?}");
    assert!(error.to_string().contains("Make room"), "{error}");
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(0, 1, 1, 0));
    mount.remount("size=20M");
    assert!(queue.exchange(&[finished], &[]).await.unwrap().refused.is_empty());
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(0, 0, 2, 0));
    assert_eq!(queue.rows("a").await.unwrap()[0].record.as_deref(), Some("r"));
    queue.close().await.unwrap();
}

/// Protects: a worker that finds no room to register learns that the disk is full, and can claim nothing.
#[tokio::test]
async fn a_full_disk_at_the_beginning() {
    let sandbox = Sandbox::new();
    let Some(mount) = Mount::new(sandbox.folder.path(), "size=2M") else { return };
    let mut queue = Queue::open(sandbox.location(), sandbox.clock.clock()).await.unwrap();
    queue.submit(&study("a", &["x"])).await.unwrap();
    // This is more than the free space.
    let _ = fs::write(sandbox.folder.path().join("filler"), vec![0; 3_000_000]);
    let worker = tribosweep::queue::Worker::this_process(1, "test", "provenance");
    let error = loop {
        // The page of the first workers may be in the log already.
        match queue.register(&worker).await {
            Ok(()) => {}
            Err(error) => break error,
        }
    };
    assert!(matches!(error, QueueError::DiskFull(_)), "{error:?}");
    mount.remount("size=20M");
    queue.register(&worker).await.unwrap();
    assert_eq!(claim(&mut queue, Scope::All, 1).await.len(), 1);
}

/// Protects: a read-only database can be read without changing anything, and the error of a write says what is wrong.
#[tokio::test]
async fn a_read_only_folder() {
    let sandbox = Sandbox::new();
    let Some(mount) = Mount::new(sandbox.folder.path(), "size=20M") else { return };
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    claim(&mut queue, Scope::All, 1).await;
    assert!(finish(&mut queue, "x", 1, done("r")).await);
    queue.close().await.unwrap();
    mount.remount("ro");

    let mut reader = Queue::open_to_read(sandbox.location(), sandbox.clock.clock()).await.unwrap();
    assert_eq!(reader.counts(&of("a")).await.unwrap(), counts(1, 0, 1, 0));
    assert_eq!(reader.rows("a").await.unwrap()[0].record.as_deref(), Some("r"));
    let error = reader.cancel("a").await.unwrap_err();
    assert!(matches!(error, QueueError::ReadOnly(_)), "{error:?}");
    let findings = examine(&sandbox.location(), sandbox.clock.clock()).await.unwrap();
    let problems: Vec<_> = findings.iter().filter(|finding| finding.is_problem).collect();
    assert_eq!(problems.iter().map(|finding| finding.subject).collect::<Vec<_>>(), ["writable"]);
    let error = Queue::open(sandbox.location(), sandbox.clock.clock()).await.unwrap_err();
    assert!(error.to_string().contains("Read-only file system"), "{error}");
}

/// Protects: a read-only database with a write-ahead log is refused. If the log were ignored, its results would be
/// missing without a message.
#[tokio::test]
async fn a_log_in_a_read_only_folder() {
    let (sandbox, copy) = (Sandbox::new(), Sandbox::new());
    let Some(mount) = Mount::new(copy.folder.path(), "size=20M") else { return };
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x"])).await.unwrap();
    for suffix in ["", "-wal"] {
        let name = format!("sweep.db{suffix}");
        fs::copy(sandbox.folder.path().join(&name), copy.folder.path().join(&name)).unwrap();
    }
    mount.remount("ro");
    let error = Queue::open_to_read(copy.location(), copy.clock.clock()).await.unwrap_err();
    assert!(matches!(error, QueueError::UnreadableLog { .. }), "{error:?}");
    assert!(error.to_string().contains("-wal to a folder that can be written"), "{error}");
}

/// Protects: damage is reported as such, by the operation that meets it and by the examination, and the file stays
/// unchanged.
#[tokio::test]
async fn a_damaged_file() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    let keys: Vec<String> = (0..500).map(|index| format!("job {index}")).collect();
    queue.submit(&study("a", &keys.iter().map(String::as_str).collect::<Vec<_>>())).await.unwrap();
    queue.close().await.unwrap();
    let healthy = examine(&sandbox.location(), sandbox.clock.clock()).await.unwrap();
    assert!(healthy.iter().all(|finding| !finding.is_problem), "{healthy:#?}");

    let mut bytes = fs::read(sandbox.database()).unwrap();
    // The second half only: the first pages contain the schema.
    let from = bytes.len() / 2;
    bytes[from..].fill(0x5a);
    fs::write(sandbox.database(), &bytes).unwrap();
    let findings = examine(&sandbox.location(), sandbox.clock.clock()).await.unwrap();
    assert!(findings.iter().any(|finding| finding.is_problem), "{findings:#?}");
    let mut queue = Queue::open_to_read(sandbox.location(), sandbox.clock.clock()).await.unwrap();
    let error = queue.rows("a").await.unwrap_err();
    assert!(matches!(error, QueueError::Damaged(_)), "{error:?}");
    assert!(error.to_string().contains("tribosweep doctor"), "{error}");
    assert_eq!(fs::read(sandbox.database()).unwrap(), bytes);
}

/// Protects: the examination reports how many jobs of dead processes the next worker will take back, and lists all
/// workers.
#[tokio::test]
async fn the_examination_sees_workers() {
    let sandbox = Sandbox::new();
    let mut dead = sandbox.open_as(&crate::orchestration::support::dead_worker()).await;
    let mut alive = sandbox.open().await;
    alive.submit(&study("a", &["x", "y", "z"])).await.unwrap();
    claim(&mut dead, Scope::All, 2).await;
    claim(&mut alive, Scope::All, 1).await;
    let findings = examine(&sandbox.location(), sandbox.clock.clock()).await.unwrap();
    let text: Vec<_> = findings.iter().map(|finding| finding.text.as_str()).collect();
    assert!(
        text.iter()
            .any(|text| text.starts_with("running jobs: 3, of which processes that are gone have left 2")),
        "{text:#?}"
    );
    assert!(text.iter().any(|text| text.contains("gone, running jobs: 2")), "{text:#?}");
    assert!(text.iter().any(|text| text.contains("alive, running jobs: 1")), "{text:#?}");
    let missing =
        examine(&sandbox.folder.path().join("none.db").into(), sandbox.clock.clock()).await.unwrap_err();
    assert!(matches!(missing, QueueError::NoDatabase { .. }), "{missing:?}");
}

//! A database file that is deleted, moved or replaced while a process works on it.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::{Path, PathBuf};

use tribosweep::queue::{Finished, Queue, QueueError};

use crate::orchestration::support::{Sandbox, claim, counts, done, of, study};

/// A queue whose worker has stored the result of `x` and has that of `y` ready, while it runs `z`.
async fn at_work(sandbox: &Sandbox) -> (Queue, Finished) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y", "z"])).await.unwrap();
    claim(&mut queue, of("a"), 3).await;
    let finished = |key: &str| Finished { key: key.into(), attempt: 1, outcome: done("r"), wall_s: 1.0 };
    queue.exchange(&[finished("x")], &[]).await.unwrap();
    (queue, finished("y"))
}

/// Lets the queue notice it, and rescues the result that is ready. Returns the path that the error names.
async fn rescue(mut queue: Queue, ready: Finished, expected: &str) -> PathBuf {
    for error in [
        queue.heartbeat().await.unwrap_err(),
        queue.exchange(std::slice::from_ref(&ready), &[]).await.unwrap_err(),
        queue.submit(&study("b", &["w"])).await.unwrap_err(),
    ] {
        assert!(matches!(error, QueueError::Displaced { .. }), "{error:?}");
    }
    let error = queue.exchange(std::slice::from_ref(&ready), &[]).await.unwrap_err();
    let text = queue.rescue(&[ready], error).await.to_string();
    assert!(text.contains(expected) && text.contains("1 result that was ready"), "{text}");
    let (_, place) = text.split_once("is in ").unwrap();
    place.split_once(": move").unwrap().0.into()
}

/// Both results are there, and the job that ran is pending.
async fn assert_kept(sandbox: &Sandbox, place: &Path) {
    let mut kept = Queue::open(place, sandbox.clock.clock()).await.unwrap();
    assert_eq!(kept.counts(&of("a")).await.unwrap(), counts(1, 0, 2, 0));
    kept.close().await.unwrap();
}

fn log(sandbox: &Sandbox) -> PathBuf {
    sandbox.folder.path().join("sweep.db-wal")
}

/// Protects: the results of a database that is deleted under a worker, stored or ready, are in a copy that the error names.
#[tokio::test]
async fn a_file_that_is_deleted() {
    let sandbox = Sandbox::new();
    let (queue, ready) = at_work(&sandbox).await;
    for suffix in ["", "-wal", "-shm"] {
        fs::remove_file(sandbox.folder.path().join(format!("sweep.db{suffix}"))).unwrap();
    }
    // Another process has made a new database in the meantime.
    let mut new = Queue::open(sandbox.location(), sandbox.clock.clock()).await.unwrap();
    new.submit(&study("new", &["n"])).await.unwrap();
    let place = rescue(queue, ready, "replaced by another file").await;
    assert!(log(&sandbox).exists(), "the log of the new database stays");
    new.submit(&study("newer", &["n"])).await.unwrap();
    assert_eq!(new.studies().await.unwrap().len(), 2);
    new.close().await.unwrap();
    assert_kept(&sandbox, &place).await;
}

/// Protects: a database that is moved under a worker has all its results at its new place, and its log is gone from the old
/// one.
#[tokio::test]
async fn a_file_that_is_moved() {
    let sandbox = Sandbox::new();
    let (queue, ready) = at_work(&sandbox).await;
    let moved = sandbox.folder.path().join("elsewhere.db");
    fs::rename(sandbox.database(), &moved).unwrap();
    let place = rescue(queue, ready, "moved to").await;
    assert_eq!(place, moved.canonicalize().unwrap());
    assert!(!log(&sandbox).exists());
    assert_kept(&sandbox, &place).await;
}

/// Protects: a file that is moved to the path of a database that a worker has open stays as it was, and the log that lies
/// beside it is not taken for its own.
#[tokio::test]
async fn a_file_that_is_replaced() {
    let sandbox = Sandbox::new();
    let other = sandbox.another();
    let mut new = other.open().await;
    new.submit(&study("new", &["n"])).await.unwrap();
    new.close().await.unwrap();
    let (queue, ready) = at_work(&sandbox).await;
    fs::rename(other.database(), sandbox.database()).unwrap();
    let bytes = fs::read(sandbox.database()).unwrap();
    for error in [
        Queue::open(sandbox.location(), sandbox.clock.clock()).await.unwrap_err(),
        Queue::open_to_read(sandbox.location(), sandbox.clock.clock()).await.unwrap_err(),
    ] {
        assert!(matches!(error, QueueError::LogOfAnother { .. }), "{error:?}");
    }
    let place = rescue(queue, ready, "replaced by another file").await;
    assert!(!log(&sandbox).exists());
    assert_eq!(fs::read(sandbox.database()).unwrap(), bytes);
    let mut new = Queue::open(sandbox.location(), sandbox.clock.clock()).await.unwrap();
    assert_eq!(new.counts(&of("new")).await.unwrap(), counts(1, 0, 0, 0));
    new.close().await.unwrap();
    assert_kept(&sandbox, &place).await;
}

/// Protects: a copy of a database with its log is opened, wherever it lies.
#[tokio::test]
async fn a_copy_with_its_log() {
    let (sandbox, copy) = (Sandbox::new(), Sandbox::new());
    let (queue, _) = at_work(&sandbox).await;
    for file in fs::read_dir(sandbox.folder.path()).unwrap() {
        let file = file.unwrap();
        fs::copy(file.path(), copy.folder.path().join(file.file_name())).unwrap();
    }
    let mut copied = Queue::open(copy.location(), copy.clock.clock()).await.unwrap();
    assert_eq!(copied.counts(&of("a")).await.unwrap(), counts(0, 2, 1, 0));
    queue.close().await.unwrap();
}

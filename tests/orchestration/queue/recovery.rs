//! Interruptions, and processes that die.

use tribosweep::queue::{FinishedOutcome, JobState, QueueError, Scope, WorkerLock};

use crate::support::{Sandbox, claim, counts, done, finish, keys, study};

/// Protects: a job given back by an interrupted worker is pending again, with the reason, and its next
/// start is a new attempt.
#[tokio::test]
async fn a_released_job_is_claimed_again() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x"])).await.unwrap();
    claim(&mut queue, Scope::All, 1).await;
    assert!(finish(&mut queue, "x", 1, FinishedOutcome::Released).await);
    let row = queue.rows("a").await.unwrap().remove(0);
    assert_eq!((row.state, row.attempt), (JobState::Pending, 1));
    assert!(row.note.unwrap().starts_with("released"));
    assert_eq!(claim(&mut queue, Scope::All, 1).await[0].attempt, 2);
}

/// Protects: jobs that a dead process left running are taken back by the next one, with the reason; what
/// was done or pending stays so, and a result the dead process still sends is refused.
#[tokio::test]
async fn jobs_of_a_dead_process_are_taken_back() {
    let sandbox = Sandbox::new();
    let mut dead = sandbox.open().await;
    let lock = WorkerLock::acquire(&sandbox.database()).unwrap();
    dead.submit(&study("a", &["x", "y", "z", "w"])).await.unwrap();
    claim(&mut dead, Scope::All, 3).await;
    assert!(finish(&mut dead, "x", 1, done("record of x")).await);
    drop(lock);

    let mut queue = sandbox.open().await;
    let lock = WorkerLock::acquire(&sandbox.database()).unwrap();
    assert_eq!(queue.take_back(&lock).await.unwrap(), 2);
    assert_eq!(queue.take_back(&lock).await.unwrap(), 0);
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(3, 0, 1, 0));
    let notes: Vec<_> = queue.rows("a").await.unwrap().into_iter().map(|row| row.note).collect();
    assert!(notes[0].is_none() && notes[3].is_none(), "{notes:?}");
    assert!(notes[1].as_ref().unwrap().starts_with("taken back"), "{notes:?}");
    assert_eq!(notes[1], notes[2]);

    let claimed = claim(&mut queue, Scope::All, 9).await;
    assert_eq!(keys(&claimed), ["y", "z", "w"]);
    assert_eq!(claimed.iter().map(|job| job.attempt).collect::<Vec<_>>(), [2, 2, 1]);
    assert!(!finish(&mut dead, "y", 1, done("late")).await);
}

/// Protects: two processes never work on one database, also when one is given a symbolic link to it, since
/// the second would take back the jobs the first is running.
#[tokio::test]
async fn the_worker_lock_excludes_a_second() {
    let sandbox = Sandbox::new();
    sandbox.open().await;
    let link = sandbox.folder.path().join("link.db");
    #[cfg(unix)]
    std::os::unix::fs::symlink(sandbox.database(), &link).unwrap();
    #[cfg(not(unix))]
    let link = sandbox.database();

    let lock = WorkerLock::acquire(&sandbox.database()).unwrap();
    for path in [&sandbox.database(), &link] {
        let error = WorkerLock::acquire(path).unwrap_err();
        assert!(matches!(error, QueueError::AlreadyWorking { .. }), "{error:?}");
        assert!(error.to_string().contains("another `tribosweep work` or `tribosweep run`"), "{error}");
    }
    drop(lock);
    WorkerLock::acquire(&link).unwrap();
}

/// Protects: the lock of one database is no licence to take back the jobs of another.
#[tokio::test]
#[should_panic(expected = "another database")]
async fn a_lock_is_for_its_own_database() {
    let (sandbox, other) = (Sandbox::new(), Sandbox::new());
    let mut queue = sandbox.open().await;
    let lock = WorkerLock::acquire(&other.database()).unwrap();
    let _ = queue.take_back(&lock).await;
}

//! A database that makes the worker wait.

use std::time::{Duration, Instant};

use tokio::sync::oneshot;
use tribosweep::queue::{Queue, Scope, Settings};
use tribosweep::worker::{Interrupt, WorkOptions, work};

use super::{Recorder, several, solvable, spec, submit};
use crate::orchestration::support::Sandbox;

/// A queue whose requests fail soon, so that the worker has to repeat them.
async fn queue_with_short_timeout(sandbox: &Sandbox) -> Queue {
    sandbox.open_with(Settings { busy_timeout: Duration::from_millis(20), ..Settings::default() }).await
}

/// A task that locks the database for some time.
struct Lock {
    /// Starts the task.
    begin: oneshot::Sender<()>,
    /// Tells when the database is locked.
    is_locked: oneshot::Receiver<()>,
    task: tokio::task::JoinHandle<()>,
}

impl Lock {
    async fn new(sandbox: &Sandbox, time: Duration) -> Self {
        let mut raw = sandbox.raw().await;
        let (begin, begun) = oneshot::channel();
        let (locked, is_locked) = oneshot::channel();
        let task = tokio::spawn(async move {
            begun.await.unwrap();
            sqlx::raw_sql("BEGIN IMMEDIATE").execute(&mut raw).await.unwrap();
            // A test that has no use for this event drops the receiver.
            let _ = locked.send(());
            tokio::time::sleep(time).await;
            sqlx::raw_sql("ROLLBACK").execute(&mut raw).await.unwrap();
        });
        Self { begin, is_locked, task }
    }
}

/// Protects: while the database is locked, or its disk is slow, running jobs go on at their speed. Jobs that end meanwhile
/// are stored afterwards.
#[tokio::test]
async fn the_solver_does_not_wait_for_the_database() {
    const LOCKED_FOR: Duration = Duration::from_secs(2);
    let sandbox = Sandbox::new();
    let mut queue = queue_with_short_timeout(&sandbox).await;
    // One job outlasts the lock. Of the others some end during the lock, on a fast machine as on a slow one.
    let mut jobs = several(7, 50.0);
    for (i, job) in (1..).zip(&mut jobs[1..]) {
        *job = solvable(&job.key, &spec(0.2, 0.01 * 1.6_f64.powi(i)));
    }
    submit(&mut queue, "study", jobs).await;

    let lock = Lock::new(&sandbox, LOCKED_FOR).await;
    let interrupt = Interrupt::default();
    let raised = interrupt.clone();
    let mut begin = Some(lock.begin);
    let mut shown = Vec::new();
    let mut recorder = Recorder::new(|snapshot| {
        let long = snapshot.running.iter().find(|job| job.key == "a").filter(|job| job.simulated_s > 0.0);
        let Some(long) = long else { return };
        shown.push((Instant::now(), long.simulated_s));
        if let Some(begin) = begin.take() {
            begin.send(()).unwrap();
        }
        if snapshot.counts.done == 6 {
            raised.raise();
        }
    });
    let options = WorkOptions { checkpoint_interval: None, ..WorkOptions::new(1) };
    let summary = work(&mut queue, &Scope::All, options, &interrupt, &mut recorder).await.unwrap();
    lock.task.await.unwrap();
    assert_eq!(summary.counts.done, 6);

    // No progress is shown while a turn waits for the lock.
    let steps = shown.windows(2).map(|pair| (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1));
    let (silence, simulated_s) = steps.max_by_key(|(time, _)| *time).unwrap();
    assert!(silence > LOCKED_FOR / 2, "no turn waited for the lock: {shown:?}");
    let whole = (shown[shown.len() - 1].0 - shown[0].0, shown[shown.len() - 1].1 - shown[0].1);
    let speed = |(time, simulated_s): (Duration, f64)| simulated_s / time.as_secs_f64();
    // A solver that waited for the database would advance only before the lock, during one tick of 0.25 s. One that does
    // not wait may still be slower in the silence than later, because more jobs share its thread: half as fast at worst.
    assert!(speed((silence, simulated_s)) > 0.25 * speed(whole), "{shown:?}");
}

/// Protects: if the worker is asked to stop while the database is locked, ended jobs are stored and running jobs are given
/// back all the same.
#[tokio::test]
async fn an_interruption_waits_for_the_lock() {
    const LOCKED_FOR: Duration = Duration::from_secs(1);
    let sandbox = Sandbox::new();
    let mut queue = queue_with_short_timeout(&sandbox).await;
    submit(&mut queue, "study", several(7, 50.0)).await;
    let lock = Lock::new(&sandbox, LOCKED_FOR).await;
    let interrupt = Interrupt::default();
    let raised = interrupt.clone();
    let mut begin = Some(lock.begin);
    let mut recorder = Recorder::new(|snapshot| {
        if snapshot.running.iter().any(|job| job.simulated_s > 0.0)
            && let Some(begin) = begin.take()
        {
            begin.send(()).unwrap();
        }
    });
    let stopper = tokio::spawn(async move {
        lock.is_locked.await.unwrap();
        raised.raise();
    });
    let summary =
        work(&mut queue, &Scope::All, WorkOptions::new(1), &interrupt, &mut recorder).await.unwrap();
    stopper.await.unwrap();
    lock.task.await.unwrap();
    assert!(summary.interrupted);
    assert_eq!((summary.counts.running, summary.counts.pending), (0, 7));
    let rows = queue.rows("study").await.unwrap();
    assert!(rows.iter().all(|row| row.crashes == 0), "{rows:?}");
}

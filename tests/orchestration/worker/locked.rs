//! A database that keeps the worker waiting.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use tokio::sync::oneshot;
use tribosweep::queue::{Queue, Scope, Settings};
use tribosweep::worker::{Interrupt, WorkOptions, work};

use super::{Recorder, several, solvable, spec, submit};
use crate::support::Sandbox;

/// A queue that asks again and again rather than wait.
async fn impatient(sandbox: &Sandbox) -> Queue {
    sandbox.open_with(Settings { busy_timeout: Duration::from_millis(20), ..Settings::default() }).await
}

/// Locks the database for some time when it is told to.
async fn lock_for(sandbox: &Sandbox, time: Duration) -> (oneshot::Sender<()>, tokio::task::JoinHandle<()>) {
    let mut raw = sandbox.raw().await;
    let (begin, begun) = oneshot::channel();
    let other = tokio::spawn(async move {
        begun.await.unwrap();
        sqlx::raw_sql("BEGIN IMMEDIATE").execute(&mut raw).await.unwrap();
        tokio::time::sleep(time).await;
        sqlx::raw_sql("ROLLBACK").execute(&mut raw).await.unwrap();
    });
    (begin, other)
}

/// Protects: while the database is locked, or its disk slow, running jobs go on at their pace; what ended meanwhile is
/// stored afterwards.
#[tokio::test]
async fn the_solver_does_not_wait_for_the_database() {
    const KEPT: Duration = Duration::from_secs(2);
    let sandbox = Sandbox::new();
    let mut queue = impatient(&sandbox).await;
    // One that outlasts the lock, and some of which one or other ends while it is there, on a fast machine and a slow one.
    let mut jobs = several(7, 50.0);
    for (i, job) in (1..).zip(&mut jobs[1..]) {
        *job = solvable(&job.key, &spec(0.2, 0.01 * 1.6_f64.powi(i)));
    }
    submit(&mut queue, "study", jobs).await;

    let (begin, other) = lock_for(&sandbox, KEPT).await;
    let interrupt = Interrupt::default();
    let raised = interrupt.clone();
    let mut begin = Some(begin);
    let mut places = Vec::new();
    let mut recorder = Recorder::new(|snapshot| {
        let long = snapshot.running.iter().find(|job| job.key == "a").filter(|job| job.simulated_s > 0.0);
        let Some(long) = long else { return };
        places.push((Instant::now(), long.simulated_s));
        if let Some(begin) = begin.take() {
            begin.send(()).unwrap();
        }
        if snapshot.counts.done == 6 {
            raised.raise();
        }
    });
    let options = WorkOptions { checkpoint_interval: None, ..WorkOptions::new(1) };
    let summary = work(&mut queue, &Scope::All, options, &interrupt, &mut recorder).await.unwrap();
    other.await.unwrap();
    assert_eq!(summary.counts.done, 6);

    // Nothing is shown while a turn waits for the lock.
    let steps = places.windows(2).map(|pair| (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1));
    let (silence, simulated_s) = steps.max_by_key(|(time, _)| *time).unwrap();
    assert!(silence > KEPT / 2, "the lock was met: {places:?}");
    let whole = (places[places.len() - 1].0 - places[0].0, places[places.len() - 1].1 - places[0].1);
    let pace = |(time, simulated_s): (Duration, f64)| simulated_s / time.as_secs_f64();
    // A solver that waited would get on in what of the silence is before the lock, a tick of 0.25 s. One that does not is
    // slowed by its companions, if there are more of them in the silence than later: to a half at worst.
    assert!(pace((silence, simulated_s)) > 0.25 * pace(whole), "{places:?}");
}

/// Protects: what ends while the database is locked is stored, and what runs is given back, also when the worker is asked
/// to stop meanwhile.
#[tokio::test]
async fn an_interruption_waits_for_the_lock() {
    const KEPT: Duration = Duration::from_secs(1);
    let sandbox = Sandbox::new();
    let mut queue = impatient(&sandbox).await;
    submit(&mut queue, "study", several(7, 50.0)).await;
    let (begin, other) = lock_for(&sandbox, KEPT).await;
    let (interrupt, is_begun) = (Interrupt::default(), Arc::new(AtomicBool::new(false)));
    let (raised, seen) = (interrupt.clone(), Arc::clone(&is_begun));
    let mut begin = Some(begin);
    let mut recorder = Recorder::new(|snapshot| {
        if snapshot.running.iter().any(|job| job.simulated_s > 0.0)
            && let Some(begin) = begin.take()
        {
            begin.send(()).unwrap();
            seen.store(true, Ordering::Relaxed);
        }
    });
    let stopper = tokio::spawn(async move {
        while !is_begun.load(Ordering::Relaxed) {
            tokio::time::sleep(Duration::from_millis(5)).await;
        }
        tokio::time::sleep(KEPT / 4).await;
        raised.raise();
    });
    let summary =
        work(&mut queue, &Scope::All, WorkOptions::new(1), &interrupt, &mut recorder).await.unwrap();
    stopper.await.unwrap();
    other.await.unwrap();
    assert!(summary.interrupted);
    assert_eq!((summary.counts.running, summary.counts.pending), (0, 7));
    let rows = queue.rows("study").await.unwrap();
    assert!(rows.iter().all(|row| row.crashes == 0), "{rows:?}");
}

//! A database that keeps the worker waiting.

use std::time::{Duration, Instant};

use tokio::sync::oneshot;
use tribosweep::queue::{Scope, Settings};
use tribosweep::worker::{Interrupt, WorkOptions, work};

use super::{Recorder, several, solvable, spec, submit};
use crate::support::Sandbox;

/// Protects: while the database is locked, or its disk slow, running jobs go on at their pace; what ended meanwhile is
/// stored afterwards.
#[tokio::test]
async fn the_solver_does_not_wait_for_the_database() {
    const KEPT: Duration = Duration::from_millis(600);
    let sandbox = Sandbox::new();
    let mut queue =
        sandbox.open_with(Settings { busy_timeout: Duration::from_millis(20), ..Settings::default() }).await;
    // One that outlasts the lock, and some of which one or other ends while it is there, on a fast machine and a slow one.
    let mut jobs = several(7, 50.0);
    for (i, job) in (1..).zip(&mut jobs[1..]) {
        *job = solvable(&job.key, &spec(0.2, 0.01 * 1.6_f64.powi(i)));
    }
    submit(&mut queue, "study", jobs).await;

    let mut raw = sandbox.raw().await;
    let (begun, begin) = oneshot::channel();
    let other = tokio::spawn(async move {
        begin.await.unwrap();
        sqlx::raw_sql("BEGIN IMMEDIATE").execute(&mut raw).await.unwrap();
        tokio::time::sleep(KEPT).await;
        sqlx::raw_sql("ROLLBACK").execute(&mut raw).await.unwrap();
    });
    let interrupt = Interrupt::default();
    let raised = interrupt.clone();
    let mut begun = Some(begun);
    let mut places = Vec::new();
    let mut recorder = Recorder::new(|snapshot| {
        let long = snapshot.running.iter().find(|job| job.key == "a").filter(|job| job.simulated_s > 0.0);
        let Some(long) = long else { return };
        places.push((Instant::now(), long.simulated_s));
        if let Some(begun) = begun.take() {
            begun.send(()).unwrap();
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
    // The job's companions end in the silence, which makes it faster if anything.
    assert!(pace((silence, simulated_s)) > 0.5 * pace(whole), "{places:?}");
}

//! A worker that is asked to stop.

use std::time::Duration;
use tribosweep::analysis::{Unobserved, solve};
use tribosweep::queue::{JobState, Scope, TakenBack};
use tribosweep::worker::{Interrupt, SilentProgress, WorkOptions, work};

use super::{Recorder, row, several, submit};
use crate::orchestration::support::{Sandbox, claim, counts, dead_worker};

/// Protects: a worker that is asked to stop before it starts claims nothing, and reports that work is left.
#[tokio::test]
async fn an_early_interrupt_claims_nothing() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    submit(&mut queue, "study", several(3, 0.001)).await;
    let interrupt = Interrupt::default();
    interrupt.raise();
    let mut recorder = Recorder::new(|_| ());
    let summary =
        work(&mut queue, &Scope::All, WorkOptions::new(2), &interrupt, &mut recorder).await.unwrap();
    assert!(summary.interrupted);
    assert_eq!(summary.counts, counts(3, 0, 0, 0));
    assert_eq!(recorder.stopped.len(), 1);
    let rows = queue.rows("study").await.unwrap();
    assert!(rows.iter().all(|row| row.attempt == 0 && row.note.is_none()), "{rows:?}");
}

/// Protects: an interrupted worker gives its running jobs back with a reason and keeps finished results, and the next
/// worker runs only the remaining jobs.
#[tokio::test]
async fn an_interrupt_gives_running_jobs_back() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    // Two short jobs, and four that would take minutes: the interrupt cannot come too late.
    let mut jobs = several(6, 50.0);
    for (job, short) in jobs.iter_mut().zip(several(2, 0.001)) {
        // Jobs of high cost come first.
        *job = tribosweep::queue::NewJob { cost: 2.0, ..short };
    }
    submit(&mut queue, "study", jobs).await;
    let interrupt = Interrupt::default();
    let raised = interrupt.clone();
    let mut recorder = Recorder::new(move |snapshot| {
        // Both short jobs are done and the others have begun, several on a thread.
        if snapshot.counts.done == 2
            && snapshot.running.iter().filter(|job| job.simulated_s > 0.0).count() == 4
        {
            raised.raise();
        }
    });
    let summary =
        work(&mut queue, &Scope::All, WorkOptions::new(2), &interrupt, &mut recorder).await.unwrap();
    assert!(summary.interrupted);
    assert_eq!(summary.counts, counts(4, 0, 2, 0));
    assert!(recorder.failures.is_empty(), "{:?}", recorder.failures);
    let before = queue.rows("study").await.unwrap();
    let attempts: Vec<_> = before.iter().map(|row| row.attempt).collect();
    assert_eq!(attempts, [1; 6]);
    for row in &before[2..] {
        assert_eq!((row.state, &row.record), (JobState::Pending, &None));
        assert!(row.note.as_ref().unwrap().starts_with("released"), "{row:?}");
    }

    // The remaining jobs get a short run under the same keys.
    let mut raw = sandbox.raw().await;
    for job in &several(6, 0.001)[2..] {
        let update = sqlx::query(
            "UPDATE payloads SET payload = ?2 WHERE job_id = (SELECT id FROM jobs WHERE key = ?1)",
        );
        update.bind(&job.key).bind(&job.payload).execute(&mut raw).await.unwrap();
    }
    let summary =
        work(&mut queue, &Scope::All, WorkOptions::new(2), &Interrupt::default(), &mut SilentProgress)
            .await
            .unwrap();
    assert_eq!((summary.counts, summary.interrupted), (counts(0, 0, 6, 0), false));
    let after = queue.rows("study").await.unwrap();
    assert_eq!(after.iter().map(|row| row.attempt).collect::<Vec<_>>(), [1, 1, 2, 2, 2, 2]);
    for (before, after) in before.iter().zip(&after).take(2) {
        assert_eq!((&before.record, before.wall_s), (&after.record, after.wall_s));
    }
}

/// Protects: a long job that is interrupted several times resumes each time, and its result has the bits of an
/// uninterrupted run. Short jobs, and jobs of a worker without checkpoints, leave no checkpoint.
#[tokio::test]
async fn long_jobs_resume_from_checkpoints() {
    const LIMIT_S: f64 = 0.7;
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    let jobs = several(3, LIMIT_S);
    submit(&mut queue, "study", jobs.clone()).await;
    let mut raw = sandbox.raw().await;
    let often = Some(Duration::from_millis(1));
    let never = Some(Duration::from_hours(1));
    // The checkpoint interval, the part of the run after which it is interrupted, and the checkpoints that are left.
    for (interval, part, kept) in [(None, 0.1, 0), (never, 0.2, 0), (often, 0.3, 3), (often, 0.6, 3)] {
        let interrupt = Interrupt::default();
        let raised = interrupt.clone();
        let mut recorder = Recorder::new(move |snapshot| {
            if snapshot.running.iter().filter(|job| job.simulated_s > part * LIMIT_S).count() == 3 {
                raised.raise();
            }
        });
        let options = WorkOptions { checkpoint_interval: interval, ..WorkOptions::new(1) };
        let summary = work(&mut queue, &Scope::All, options, &interrupt, &mut recorder).await.unwrap();
        assert_eq!(summary.counts, counts(3, 0, 0, 0));
        let count: (i64,) =
            sqlx::query_as("SELECT COUNT(*) FROM checkpoints").fetch_one(&mut raw).await.unwrap();
        assert_eq!(count.0, kept);
        // A job whose progress has not been shown yet has no simulated time.
        let places = recorder.snapshots.iter().flat_map(|snapshot| &snapshot.running);
        let begun = places.map(|job| job.simulated_s).filter(|&s| s > 0.0).fold(LIMIT_S, f64::min);
        if part == 0.6 {
            assert!(begun > 0.3 * LIMIT_S, "resumed from {begun} s");
        }
    }
    let options = WorkOptions { checkpoint_interval: often, ..WorkOptions::new(1) };
    let summary =
        work(&mut queue, &Scope::All, options, &Interrupt::default(), &mut SilentProgress).await.unwrap();
    assert_eq!(summary.counts, counts(0, 0, 3, 0));
    let left: (i64,) = sqlx::query_as("SELECT COUNT(*) FROM checkpoints").fetch_one(&mut raw).await.unwrap();
    assert_eq!(left.0, 0);
    for job in &jobs {
        let row = row(&mut queue, "study", &job.key).await;
        assert_eq!(row.attempt, 5);
        let alone = solve(&serde_json::from_str(&job.payload).unwrap(), &mut Unobserved).unwrap();
        assert_eq!(row.record.unwrap(), serde_json::to_string(&alone).unwrap());
    }
}

/// Protects: jobs that a dead process left running are taken back, counted and run.
#[tokio::test]
async fn jobs_left_running_are_taken_back() {
    let sandbox = Sandbox::new();
    let mut dead = sandbox.open_as(&dead_worker()).await;
    submit(&mut dead, "study", several(3, 0.001)).await;
    claim(&mut dead, Scope::All, 2).await;
    drop(dead);
    let mut queue = sandbox.open().await;
    let summary =
        work(&mut queue, &Scope::All, WorkOptions::new(2), &Interrupt::default(), &mut SilentProgress)
            .await
            .unwrap();
    assert_eq!(summary.taken_back, TakenBack { pending: 2, failed: 0 });
    assert_eq!(summary.counts, counts(0, 0, 3, 0));
}

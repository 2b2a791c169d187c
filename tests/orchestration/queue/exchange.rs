//! Claiming and finishing.

use std::collections::HashSet;
use std::thread;

use tribosweep::queue::{Claim, Finished, FinishedOutcome, JobState, NewStudy, QueueError, Scope};

use super::ENGINE;
use crate::support::{Sandbox, block_on, claim, counts, done, failed, finish, job, keys, of, study};

/// Protects: dear jobs come first, jobs of equal cost in the order of submission, and the payload, the
/// attempt and the cost come with them.
#[tokio::test]
async fn the_dearest_job_comes_first() {
    let Some(sandbox) = Sandbox::of(ENGINE) else { return };
    let mut queue = sandbox.open().await;
    let jobs = [("e", 1.0), ("d", 1.0), ("c", 30.0), ("b", 4.0), ("a", 4.0)];
    let study = NewStudy {
        name: "a".into(),
        document: String::new(),
        jobs: jobs.iter().map(|(key, cost)| job(key, *cost)).collect(),
    };
    queue.submit(&study).await.unwrap();

    let claimed = claim(&mut queue, Scope::All, 2).await;
    assert_eq!(keys(&claimed), ["c", "b"]);
    assert_eq!((claimed[0].payload.as_str(), claimed[0].attempt, claimed[0].cost), ("payload of c", 1, 30.0));
    assert_eq!(keys(&claim(&mut queue, of("a"), 9).await), ["a", "e", "d"]);
    assert!(claim(&mut queue, Scope::All, 9).await.is_empty());
}

/// Protects: work on one study takes nothing from another, however dear.
#[tokio::test]
async fn a_claim_keeps_to_its_study() {
    let Some(sandbox) = Sandbox::of(ENGINE) else { return };
    let mut queue = sandbox.open().await;
    let mut dear = study("dear", &["x", "shared"]);
    dear.jobs[0].cost = 99.0;
    queue.submit(&dear).await.unwrap();
    queue.submit(&study("cheap", &["y", "shared"])).await.unwrap();
    assert_eq!(keys(&claim(&mut queue, of("cheap"), 9).await), ["shared", "y"]);
    assert_eq!(queue.counts(&of("dear")).await.unwrap(), counts(1, 1, 0, 0));
}

/// Protects: with several workers on one database at once, every job is claimed exactly once and every
/// finish is accepted; no transaction meets "database is locked".
#[test]
fn every_job_is_claimed_exactly_once() {
    const JOBS: usize = 300;
    let Some(sandbox) = Sandbox::of(ENGINE) else { return };
    let names: Vec<String> = (0..JOBS).map(|index| format!("job {index}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    block_on(async { sandbox.open().await.submit(&study("a", &names)).await.unwrap() });

    // A claim in a study reads before it writes, which is what needs a transaction that locks at its start;
    // so claiming and finishing are exchanges of their own here.
    let work = async || {
        let mut queue = sandbox.open().await;
        let mut mine = Vec::new();
        loop {
            let claimed = claim(&mut queue, of("a"), 3).await;
            if claimed.is_empty() {
                return mine;
            }
            let end = |key| Finished { key, attempt: 1, outcome: done("r"), wall_s: 0.1 };
            mine.extend(claimed.iter().map(|job| job.key.clone()));
            let finished: Vec<_> = claimed.into_iter().map(|job| end(job.key)).collect();
            let exchanged = queue.exchange(&finished, &[]).await.unwrap();
            assert!(exchanged.refused.is_empty(), "{:?}", exchanged.refused);
        }
    };
    let claimed: Vec<String> = thread::scope(|scope| {
        let workers: Vec<_> = (0..4).map(|_| scope.spawn(|| block_on(work()))).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    });
    assert_eq!(claimed.len(), JOBS);
    assert_eq!(claimed.iter().collect::<HashSet<_>>().len(), JOBS);
    let all = block_on(async { sandbox.open().await.counts(&Scope::All).await.unwrap() });
    assert_eq!(all, counts(0, 0, JOBS as u64, 0));
}

/// Protects: a late finish of an attempt that was given up changes nothing, before and after the later
/// attempt ends, and its caller is told.
#[tokio::test]
async fn a_late_finish_is_refused() {
    let Some(sandbox) = Sandbox::of(ENGINE) else { return };
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x"])).await.unwrap();
    claim(&mut queue, Scope::All, 1).await;
    assert!(finish(&mut queue, "x", 1, FinishedOutcome::Released).await);
    assert!(!finish(&mut queue, "x", 1, done("late")).await, "the job is pending");
    assert_eq!(claim(&mut queue, Scope::All, 1).await[0].attempt, 2);

    for outcome in [done("late"), failed("late"), FinishedOutcome::Released] {
        assert!(!finish(&mut queue, "x", 1, outcome).await, "attempt 2 is running");
    }
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(0, 1, 0, 0));
    assert!(finish(&mut queue, "x", 2, done("right")).await);
    for attempt in [1, 2] {
        for outcome in [done("late"), failed("late"), FinishedOutcome::Released] {
            assert!(!finish(&mut queue, "x", attempt, outcome).await, "the job is done");
        }
    }
    let row = queue.rows("a").await.unwrap().remove(0);
    assert_eq!((row.state, row.record.as_deref(), row.attempt), (JobState::Done, Some("right"), 2));
    assert_eq!(sandbox.number("SELECT COUNT(*) FROM results").await, 1);
}

/// Protects: in a batch, a refused finish is named and stops none of the others.
#[tokio::test]
async fn a_refused_finish_stops_no_other() {
    let Some(sandbox) = Sandbox::of(ENGINE) else { return };
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    claim(&mut queue, Scope::All, 2).await;
    let end = |key: &str, attempt| Finished { key: key.into(), attempt, outcome: done("r"), wall_s: 0.1 };
    let batch = [end("x", 7), end("nobody's", 1), end("y", 1)];
    let exchanged = queue.exchange(&batch, &[]).await.unwrap();
    assert_eq!(exchanged.refused, ["x", "nobody's"]);
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(0, 1, 1, 0));
}

/// Protects: a failed job keeps its error, is not claimed again, and the rest of the sweep goes on.
#[tokio::test]
async fn a_failure_is_kept_and_the_sweep_goes_on() {
    let Some(sandbox) = Sandbox::of(ENGINE) else { return };
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    claim(&mut queue, Scope::All, 1).await;
    let error = Finished { key: "x".into(), attempt: 1, outcome: failed("diverged at 3 ms"), wall_s: 0.5 };
    let exchanged =
        queue.exchange(&[error], &[Claim { scope: of("a"), limit: 9, batch: None }]).await.unwrap();
    assert_eq!(keys(&exchanged.claimed[0]), ["y"]);
    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(0, 1, 0, 1));
    let row = queue.rows("a").await.unwrap().remove(0);
    assert_eq!(row.state, JobState::Failed);
    assert_eq!((row.error.as_deref(), row.record, row.wall_s), (Some("diverged at 3 ms"), None, Some(0.5)));
}

/// Protects: an exchange is all or nothing: a claim that cannot be served leaves the finish to be repeated.
#[tokio::test]
async fn an_exchange_is_all_or_nothing() {
    let Some(sandbox) = Sandbox::of(ENGINE) else { return };
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x"])).await.unwrap();
    claim(&mut queue, Scope::All, 1).await;
    let end = Finished { key: "x".into(), attempt: 1, outcome: done("r"), wall_s: 0.1 };
    let error = queue.exchange(&[end], &[Claim { scope: of("b"), limit: 1, batch: None }]).await.unwrap_err();
    assert!(matches!(error, QueueError::UnknownStudy { .. }), "{error:?}");
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(0, 1, 0, 0));
    assert!(finish(&mut queue, "x", 1, done("r")).await);
}

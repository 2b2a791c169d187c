//! Claiming and finishing.

use std::collections::HashSet;
use std::thread;

use tribosweep::queue::{Claim, Finished, FinishedOutcome, JobState, NewStudy, QueueError, Scope};

use crate::orchestration::support::{
    Sandbox, block_on, claim, counts, done, failed, finish, job, keys, of, study,
};

on_both_databases! {
    the_most_expensive_job_comes_first,
    a_claim_keeps_to_its_study,
    every_job_is_claimed_exactly_once,
    a_late_outcome_is_refused,
    a_refused_outcome_stops_no_other,
    a_failure_is_kept_and_the_sweep_continues,
    an_exchange_is_all_or_nothing,
}

/// Protects: expensive jobs come first, and jobs of equal cost in the order of submission. A claimed job comes with its
/// payload, attempt and cost.
async fn the_most_expensive_job_comes_first(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let jobs = [("e", 1.0), ("d", 1.0), ("c", 30.0), ("b", 4.0), ("a", 4.0)];
    let study = NewStudy {
        name: "a".into(),
        document: String::new(),
        jobs: jobs.iter().map(|(key, cost)| job(key, *cost)).collect(),
        grows: false,
    };
    queue.submit(&study).await.unwrap();

    let claimed = claim(&mut queue, Scope::All, 2).await;
    assert_eq!(keys(&claimed), ["c", "b"]);
    assert_eq!((claimed[0].payload.as_str(), claimed[0].attempt, claimed[0].cost), ("payload of c", 1, 30.0));
    assert_eq!(keys(&claim(&mut queue, of("a"), 9).await), ["a", "e", "d"]);
    assert!(claim(&mut queue, Scope::All, 9).await.is_empty());
}

/// Protects: a claim of one study takes no job of another one, however expensive it is.
async fn a_claim_keeps_to_its_study(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let mut expensive = study("expensive", &["x", "shared"]);
    expensive.jobs[0].cost = 99.0;
    queue.submit(&expensive).await.unwrap();
    queue.submit(&study("cheap", &["y", "shared"])).await.unwrap();
    assert_eq!(keys(&claim(&mut queue, of("cheap"), 9).await), ["shared", "y"]);
    assert_eq!(queue.counts(&of("expensive")).await.unwrap(), counts(1, 1, 0, 0));
}

/// Protects: with several concurrent workers on one database, every job is claimed exactly once and every outcome is
/// accepted. No transaction fails with "database is locked".
async fn every_job_is_claimed_exactly_once(sandbox: &Sandbox) {
    const JOBS: usize = 300;
    let names: Vec<String> = (0..JOBS).map(|index| format!("job {index}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    sandbox.open().await.submit(&study("a", &names)).await.unwrap();

    // A claim of a study reads before it writes, so its transaction must lock at the start. To test this, claims and
    // outcomes are separate exchanges here.
    let work = async || {
        let mut queue = sandbox.open().await;
        let mut mine = Vec::new();
        loop {
            let claimed = claim(&mut queue, of("a"), 3).await;
            if claimed.is_empty() {
                return mine;
            }
            let outcome_of = |key| Finished { key, attempt: 1, outcome: done("r"), wall_s: 0.1 };
            mine.extend(claimed.iter().map(|job| job.key.clone()));
            let finished: Vec<_> = claimed.into_iter().map(|job| outcome_of(job.key)).collect();
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
    let all = sandbox.open().await.counts(&Scope::All).await.unwrap();
    assert_eq!(all, counts(0, 0, JOBS as u64, 0));
}

/// Protects: a late outcome of an attempt that was given back is refused and changes nothing, before and after the next
/// attempt ends.
async fn a_late_outcome_is_refused(sandbox: &Sandbox) {
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

/// Protects: if one of several outcomes is refused, its key is returned and the others are stored.
async fn a_refused_outcome_stops_no_other(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    claim(&mut queue, Scope::All, 2).await;
    let finished =
        |key: &str, attempt| Finished { key: key.into(), attempt, outcome: done("r"), wall_s: 0.1 };
    let batch = [finished("x", 7), finished("nobody's", 1), finished("y", 1)];
    let exchanged = queue.exchange(&batch, &[]).await.unwrap();
    assert_eq!(exchanged.refused, ["x", "nobody's"]);
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(0, 1, 1, 0));
}

/// Protects: a failed job keeps its error and is not claimed again, and the other jobs of the sweep continue.
async fn a_failure_is_kept_and_the_sweep_continues(sandbox: &Sandbox) {
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

/// Protects: an exchange is atomic: if a claim fails, no outcome is stored, and the caller can pass it again.
async fn an_exchange_is_all_or_nothing(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x"])).await.unwrap();
    claim(&mut queue, Scope::All, 1).await;
    let finished = Finished { key: "x".into(), attempt: 1, outcome: done("r"), wall_s: 0.1 };
    let error =
        queue.exchange(&[finished], &[Claim { scope: of("b"), limit: 1, batch: None }]).await.unwrap_err();
    assert!(matches!(error, QueueError::UnknownStudy { .. }), "{error:?}");
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(0, 1, 0, 0));
    assert!(finish(&mut queue, "x", 1, done("r")).await);
}

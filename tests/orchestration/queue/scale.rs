//! The size the queue is for.

use std::time::{Duration, Instant};

use tribosweep::queue::{Claim, Finished, FinishedOutcome, NewJob, NewStudy, Scope};

use crate::support::{Sandbox, claim, counts, job, keys, of};

/// Protects: a study of 100 000 jobs is planned completely and in order, across the parts it is inserted in,
/// and again without adding anything.
#[tokio::test]
async fn a_hundred_thousand_jobs_are_planned() {
    const JOBS: u64 = 100_000;
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    let study = NewStudy {
        name: "large".into(),
        document: String::new(),
        jobs: (0..JOBS).map(|index| job(&format!("job {index}"), (index / 2) as f64)).collect(),
    };
    assert_eq!(queue.submit(&study).await.unwrap().added, JOBS);
    assert_eq!(queue.submit(&study).await.unwrap().already_known, JOBS);
    assert_eq!(queue.counts(&of("large")).await.unwrap(), counts(JOBS, 0, 0, 0));
    assert_eq!(keys(&claim(&mut queue, of("large"), 3).await), ["job 99998", "job 99999", "job 99996"]);
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(JOBS - 3, 3, 0, 0));

    let rows = queue.rows("large").await.unwrap();
    assert_eq!(rows.len() as u64, JOBS);
    for (index, row) in (0..).zip(&rows) {
        assert_eq!((row.ordinal, &row.key), (index, &format!("job {index}")));
    }
}

/// The fastest of several claims of four jobs, which go back unstarted.
async fn claim_time(jobs: usize, scope: &Scope, batch: Option<&str>) -> Duration {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    let of_study = |name: &str, cost: f64| NewStudy {
        name: name.into(),
        document: String::new(),
        jobs: (0..jobs)
            .map(|index| NewJob {
                batch: format!("batch {}", index % 7),
                ..job(&format!("{name} {index}"), cost)
            })
            .collect(),
    };
    queue.submit(&of_study("before", 9.0)).await.unwrap();
    queue.submit(&of_study("mine", 1.0)).await.unwrap();
    let claim = Claim { scope: scope.clone(), limit: 4, batch: batch.map(str::to_owned) };
    let mut best = Duration::MAX;
    for _ in 0..40 {
        let begun = Instant::now();
        let claimed = queue.exchange(&[], std::slice::from_ref(&claim)).await.unwrap().claimed.remove(0);
        best = best.min(begun.elapsed());
        assert_eq!(claimed.len(), 4);
        let back = claimed.into_iter().map(|job| Finished {
            key: job.key,
            attempt: job.attempt,
            outcome: FinishedOutcome::Unstarted,
            wall_s: 0.0,
        });
        queue.exchange(&back.collect::<Vec<_>>(), &[]).await.unwrap();
    }
    best
}

/// Protects: a claim takes no longer for a hundred times as many pending jobs: over all, in a study behind another
/// one's jobs, and in a named batch.
#[tokio::test]
async fn claims_take_no_longer_in_a_long_queue() {
    for (scope, batch) in [(Scope::All, None), (of("mine"), None), (of("mine"), Some("batch 3"))] {
        let (short, long) = (claim_time(500, &scope, batch).await, claim_time(50_000, &scope, batch).await);
        assert!(long < 5 * short, "{scope:?} {batch:?}: {short:?} for 1000 jobs, {long:?} for 100 000");
    }
}

//! Large studies.

use std::time::{Duration, Instant};

use tribosweep::queue::{Claim, ClaimedJob, Finished, FinishedOutcome, NewJob, NewStudy, Scope};

use crate::orchestration::support::{Engine, Sandbox, claim, counts, job, keys, of};

on_both_databases! {
    a_hundred_thousand_jobs_are_planned,
    #[ignore = "a measurement of many seconds"] throughput,
}

/// Protects: a study of 100 000 jobs is stored completely and in order, although it is inserted in several parts. A
/// repeated submission adds nothing.
async fn a_hundred_thousand_jobs_are_planned(sandbox: &Sandbox) {
    const JOBS: u64 = 100_000;
    let mut queue = sandbox.open().await;
    let study = NewStudy {
        name: "large".into(),
        document: String::new(),
        jobs: (0..JOBS).map(|index| job(&format!("job {index}"), (index / 2) as f64)).collect(),
        grows: false,
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

/// Stores three studies of as many jobs: the first is over, the jobs of `mine` come after those of `before`.
async fn fill(sandbox: &Sandbox, jobs: usize) {
    let of_study = |name: &str, cost: f64| NewStudy {
        name: name.into(),
        document: String::new(),
        jobs: (0..jobs)
            .map(|index| NewJob {
                batch: format!("batch {}", index % 7),
                // Scattered costs, so that the order of claims is not the order of storage.
                ..job(&format!("{name} {index}"), cost + (index * 7919 % 97) as f64 / 100.0)
            })
            .collect(),
        grows: false,
    };
    let mut queue = sandbox.open().await;
    // The database collects its statistics at a time when no job is pending.
    queue.submit(&of_study("over", 5.0)).await.unwrap();
    queue.cancel("over").await.unwrap();
    sandbox.run("ANALYZE").await;
    queue.submit(&of_study("before", 9.0)).await.unwrap();
    queue.submit(&of_study("mine", 1.0)).await.unwrap();
    queue.close().await.unwrap();
}

/// How many rows and index entries the server reads for ten claims of four jobs, which are given back unstarted.
async fn rows_read(sandbox: &Sandbox, scope: &Scope, batch: Option<&str>) -> i64 {
    let before = rows_read_so_far(sandbox).await;
    let mut queue = sandbox.open().await;
    let claim = Claim { scope: scope.clone(), limit: 4, batch: batch.map(str::to_owned) };
    for _ in 0..10 {
        let claimed = queue.exchange(&[], std::slice::from_ref(&claim)).await.unwrap().claimed.remove(0);
        assert_eq!(claimed.len(), 4);
        let back = claimed.into_iter().map(|job| Finished {
            key: job.key,
            attempt: job.attempt,
            outcome: FinishedOutcome::Unstarted,
            wall_s: 0.0,
        });
        queue.exchange(&back.collect::<Vec<_>>(), &[]).await.unwrap();
    }
    queue.close().await.unwrap();
    rows_read_so_far(sandbox).await - before
}

/// The rows and index entries that the server has read in the queue's tables.
async fn rows_read_so_far(sandbox: &Sandbox) -> i64 {
    // A session adds its numbers to those of the server before it disappears from the list of sessions.
    let others = "SELECT COUNT(*) FROM pg_stat_activity
                  WHERE datname = current_database() AND pid <> pg_backend_pid() AND backend_type = 'client backend'";
    let end = async {
        while sandbox.number(others).await > 0 {
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
    };
    tokio::time::timeout(Duration::from_mins(2), end).await.expect("closed sessions end");
    let read = "SELECT CAST((SELECT SUM(seq_tup_read) FROM pg_stat_user_tables)
                          + (SELECT SUM(idx_tup_read) FROM pg_stat_user_indexes) AS BIGINT)";
    sandbox.number(read).await
}

/// Protects: with forty times as many pending jobs, a claim reads no more of the database: a claim of all jobs, of a study
/// whose jobs come after those of another study, and of a named batch; even if the database's statistics say that nothing
/// is pending. (A unit test of claims counts the steps of `SQLite`.)
#[tokio::test]
async fn claims_read_no_more_in_a_long_queue() {
    let Some(few) = Sandbox::of(Engine::Postgres) else { return };
    let many = few.another();
    fill(&few, 500).await;
    fill(&many, 20_000).await;
    for (scope, batch) in [(Scope::All, None), (of("mine"), None), (of("mine"), Some("batch 3"))] {
        let short = rows_read(&few, &scope, batch).await;
        let long = rows_read(&many, &scope, batch).await;
        assert!(
            short > 0 && long < 2 * short,
            "{scope:?} {batch:?}: {short} for 1000 jobs, {long} for 40 000"
        );
    }
}

/// Measures claiming and finishing without computing anything (see `scripts/queue_scale.py`).
///
/// Protects: no job is lost at full speed.
async fn throughput(sandbox: &Sandbox) {
    const JOBS: usize = 100_000;
    let record = "r".repeat(1_500);
    // Scattered costs are the worst case: each claimed job is on another page.
    for (limit, costs) in [(4, 97), (16, 97), (64, 97), (16, 1), (64, 1)] {
        let sandbox = sandbox.another();
        let mut queue = sandbox.open().await;
        let jobs = (0..JOBS)
            .map(|index| NewJob {
                payload: "p".repeat(1_000),
                ..job(&format!("job {index}"), (index % costs) as f64)
            })
            .collect();
        let begun = Instant::now();
        queue
            .submit(&NewStudy { name: "large".into(), document: String::new(), jobs, grows: false })
            .await
            .unwrap();
        let planning = begun.elapsed();
        let claim = Claim { scope: of("large"), limit, batch: None };
        let (mut finished, mut parts) = (Vec::new(), Vec::new());
        let (mut done, mut part) = (0, Instant::now());
        loop {
            let exchanged = queue.exchange(&finished, std::slice::from_ref(&claim)).await.unwrap();
            assert!(exchanged.refused.is_empty());
            if exchanged.claimed[0].is_empty() {
                break;
            }
            done += exchanged.claimed[0].len();
            if done / (JOBS / 4) > parts.len() {
                parts.push(part.elapsed());
                part = Instant::now();
            }
            let outcome = || FinishedOutcome::Done {
                record: record.clone(),
                label: "end".to_owned(),
                final_state: None,
            };
            let finish = |job: ClaimedJob| Finished {
                key: job.key,
                attempt: job.attempt,
                outcome: outcome(),
                wall_s: 0.1,
            };
            finished = exchanged.claimed.into_iter().flatten().map(finish).collect();
        }
        assert_eq!(queue.counts(&of("large")).await.unwrap(), counts(0, 0, JOBS as u64, 0));
        let total: Duration = parts.iter().sum();
        let rate = JOBS as f64 / total.as_secs_f64();
        println!(
            "planned in {planning:.2?}; {limit} per exchange, {costs} costs: {rate:.0} jobs per second, quarters {parts:.2?}"
        );
        let begun = Instant::now();
        queue.counts(&of("large")).await.unwrap();
        println!("counting a study: {:.0?}", begun.elapsed());
    }
    let peak = std::fs::read_to_string("/proc/self/status").unwrap();
    println!("{}", peak.lines().find(|line| line.starts_with("VmHWM")).unwrap_or_default());
}

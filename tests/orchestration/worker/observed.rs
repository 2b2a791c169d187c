//! What a worker shows and what it stores.

use std::time::Duration;

use tribosweep::analysis::{self, JobRecord, Unobserved};
use tribosweep::queue::Scope;
use tribosweep::spec::JobSpec;
use tribosweep::worker::{Interrupt, SilentProgress, WorkOptions, work};

use super::{Recorder, several, submit};
use crate::orchestration::support::{Sandbox, counts, of};

/// Protects: progress only grows, the total stays the same, no more jobs run than the threads have lanes, and the end is
/// shown once, with no job left.
#[tokio::test]
async fn progress_only_grows() {
    for threads in [1, 3] {
        let sandbox = Sandbox::new();
        let mut queue = sandbox.open().await;
        submit(&mut queue, "study", several(7, 0.002)).await;
        let mut recorder = Recorder::new(|_| ());
        work(&mut queue, &Scope::All, WorkOptions::new(threads), &Interrupt::default(), &mut recorder)
            .await
            .unwrap();
        let seen: Vec<_> = recorder.counts().collect();
        assert!(seen.windows(2).all(|pair| pair[0].done <= pair[1].done), "{seen:?}");
        assert!(seen.iter().all(|counts| counts.total() == 7), "{seen:?}");
        assert_eq!(recorder.stopped.len(), 1);
        assert_eq!(recorder.stopped[0].counts, counts(0, 0, 7, 0));
        assert_eq!(seen[0].done, 0, "shown before the first job is done");
        for snapshot in &recorder.snapshots {
            assert!(snapshot.running.len() <= 8 * threads);
            assert_eq!(snapshot.running.len() as u64, snapshot.counts.running);
            assert!(snapshot.running.iter().all(|job| (0.0..=0.0021).contains(&job.simulated_s)));
            assert!(snapshot.running.iter().all(|job| job.limit_s.is_none_or(|limit_s| limit_s == 0.002)));
        }
        // The remaining time is estimated from the beginning.
        assert!(recorder.snapshots[0].eta.unwrap().high > Duration::ZERO, "{:?}", recorder.snapshots[0]);
        assert_eq!(recorder.stopped[0].eta.unwrap().high, Duration::ZERO);
    }
}

/// Protects: the simulated time of a running job grows in the display, so that a long job does not look dead.
#[tokio::test]
async fn the_simulated_time_of_a_running_job_grows() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    submit(&mut queue, "study", several(1, 50.0)).await;
    let interrupt = Interrupt::default();
    let raised = interrupt.clone();
    let mut times = Vec::new();
    let mut recorder = Recorder::new(|snapshot| {
        times.extend(snapshot.running.iter().map(|job| job.simulated_s));
        if times.last().is_some_and(|&last| last > times[0]) {
            raised.raise();
        }
    });
    work(&mut queue, &Scope::All, WorkOptions::new(1), &interrupt, &mut recorder).await.unwrap();
    assert!(times.windows(2).all(|pair| pair[0] <= pair[1]), "{times:?}");
    assert!(times.last() > times.first(), "{times:?}");
}

/// Protects: the stored record is that of the job run alone, to the last bit, on any number of threads.
#[tokio::test]
async fn records_are_those_of_the_solver() {
    let jobs = several(4, 0.003);
    let expected: Vec<JobRecord> = jobs
        .iter()
        .map(|job| {
            let spec: JobSpec = serde_json::from_str(&job.payload).unwrap();
            analysis::solve(&spec, &mut Unobserved).unwrap()
        })
        .collect();
    let mut stored: Vec<Vec<String>> = Vec::new();
    for threads in [1, 2, 4] {
        let sandbox = Sandbox::new();
        let mut queue = sandbox.open().await;
        submit(&mut queue, "study", jobs.clone()).await;
        work(&mut queue, &Scope::All, WorkOptions::new(threads), &Interrupt::default(), &mut SilentProgress)
            .await
            .unwrap();
        let rows = queue.rows("study").await.unwrap();
        stored.push(rows.into_iter().map(|row| row.record.unwrap()).collect());
        let read = stored.last().unwrap().iter().map(|text| serde_json::from_str::<JobRecord>(text).unwrap());
        assert!(read.eq(expected.iter().cloned()), "{threads} threads");
    }
    assert!(stored.iter().all(|records| *records == stored[0]));
}

/// Protects: a worker for one study does not run the jobs of other studies.
#[tokio::test]
async fn a_worker_keeps_to_its_study() {
    let sandbox = Sandbox::new();
    let mut queue = sandbox.open().await;
    let jobs = several(5, 0.001);
    submit(&mut queue, "mine", jobs[..3].to_vec()).await;
    submit(&mut queue, "other", jobs[2..].to_vec()).await;
    let summary =
        work(&mut queue, &of("mine"), WorkOptions::new(2), &Interrupt::default(), &mut SilentProgress)
            .await
            .unwrap();
    assert_eq!(summary.counts, counts(0, 0, 3, 0));
    // They share one job.
    assert_eq!(queue.counts(&of("other")).await.unwrap(), counts(2, 0, 1, 0));
}

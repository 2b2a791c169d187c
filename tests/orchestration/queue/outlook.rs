//! Active workers, run times of jobs, and the provenance of results.

use tribosweep::queue::{ActiveWorkers, FinishedOutcome, ProvenanceGroup, QueueError, Scope, Worker};

use crate::orchestration::support::{
    Sandbox, claim, dead_worker, done, failed, finish, foreign_worker, job, of, study,
};

on_both_databases! {
    active_workers_are_counted,
    timings_are_those_of_done_jobs,
    starts_show_what_counts_do_not,
    timings_of_many_jobs_are_a_sample,
    results_are_grouped_by_provenance,
}

fn active(workers: u64, threads: u64) -> ActiveWorkers {
    ActiveWorkers { workers, threads }
}

/// Protects: a worker is active while its process exists, however old its last heartbeat is. A worker that is stopping
/// is not counted. If the process is not visible, the heartbeats decide.
async fn active_workers_are_counted(sandbox: &Sandbox) {
    let lease_ms = 120_000;
    sandbox.clock.set(10 * lease_ms);
    let mut own = sandbox.open_as(&Worker { threads: 3, ..Worker::this_process(1, "test", "") }).await;
    assert_eq!(own.active_workers().await.unwrap(), active(1, 3));
    sandbox.open_as(&dead_worker()).await;
    assert_eq!(own.active_workers().await.unwrap(), active(1, 3));
    sandbox.open_as(&Worker { threads: 4, ..foreign_worker() }).await;
    assert_eq!(own.active_workers().await.unwrap(), active(2, 7));
    sandbox.clock.set(11 * lease_ms);
    assert_eq!(own.active_workers().await.unwrap(), active(1, 3), "no heartbeat for a whole lease");
    own.mark_stopping().await.unwrap();
    assert_eq!(own.active_workers().await.unwrap(), active(0, 0));
}

/// Protects: the timings are the costs and run times of the done jobs of a study, and of no others, or of the database.
async fn timings_are_those_of_done_jobs(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let mut own = study("a", &[]);
    own.jobs = vec![job("x", 8.0), job("y", 4.0), job("z", 2.0)];
    queue.submit(&own).await.unwrap();
    queue.submit(&study("b", &["other"])).await.unwrap();
    claim(&mut queue, Scope::All, 4).await;
    assert!(queue.timings(&of("a")).await.unwrap().is_empty());
    finish(&mut queue, "x", 1, done("record")).await;
    finish(&mut queue, "y", 1, failed("error")).await;
    finish(&mut queue, "other", 1, done("record")).await;
    assert_eq!(queue.timings(&of("a")).await.unwrap(), [(8.0, 2.5)]);
    let mut all = queue.timings(&Scope::All).await.unwrap();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(all, [(1.0, 2.5), (8.0, 2.5)]);
    assert!(matches!(queue.timings(&of("c")).await, Err(QueueError::UnknownStudy { .. })));
}

/// Protects: every change of a study's jobs is visible in their counts or in the number of starts.
async fn starts_show_what_counts_do_not(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y", "x"])).await.unwrap();
    assert_eq!(queue.starts("a").await.unwrap(), 0);
    let first = claim(&mut queue, of("a"), 1).await.remove(0);
    let before = queue.counts(&of("a")).await.unwrap();
    // The job is given back, and the other job is claimed.
    finish(&mut queue, &first.key, 1, FinishedOutcome::Released).await;
    claim(&mut queue, of("a"), 1).await;
    assert_eq!(queue.counts(&of("a")).await.unwrap(), before);
    assert_eq!(queue.starts("a").await.unwrap(), 2);
    assert!(matches!(queue.starts("c").await, Err(QueueError::UnknownStudy { .. })));
}

/// Protects: the timings of a large study are an even sample.
async fn timings_of_many_jobs_are_a_sample(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let mut own = study("a", &[]);
    own.jobs = (0..2_500).map(|i| job(&format!("job {i}"), f64::from(i))).collect();
    queue.submit(&own).await.unwrap();
    sandbox.run("UPDATE jobs SET state = 'done', attempt = 1").await;
    sandbox
        .run(
            "INSERT INTO results (job_id, attempt, record, wall_s, finished_ms) \
             SELECT id, 1, '', cost, 0 FROM jobs",
        )
        .await;
    let timings = queue.timings(&of("a")).await.unwrap();
    assert_eq!(timings.len(), 834);
    let mean = timings.iter().map(|(cost, _)| cost).sum::<f64>() / timings.len() as f64;
    assert!((mean - 1_250.0).abs() < 5.0, "{mean}");
    assert_eq!(queue.timings(&Scope::All).await.unwrap().len(), 833, "every third");
}

/// Protects: results are grouped by provenance, with the number of jobs and the times of the attempts that count.
/// Results of other studies are not included.
async fn results_are_grouped_by_provenance(sandbox: &Sandbox) {
    let worker = |provenance| Worker::this_process(1, "test", provenance);
    let mut first = sandbox.open_as(&worker("first")).await;
    first.submit(&study("a", &["x", "y", "z", "x"])).await.unwrap();
    first.submit(&study("b", &["other"])).await.unwrap();
    assert!(first.provenance_groups("a").await.unwrap().is_empty());
    claim(&mut first, of("a"), 2).await;
    claim(&mut first, of("b"), 1).await;
    sandbox.clock.set(1_000);
    finish(&mut first, "x", 1, done("record")).await;
    finish(&mut first, "other", 1, done("record")).await;
    sandbox.clock.set(2_000);
    finish(&mut first, "y", 1, failed("error")).await;
    let mut second = sandbox.open_as(&worker("second")).await;
    claim(&mut second, of("a"), 1).await;
    sandbox.clock.set(3_000);
    finish(&mut second, "z", 1, done("record")).await;

    let group = |provenance: &str, jobs, first_finished_ms, last_finished_ms| ProvenanceGroup {
        provenance: Some(provenance.to_owned()),
        jobs,
        first_finished_ms,
        last_finished_ms,
    };
    let expected = [group("first", 2, 1_000, 2_000), group("second", 1, 3_000, 3_000)];
    assert_eq!(first.provenance_groups("a").await.unwrap(), expected);
    assert!(matches!(first.provenance_groups("c").await, Err(QueueError::UnknownStudy { .. })));
}

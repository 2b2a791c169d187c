//! Which jobs a claim takes: priorities, batches, studies; cancelling, retrying and removing.

use crate::random::Random;
use std::collections::BTreeSet;

use tribosweep::queue::{
    Claim, ClaimedJob, Counts, FinishedOutcome, JobState, NewJob, NewStudy, Queue, Retried, Retry, Scope,
};

use crate::orchestration::support::{
    Sandbox, claim, counts, dead_worker, done, failed, finish, job, keys, of, study,
};

on_both_databases! {
    a_claim_is_of_one_batch,
    a_claim_of_a_study_is_of_one_batch,
    a_higher_priority_goes_first,
    a_higher_priority_ends_a_batch,
    a_batch_is_renamed_by_a_submission,
    cancelling_and_requesting_again,
    a_failed_job_is_retried,
    removing_and_collecting,
    a_studys_pending_jobs_are_kept,
}

fn study_of(name: &str, jobs: Vec<NewJob>) -> NewStudy {
    NewStudy { name: name.into(), document: String::new(), jobs, grows: false }
}

/// Jobs by key, cost, batch and priority.
fn jobs(rows: &[(&str, f64, &str, Option<i64>)]) -> Vec<NewJob> {
    let job = |&(key, cost, batch, priority): &(&str, f64, &str, Option<i64>)| NewJob {
        batch: batch.into(),
        priority,
        ..job(key, cost)
    };
    rows.iter().map(job).collect()
}

async fn exchange(queue: &mut Queue, claims: &[Claim]) -> Vec<Vec<ClaimedJob>> {
    queue.exchange(&[], claims).await.unwrap().claimed
}

fn all(limit: usize, batch: Option<&str>) -> Claim {
    Claim { scope: Scope::All, limit, batch: batch.map(str::to_owned) }
}

/// Protects: a claim takes jobs of one batch: the named one, or else that of the first job in order. Several claims of
/// one exchange are served in order, and each has its own answer.
async fn a_claim_is_of_one_batch(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let rows = [
        ("a1", 1.0, "a", None),
        ("b1", 9.0, "b", None),
        ("a2", 5.0, "a", None),
        ("b2", 2.0, "b", None),
        ("c1", 4.0, "c", None),
        ("b3", 3.0, "b", None),
    ];
    queue.submit(&study_of("s", jobs(&rows))).await.unwrap();
    let claimed = exchange(&mut queue, &[all(2, None), all(0, None), all(8, None), all(8, Some("b"))]).await;
    assert_eq!(
        claimed.iter().map(|jobs| keys(jobs)).collect::<Vec<_>>(),
        [vec!["b1", "b3"], vec![], vec!["a2", "a1"], vec!["b2"]]
    );
    assert!(claimed[2].iter().all(|job| job.batch == "a"));
    assert!(exchange(&mut queue, &[all(8, Some("b"))]).await[0].is_empty(), "other batches are not claimed");
    assert_eq!(keys(&exchange(&mut queue, &[all(8, None)]).await[0]), ["c1"]);
}

/// Protects: the same within a study, some of whose jobs belong to other studies too.
async fn a_claim_of_a_study_is_of_one_batch(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let rows = [("a1", 1.0, "a", None), ("b1", 2.0, "b", None), ("a2", 0.5, "a", None)];
    queue.submit(&study_of("mine", jobs(&rows))).await.unwrap();
    let rows = [("a9", 9.0, "a", None), ("a1", 1.0, "a", None), ("b9", 9.0, "b", None)];
    queue.submit(&study_of("other", jobs(&rows))).await.unwrap();
    assert_eq!(keys(&claim(&mut queue, of("mine"), 9).await), ["b1"]);
    assert_eq!(keys(&claim(&mut queue, of("mine"), 9).await), ["a1", "a2"]);
    assert!(claim(&mut queue, of("mine"), 9).await.is_empty());
    let named = Claim { scope: of("other"), limit: 9, batch: Some("b".into()) };
    assert_eq!(keys(&exchange(&mut queue, &[named]).await[0]), ["b9"]);
}

/// Protects: priority takes precedence over cost, across studies. A submission with a priority changes that of existing
/// jobs; a submission without one does not.
async fn a_higher_priority_goes_first(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let slow = [("x", 90.0, "", None), ("y", 80.0, "", Some(-1)), ("z", 70.0, "", None)];
    queue.submit(&study_of("slow", jobs(&slow))).await.unwrap();
    queue
        .submit(&study_of("urgent", jobs(&[("u", 1.0, "", Some(5)), ("z", 70.0, "", Some(5))])))
        .await
        .unwrap();
    queue
        .submit(&study_of("slow", jobs(&slow.map(|(key, cost, batch, _)| (key, cost, batch, None)))))
        .await
        .unwrap();
    assert_eq!(keys(&claim(&mut queue, of("slow"), 1).await), ["z"]);
    assert_eq!(keys(&claim(&mut queue, Scope::All, 9).await), ["u", "x", "y"]);
}

/// Protects: a claim of a named batch gets no jobs while a job of another batch with a higher priority is pending. That
/// job therefore need not wait until the batch is done.
async fn a_higher_priority_ends_a_batch(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study_of("slow", jobs(&[("x", 9.0, "a", None), ("y", 8.0, "a", None)]))).await.unwrap();
    let more = [all(1, Some("a"))];
    assert_eq!(keys(&exchange(&mut queue, &more).await[0]), ["x"]);
    queue.submit(&study_of("urgent", jobs(&[("u", 1.0, "b", Some(5))]))).await.unwrap();
    assert!(exchange(&mut queue, &more).await[0].is_empty());
    assert_eq!(keys(&exchange(&mut queue, &[all(1, None)]).await[0]), ["u"]);
    assert_eq!(keys(&exchange(&mut queue, &more).await[0]), ["y"]);
}

/// Protects: a submission replaces the batch names of pending jobs, because another version of the program may name
/// batches differently.
async fn a_batch_is_renamed_by_a_submission(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study_of("s", jobs(&[("x", 2.0, "", None), ("y", 1.0, "", None)]))).await.unwrap();
    let submitted =
        queue.submit(&study_of("s", jobs(&[("x", 2.0, "b", None), ("y", 1.0, "b", None)]))).await.unwrap();
    assert_eq!((submitted.added, submitted.already_known), (0, 2));
    assert_eq!(exchange(&mut queue, &[all(9, Some("b"))]).await[0].len(), 2);
}

/// Protects: cancelling a study cancels exactly the pending jobs that no other study requests. If two studies share a
/// job and both are cancelled, the job is cancelled. Submitting or retrying makes jobs pending again.
async fn cancelling_and_requesting_again(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["run", "done", "own", "shared"])).await.unwrap();
    queue.submit(&study("b", &["shared"])).await.unwrap();
    claim(&mut queue, of("a"), 2).await;
    assert!(finish(&mut queue, "done", 1, done("r")).await);
    let cancelled = queue.cancel("a").await.unwrap();
    assert_eq!((cancelled.cancelled, cancelled.shared, cancelled.running), (1, 1, 1));
    let left = Counts { cancelled: 1, ..counts(1, 1, 1, 0) };
    assert_eq!(queue.counts(&of("a")).await.unwrap(), left);
    assert!(finish(&mut queue, "run", 1, done("r")).await, "running jobs continue");

    assert_eq!(queue.cancel("b").await.unwrap().cancelled, 1, "study a does not request it any more");
    assert!(claim(&mut queue, Scope::All, 9).await.is_empty());
    assert_eq!(queue.retry("b", Retry::Failed).await.unwrap(), Retried::default());
    assert_eq!(queue.retry("b", Retry::All).await.unwrap(), Retried { cancelled: 1, ..Retried::default() });
    assert_eq!(keys(&claim(&mut queue, Scope::All, 9).await), ["shared"]);
    queue.submit(&study("c", &["own"])).await.unwrap();
    assert_eq!(keys(&claim(&mut queue, Scope::All, 9).await), ["own"], "study c is not cancelled");
}

/// Protects: a failed job that is retried is pending. Its row no longer shows the failure, its crash count is reset,
/// and the outcome of the next attempt counts.
async fn a_failed_job_is_retried(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    claim(&mut queue, Scope::All, 2).await;
    assert!(finish(&mut queue, "x", 1, failed("no memory")).await);
    assert!(finish(&mut queue, "y", 1, done("r")).await);
    assert_eq!(queue.retry("a", Retry::Failed).await.unwrap().failed, 1);
    let row = queue.rows("a").await.unwrap().remove(0);
    assert_eq!((row.state, row.error, row.wall_s), (JobState::Pending, None, None));
    assert_eq!(claim(&mut queue, Scope::All, 9).await[0].attempt, 2);
    assert!(finish(&mut queue, "x", 2, done("better")).await);
    assert_eq!(queue.rows("a").await.unwrap()[0].record.as_deref(), Some("better"));
    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(0, 0, 2, 0));
}

/// Protects: removing a study removes nothing that another study has. Results stay until garbage collection, which
/// deletes exactly the jobs that no study refers to.
async fn removing_and_collecting(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["done", "run", "pending", "shared"])).await.unwrap();
    queue.submit(&study("b", &["shared"])).await.unwrap();
    claim(&mut queue, of("a"), 2).await;
    assert!(finish(&mut queue, "done", 1, done("r")).await);
    let mut ended = sandbox.open_as(&dead_worker()).await;
    ended.unregister().await.unwrap();

    let removed = queue.remove("a").await.unwrap();
    assert_eq!((removed.rows, removed.cancelled), (4, 1));
    assert!(queue.study("a").await.unwrap().is_none());
    queue.submit(&study("again", &["done"])).await.unwrap();
    assert_eq!(queue.rows("again").await.unwrap()[0].record.as_deref(), Some("r"));
    queue.remove("again").await.unwrap();

    let garbage = queue.collect_garbage().await.unwrap();
    assert_eq!((garbage.jobs, garbage.results, garbage.workers), (2, 1, 1), "running jobs are kept");
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(1, 1, 0, 0));
    assert!(finish(&mut queue, "run", 1, FinishedOutcome::Released).await);
    queue.cancel("b").await.unwrap();
    assert_eq!(queue.collect_garbage().await.unwrap().jobs, 1);
    assert_eq!(queue.counts(&of("b")).await.unwrap(), Counts { cancelled: 1, ..counts(0, 0, 0, 0) });
}

/// Protects: after any sequence of operations, the table of a study's pending jobs, which claims use, agrees with the
/// jobs. The sequence is random and the same in every run.
async fn a_studys_pending_jobs_are_kept(sandbox: &Sandbox) {
    const KEYS: [&str; 6] = ["p", "q", "r", "s", "t", "u"];
    // PENDING counts the pending jobs of all studies, KEPT the rows of the table that claims use.
    const PENDING: &str = "
        SELECT COUNT(*) FROM (
            SELECT DISTINCT m.study_id, j.id FROM study_jobs AS m JOIN jobs AS j ON j.id = m.job_id
            WHERE j.state = 'pending') AS pending";
    const KEPT: &str = "SELECT COUNT(*) FROM study_pending";
    const IN_BOTH: &str = "
        SELECT COUNT(*) FROM (
            SELECT m.study_id, j.id, j.batch, j.priority, j.cost
            FROM study_jobs AS m JOIN jobs AS j ON j.id = m.job_id WHERE j.state = 'pending'
            INTERSECT
            SELECT study_id, job_id, batch, priority, cost FROM study_pending) AS both_have";
    let mut queue = sandbox.open().await;
    let mut random = Random::new(7);
    let mut draw = |end: usize| random.below(end);
    let mut running: Vec<(String, u32)> = Vec::new();
    let mut seen = BTreeSet::new();
    for _ in 0..400 {
        let name = ["a", "b"][draw(2)];
        match draw(7) {
            0 | 1 => {
                let picked = (0..5).map(|_| KEYS[draw(KEYS.len())]).collect::<Vec<_>>();
                let mut study = study(name, &picked);
                for job in &mut study.jobs {
                    (job.priority, job.batch) =
                        ([None, Some(1), Some(-1)][draw(3)], ["", "b"][draw(2)].to_owned());
                }
                queue.submit(&study).await.unwrap();
            }
            2 | 3 => {
                let claimed = claim(&mut queue, Scope::All, 2).await;
                running.extend(claimed.into_iter().map(|job| (job.key, job.attempt)));
            }
            4 if !running.is_empty() => {
                let (key, attempt) = running.swap_remove(draw(running.len()));
                let outcome = [done("r"), failed("e"), FinishedOutcome::Released, FinishedOutcome::Unstarted]
                    [draw(4)]
                .clone();
                assert!(finish(&mut queue, &key, attempt, outcome).await);
            }
            5 => drop(queue.cancel(name).await),
            6 => drop(if draw(2) == 0 {
                queue.retry(name, Retry::All).await.map(drop)
            } else {
                queue.remove(name).await.map(drop)
            }),
            _ => drop(queue.collect_garbage().await.unwrap()),
        }
        let pending = sandbox.number(PENDING).await;
        assert_eq!(sandbox.number(KEPT).await, pending);
        assert_eq!(sandbox.number(IN_BOTH).await, pending);
        seen.insert(pending);
    }
    assert!(seen.len() > 5, "the random sequence varies too little: {seen:?}");
}

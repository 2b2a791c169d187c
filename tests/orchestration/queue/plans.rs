//! Studies that grow: a wave is planned once, by a worker that may die, and never lost.

use tribosweep::queue::{
    FinishedOutcome, NewStudy, PlanClaim, PlanState, Planned, Queue, Replace, Retry, Scope, Shard,
};

use crate::orchestration::support::{
    Sandbox, claim, counts, dead_worker, done, failed, finish, foreign_worker, job, keys, of, study,
};

on_both_databases! {
    a_wave_is_due_when_all_jobs_have_ended,
    a_wave_is_planned_by_one_worker,
    the_plan_of_a_dead_worker_is_taken_over,
    a_plan_that_comes_too_late_changes_nothing,
    a_study_that_is_submitted_again_keeps_its_waves,
    a_changed_study_grows_anew,
    a_plan_that_failed_is_tried_again,
    a_retry_plans_further,
    a_wave_has_the_priority_of_its_study,
    plans_are_copied_and_removed,
    a_job_receives_the_state_of_its_parent,
}

fn growing(keys: &[&str]) -> NewStudy {
    NewStudy { grows: true, ..study("a", keys) }
}

fn wave(keys: &[&str]) -> Planned {
    Planned::Wave { jobs: keys.iter().map(|key| job(key, 1.0)).collect(), note: "why".into() }
}

/// Runs all pending jobs of the study.
async fn run_all(queue: &mut Queue) {
    for job in claim(queue, of("a"), 100).await {
        assert!(finish(queue, &job.key, job.attempt, done("record")).await);
    }
}

/// A study with the job x, which is done, and the first wave with y.
async fn grow_once(queue: &mut Queue) {
    queue.submit(&growing(&["x"])).await.unwrap();
    run_all(queue).await;
    let first = plan(queue).await;
    assert!(queue.store_plan(&first, &wave(&["y"])).await.unwrap());
}

async fn plan(queue: &mut Queue) -> PlanClaim {
    queue.claim_plan(&Scope::All).await.unwrap().expect("a wave is due")
}

/// Protects: a wave is due when no job of the study is pending or running, whether jobs are done or have failed, and only for studies
/// that grow and are not cancelled. Its jobs follow those of the study, and the next wave is due when they have ended.
async fn a_wave_is_due_when_all_jobs_have_ended(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&growing(&["x", "y"])).await.unwrap();
    queue.submit(&study("b", &["z"])).await.unwrap();
    assert_eq!(queue.claim_plan(&Scope::All).await.unwrap(), None, "pending");
    let claimed = claim(&mut queue, of("a"), 2).await;
    assert_eq!(queue.claim_plan(&Scope::All).await.unwrap(), None, "running");
    finish(&mut queue, "x", claimed[0].attempt, done("r")).await;
    finish(&mut queue, "y", claimed[1].attempt, failed("e")).await;
    assert!(queue.open_jobs(&of("a")).await.unwrap().has_plans);
    assert!(!queue.open_jobs(&of("b")).await.unwrap().has_plans);
    assert_eq!(queue.claim_plan(&of("b")).await.unwrap(), None, "another study");
    queue.cancel("a").await.unwrap();
    assert_eq!(queue.claim_plan(&Scope::All).await.unwrap(), None, "cancelled");
    queue.retry("a", Retry::All).await.unwrap();
    run_all(&mut queue).await;

    let first = plan(&mut queue).await;
    assert_eq!((first.study.as_str(), first.document.as_str(), first.wave), ("a", "document of a", 1));
    assert!(queue.store_plan(&first, &wave(&["v", "w"])).await.unwrap());
    let found: Vec<(u64, String)> =
        queue.rows("a").await.unwrap().into_iter().map(|row| (row.ordinal, row.key)).collect();
    assert_eq!(found, [(0, "x".into()), (1, "y".into()), (2, "v".into()), (3, "w".into())]);
    assert_eq!(queue.claim_plan(&Scope::All).await.unwrap(), None, "the wave is pending");
    run_all(&mut queue).await;
    let second = plan(&mut queue).await;
    assert_eq!(second.wave, 2);
    assert!(queue.store_plan(&second, &Planned::Complete { note: "enough".into() }).await.unwrap());
    assert_eq!(queue.claim_plan(&Scope::All).await.unwrap(), None, "complete");
    let status = queue.plan_status("a").await.unwrap().unwrap();
    assert_eq!(
        (status.waves, status.state, status.note.as_deref()),
        (1, PlanState::Complete, Some("enough"))
    );
    assert!(!queue.open_jobs(&of("a")).await.unwrap().has_plans);
    assert_eq!(queue.plan_status("b").await.unwrap(), None);
}

/// Protects: while a worker plans, no other one does, unless its lease ends; the worker itself may claim the plan again.
async fn a_wave_is_planned_by_one_worker(sandbox: &Sandbox) {
    let mut queue = sandbox.open_as(&foreign_worker()).await;
    let mut other = sandbox.open().await;
    queue.submit(&growing(&["x"])).await.unwrap();
    run_all(&mut queue).await;
    let first = plan(&mut queue).await;
    assert_eq!(other.claim_plan(&Scope::All).await.unwrap(), None);
    assert_eq!(plan(&mut queue).await, first);
    sandbox.clock.set(3_600_000);
    assert_eq!(plan(&mut other).await, first);
}

/// Protects: the plan of a worker whose process has died is claimed as soon as that is known.
async fn the_plan_of_a_dead_worker_is_taken_over(sandbox: &Sandbox) {
    let mut queue = sandbox.open_as(&dead_worker()).await;
    queue.submit(&growing(&["x"])).await.unwrap();
    run_all(&mut queue).await;
    let first = plan(&mut queue).await;
    let mut other = sandbox.open().await;
    assert_eq!(other.claim_plan(&Scope::All).await.unwrap(), None);
    other.take_back().await.unwrap();
    assert_eq!(plan(&mut other).await, first);
}

/// Protects: of two workers that planned the same wave, the first one counts. A plan of a study that was replaced or removed in the
/// meantime changes nothing.
async fn a_plan_that_comes_too_late_changes_nothing(sandbox: &Sandbox) {
    let mut queue = sandbox.open_as(&foreign_worker()).await;
    let mut other = sandbox.open().await;
    queue.submit(&growing(&["x"])).await.unwrap();
    run_all(&mut queue).await;
    let late = plan(&mut queue).await;
    sandbox.clock.set(3_600_000);
    let early = plan(&mut other).await;
    assert!(other.store_plan(&early, &wave(&["y"])).await.unwrap());
    assert!(!queue.store_plan(&late, &wave(&["y"])).await.unwrap());
    assert_eq!(queue.rows("a").await.unwrap().len(), 2);
    run_all(&mut other).await;
    let replaced = plan(&mut other).await;
    queue.submit(&NewStudy { document: "another".into(), ..growing(&["x"]) }).await.unwrap();
    assert!(!other.store_plan(&replaced, &wave(&["z"])).await.unwrap());
    let cancelled = plan(&mut other).await;
    queue.cancel("a").await.unwrap();
    assert!(!other.store_plan(&cancelled, &wave(&["z"])).await.unwrap());
    queue.retry("a", Retry::All).await.unwrap();
    let removed = plan(&mut other).await;
    queue.remove("a").await.unwrap();
    assert!(!other.store_plan(&removed, &wave(&["z"])).await.unwrap());
    assert_eq!(queue.studies().await.unwrap().len(), 0);
}

/// Protects: a study that is submitted again as it is keeps the jobs that were added, and its plan goes on.
async fn a_study_that_is_submitted_again_keeps_its_waves(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    grow_once(&mut queue).await;
    run_all(&mut queue).await;
    let keys = std::collections::HashSet::from(["x"]);
    let preview = queue.preview_replacement("a", &keys, "document of a").await.unwrap().unwrap();
    assert_eq!((preview.kept, preview.new, preview.dropped), (2, 0, 0));
    // The same study after a change of the solver, which gives its job another key.
    let other_keys = std::collections::HashSet::from(["x of another version"]);
    let preview = queue.preview_replacement("a", &other_keys, "document of a").await.unwrap().unwrap();
    assert_eq!((preview.kept, preview.new, preview.dropped), (0, 1, 2));
    let other = growing(&["x of another version"]);
    assert!(queue.submit_shard(&other, Shard::WHOLE, &Replace::KeepingResults).await.is_err());
    let submitted =
        queue.submit_shard(&growing(&["x"]), Shard::WHOLE, &Replace::KeepingResults).await.unwrap();
    assert_eq!((submitted.added, submitted.already_done), (0, 2));
    assert_eq!(queue.rows("a").await.unwrap().len(), 2);
    assert_eq!(plan(&mut queue).await.wave, 2);
}

/// Protects: a study that is changed loses the jobs that were added only if its user agrees, and grows anew from the beginning.
async fn a_changed_study_grows_anew(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    grow_once(&mut queue).await;
    run_all(&mut queue).await;
    let changed = NewStudy { document: "changed".into(), ..growing(&["x"]) };
    assert!(queue.submit_shard(&changed, Shard::WHOLE, &Replace::KeepingResults).await.is_err());
    assert_eq!(queue.rows("a").await.unwrap().len(), 2, "nothing has changed");
    queue.submit_shard(&changed, Shard::WHOLE, &Replace::Always).await.unwrap();
    assert_eq!(queue.rows("a").await.unwrap().len(), 1);
    let again = plan(&mut queue).await;
    assert_eq!((again.wave, again.document.as_str()), (1, "changed"));
    queue.store_plan(&again, &wave(&["y"])).await.unwrap();
    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(0, 0, 2, 0), "its result is still there");
    queue.submit(&NewStudy { grows: false, ..changed }).await.unwrap();
    assert_eq!(queue.plan_status("a").await.unwrap(), None);
}

/// Protects: a plan that failed is not tried again and again, but when its user asks for it.
async fn a_plan_that_failed_is_tried_again(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&growing(&["x"])).await.unwrap();
    run_all(&mut queue).await;
    for again in 0..2 {
        let claimed = plan(&mut queue).await;
        assert!(queue.store_plan(&claimed, &Planned::Failed { error: "why".into() }).await.unwrap());
        assert_eq!(queue.claim_plan(&Scope::All).await.unwrap(), None);
        assert_eq!(queue.plan_status("a").await.unwrap().unwrap().state, PlanState::Failed);
        if again == 0 {
            queue.retry("a", Retry::Failed).await.unwrap();
        } else {
            queue.submit(&growing(&["x"])).await.unwrap();
        }
    }
    assert_eq!(plan(&mut queue).await.wave, 1);
}

/// Protects: a study whose plan was complete is planned further when its failed jobs are tried again, and a plan that was made before
/// the retry does not count.
async fn a_retry_plans_further(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&growing(&["x"])).await.unwrap();
    claim(&mut queue, of("a"), 1).await;
    finish(&mut queue, "x", 1, failed("e")).await;
    let early = plan(&mut queue).await;
    queue.retry("a", Retry::Failed).await.unwrap();
    let complete = Planned::Complete { note: "nothing is possible".into() };
    assert!(!queue.store_plan(&early, &complete).await.unwrap());
    claim(&mut queue, of("a"), 1).await;
    finish(&mut queue, "x", 2, failed("e")).await;
    let late = plan(&mut queue).await;
    assert!(queue.store_plan(&late, &complete).await.unwrap());
    queue.retry("a", Retry::Failed).await.unwrap();
    run_all(&mut queue).await;
    assert_eq!(plan(&mut queue).await.wave, 1);
}

/// Protects: the jobs of a wave do not wait behind those of other studies that their own study comes before.
async fn a_wave_has_the_priority_of_its_study(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let mut urgent = growing(&["x"]);
    urgent.jobs[0].priority = Some(5);
    queue.submit(&urgent).await.unwrap();
    run_all(&mut queue).await;
    let first = plan(&mut queue).await;
    queue.submit(&study("b", &["other"])).await.unwrap();
    queue.store_plan(&first, &wave(&["y"])).await.unwrap();
    assert_eq!(keys(&claim(&mut queue, Scope::All, 1).await), ["y"]);
}

/// Protects: a copy has the waves and the plan of the original, and a removed study leaves no plan behind.
async fn plans_are_copied_and_removed(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    grow_once(&mut queue).await;
    let elsewhere = sandbox.another();
    let mut copy = elsewhere.open().await;
    copy.absorb(&mut queue, None).await.unwrap();
    assert_eq!(copy.plan_status("a").await.unwrap(), queue.plan_status("a").await.unwrap());
    run_all(&mut copy).await;
    let second = plan(&mut copy).await;
    assert_eq!(second.wave, 2);
    copy.store_plan(&second, &wave(&["z"])).await.unwrap();
    run_all(&mut queue).await;
    queue.absorb(&mut copy, None).await.unwrap();
    assert_eq!(queue.plan_status("a").await.unwrap().unwrap().waves, 2);
    assert_eq!(queue.rows("a").await.unwrap().len(), 3);
    queue.remove("a").await.unwrap();
    assert_eq!(sandbox.number("SELECT COUNT(*) FROM plans").await, 0);
}

/// Protects: a job that continues another one receives the state in which that one ended, also in a copy of the database, and the
/// state goes with the job that it belongs to.
async fn a_job_receives_the_state_of_its_parent(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&growing(&["x"])).await.unwrap();
    let claimed = claim(&mut queue, of("a"), 1).await;
    assert_eq!(claimed[0].parent_state, None);
    let outcome =
        FinishedOutcome::Done { record: "r".into(), label: "end".into(), final_state: Some(vec![1, 0, 255]) };
    assert!(finish(&mut queue, "x", 1, outcome).await);
    let first = plan(&mut queue).await;
    let mut child = job("y", 1.0);
    child.parent = Some("x".into());
    queue.store_plan(&first, &Planned::Wave { jobs: vec![child], note: String::new() }).await.unwrap();
    let elsewhere = sandbox.another();
    let mut copy = elsewhere.open().await;
    copy.absorb(&mut queue, None).await.unwrap();
    for queue in [&mut queue, &mut copy] {
        assert_eq!(claim(queue, of("a"), 1).await[0].parent_state, Some(vec![1, 0, 255]));
        finish(queue, "y", 1, done("r")).await;
    }
    queue.remove("a").await.unwrap();
    assert_eq!(queue.collect_garbage().await.unwrap().jobs, 2);
    assert_eq!(sandbox.number("SELECT COUNT(*) FROM final_states").await, 0);
}

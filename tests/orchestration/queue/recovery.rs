//! Interruptions and crashes of workers.

use tribosweep::queue::{FinishedOutcome, JobState, Queue, Retry, Scope, Settings, TakenBack, Worker};

use crate::orchestration::support::{
    Engine, Sandbox, claim, counts, dead_worker, done, failed, finish, foreign_worker, keys, study,
};

on_both_databases! {
    a_released_job_is_claimed_again,
    an_unstarted_job_costs_no_attempt,
    jobs_of_a_dead_process_are_taken_back,
    a_process_number_alone_identifies_no_process,
    a_worker_has_its_own_lease,
    a_clock_that_jumps_takes_nothing,
    leases_decide_for_other_machines,
    a_worker_without_heartbeats_is_missing,
    a_deleted_worker_registers_again,
    retries_have_a_limit,
    three_crashes_fail_a_job,
    checkpoints_reach_the_next_attempt,
    a_stopped_process_has_not_crashed,
    a_checkpoint_outlasts_crashes,
    an_orderly_end_gives_everything_back,
}

const NOTHING: TakenBack = TakenBack { pending: 0, failed: 0 };

/// A day, in milliseconds.
const DAY_MS: i64 = 86_400_000;

/// A database with the jobs x, y, z, w. `worker` has claimed the first three and finished x.
async fn left_by(sandbox: &Sandbox, worker: &Worker) -> Queue {
    let mut queue = sandbox.open_as(worker).await;
    queue.submit(&study("a", &["x", "y", "z", "w"])).await.unwrap();
    claim(&mut queue, Scope::All, 3).await;
    assert!(finish(&mut queue, "x", 1, done("record of x")).await);
    queue
}

/// Protects: a job that an interrupted worker gives back is pending again, with a note of the reason, and its next
/// start is a new attempt.
async fn a_released_job_is_claimed_again(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x"])).await.unwrap();
    claim(&mut queue, Scope::All, 1).await;
    assert!(finish(&mut queue, "x", 1, FinishedOutcome::Released).await);
    let row = queue.rows("a").await.unwrap().remove(0);
    assert_eq!((row.state, row.attempt), (JobState::Pending, 1));
    assert!(row.note.unwrap().starts_with("released"));
    assert_eq!(claim(&mut queue, Scope::All, 1).await[0].attempt, 2);
}

/// Protects: a job that was claimed and not started is as if it had not been claimed: the attempt does not count and
/// there is no note. The worker that gave it back can neither give it back nor finish it again.
async fn an_unstarted_job_costs_no_attempt(sandbox: &Sandbox) {
    let (mut queue, mut other) = (sandbox.open().await, sandbox.open().await);
    queue.submit(&study("a", &["x"])).await.unwrap();
    claim(&mut queue, Scope::All, 1).await;
    assert!(finish(&mut queue, "x", 1, FinishedOutcome::Unstarted).await);
    let row = queue.rows("a").await.unwrap().remove(0);
    assert_eq!((row.state, row.attempt, row.note), (JobState::Pending, 0, None));
    assert_eq!(claim(&mut other, Scope::All, 1).await[0].attempt, 1);
    for outcome in [FinishedOutcome::Unstarted, done("late"), FinishedOutcome::Released] {
        assert!(!finish(&mut queue, "x", 1, outcome).await, "the attempt belongs to another worker");
    }
    assert!(finish(&mut other, "x", 1, done("right")).await);
}

/// Protects: the next worker immediately takes back the jobs that a dead process left running, with a note of the
/// reason. Done and pending jobs stay as they are, and a late outcome of the dead process is refused.
async fn jobs_of_a_dead_process_are_taken_back(sandbox: &Sandbox) {
    let mut dead = left_by(sandbox, &dead_worker()).await;
    let mut queue = sandbox.open().await;
    assert_eq!(queue.take_back().await.unwrap(), TakenBack { pending: 2, failed: 0 });
    assert_eq!(queue.take_back().await.unwrap(), NOTHING);
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(3, 0, 1, 0));
    let rows = queue.rows("a").await.unwrap();
    assert_eq!(rows.iter().map(|row| row.crashes).collect::<Vec<_>>(), [0, 1, 1, 0]);
    assert!(rows[0].note.is_none() && rows[3].note.is_none(), "{rows:?}");
    assert!(rows[1].note.as_ref().unwrap().starts_with("taken back"), "{rows:?}");
    assert_eq!(rows[1].note, rows[2].note);

    let claimed = claim(&mut queue, Scope::All, 9).await;
    assert_eq!(keys(&claimed), ["y", "z", "w"]);
    assert_eq!(claimed.iter().map(|job| job.attempt).collect::<Vec<_>>(), [2, 2, 1]);
    for attempt in [1, 2] {
        assert!(!finish(&mut dead, "y", attempt, done("late")).await);
    }
    assert!(finish(&mut queue, "y", 2, done("right")).await);
}

/// Protects: a worker is not alive if its process number now belongs to another process, or if its machine has been
/// rebooted.
async fn a_process_number_alone_identifies_no_process(sandbox: &Sandbox) {
    let own = Worker::this_process(1, "test", "");
    let reused = Worker { process_start: own.process_start.map(|start| start - 1), ..own.clone() };
    let rebooted = Worker { boot_id: Some("an earlier boot".into()), ..own };
    for (gone, is_certain) in [(reused, true), (rebooted, sandbox.engine == Engine::Sqlite)] {
        let sandbox = sandbox.another();
        left_by(&sandbox, &gone).await;
        let mut queue = sandbox.open().await;
        let at_once = queue.take_back().await.unwrap().pending;
        // On a server, two machines may have the same name, so another boot may be another machine.
        assert_eq!(at_once, if is_certain { 2 } else { 0 }, "{gone:?}");
        sandbox.clock.set(i64::try_from(Settings::default().lease.as_millis()).unwrap());
        assert_eq!(queue.take_back().await.unwrap().pending, 2 - at_once, "{gone:?}");
    }
}

/// Protects: a worker on another machine may be silent for as long as its own lease, not that of the worker that checks
/// it. Until then, no jobs are taken back from it and it counts as active.
async fn a_worker_has_its_own_lease(sandbox: &Sandbox) {
    let patient = Settings::default().with_lease(std::time::Duration::from_hours(1));
    let mut far = Queue::open_with(sandbox.location(), sandbox.clock.clock(), patient).await.unwrap();
    far.register(&foreign_worker()).await.unwrap();
    far.submit(&study("a", &["x"])).await.unwrap();
    let mut queue = sandbox.open().await;
    for now_ms in [600_000, 3_500_000] {
        sandbox.clock.set(now_ms);
        assert_eq!(queue.take_back().await.unwrap(), NOTHING);
        assert_eq!(queue.active_workers().await.unwrap().workers, 2, "after {now_ms} ms");
    }
    // The worker claims only now, so the lease of the job ends later than that of the worker.
    claim(&mut far, Scope::All, 1).await;
    sandbox.clock.set(3_700_000);
    assert_eq!(queue.take_back().await.unwrap(), NOTHING);
    assert!(finish(&mut far, "x", 1, done("record of x")).await);
}

/// Protects: no jobs are taken back from a live process on this machine, even if a clock that jumped forward or back
/// makes its lease look expired. Its outcomes are accepted.
async fn a_clock_that_jumps_takes_nothing(sandbox: &Sandbox) {
    sandbox.clock.set(1_000 * DAY_MS);
    let mut alive = left_by(sandbox, &Worker::this_process(1, "test", "")).await;
    for now_ms in [3_000 * DAY_MS, 0] {
        sandbox.clock.set(now_ms);
        let mut queue = sandbox.open().await;
        assert_eq!(queue.take_back().await.unwrap(), NOTHING);
        assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(1, 2, 1, 0));
    }
    assert_eq!(alive.heartbeat().await.unwrap(), 2);
    assert!(finish(&mut alive, "y", 1, done("record of y")).await);
}

/// Protects: for a worker on another machine, the leases decide: no job is taken back before its lease ends, and a
/// heartbeat extends the leases of all jobs. A lease that a wrong clock set far in the future counts as expired.
async fn leases_decide_for_other_machines(sandbox: &Sandbox) {
    let lease_ms = i64::try_from(Settings::default().lease.as_millis()).unwrap();
    let mut far = left_by(sandbox, &foreign_worker()).await;
    let mut queue = sandbox.open().await;
    sandbox.clock.set(lease_ms - 1);
    assert_eq!(queue.take_back().await.unwrap(), NOTHING);
    assert_eq!(far.heartbeat().await.unwrap(), 2);
    sandbox.clock.set(2 * lease_ms - 2);
    assert_eq!(queue.take_back().await.unwrap(), NOTHING);
    sandbox.clock.set(2 * lease_ms - 1);
    assert_eq!(queue.take_back().await.unwrap(), TakenBack { pending: 2, failed: 0 });
    assert_eq!(far.heartbeat().await.unwrap(), 0, "the worker learns that it lost its jobs");

    sandbox.clock.set(1_000 * DAY_MS);
    claim(&mut far, Scope::All, 1).await;
    sandbox.clock.set(3 * lease_ms);
    assert_eq!(queue.take_back().await.unwrap(), TakenBack { pending: 1, failed: 0 });
}

/// Protects: a worker counts as missing when two of the heartbeats that are sent eight times in a lease are overdue,
/// when it is stopping, or when its process is gone. It no longer counts as missing after a heartbeat. A worker that
/// waits for jobs to be given back thus knows how long to wait.
async fn a_worker_without_heartbeats_is_missing(sandbox: &Sandbox) {
    let lease_ms = i64::try_from(Settings::default().lease.as_millis()).unwrap();
    let mut queue = sandbox.open().await;
    assert!(!queue.has_missing_workers().await.unwrap(), "the worker itself does not count");
    let mut far = left_by(sandbox, &foreign_worker()).await;
    sandbox.clock.set(lease_ms / 4 - 1);
    assert!(!queue.has_missing_workers().await.unwrap());
    sandbox.clock.set(lease_ms / 4);
    assert!(queue.has_missing_workers().await.unwrap());
    far.heartbeat().await.unwrap();
    assert!(!queue.has_missing_workers().await.unwrap());
    far.mark_stopping().await.unwrap();
    assert!(queue.has_missing_workers().await.unwrap(), "a stopping worker gives its jobs back");
    far.unregister().await.unwrap();
    assert!(!queue.has_missing_workers().await.unwrap());
    sandbox.open_as(&dead_worker()).await;
    assert!(queue.has_missing_workers().await.unwrap());
}

/// Protects: a worker that was disconnected until garbage collection deleted its row has lost its jobs. It learns that
/// by its next heartbeat, and continues.
async fn a_deleted_worker_registers_again(sandbox: &Sandbox) {
    let mut far = left_by(sandbox, &foreign_worker()).await;
    sandbox.clock.set(2 * DAY_MS);
    let mut queue = sandbox.open().await;
    assert_eq!(queue.take_back().await.unwrap(), TakenBack { pending: 2, failed: 0 });
    assert_eq!(queue.collect_garbage().await.unwrap().workers, 1);
    assert_eq!(claim(&mut queue, Scope::All, 1).await.len(), 1);
    assert_eq!(far.heartbeat().await.unwrap(), 0);
    assert!(!finish(&mut far, "y", 1, done("a late record of y")).await);
    assert!(!finish(&mut far, "z", 1, done("a late record of z")).await);
    assert_eq!(keys(&claim(&mut far, Scope::All, 1).await), ["z"]);
    assert!(finish(&mut far, "z", 2, done("record of z")).await);
    assert_eq!(queue.active_workers().await.unwrap().workers, 2);
    assert_eq!(queue.take_back().await.unwrap(), NOTHING);
    assert_eq!(sandbox.number("SELECT COUNT(*) FROM results").await, 2);
}

/// Protects: a job whose processes die fails when the crash limit is reached, with that reason. Crashes are counted
/// separately from attempts, and a job that fails by itself is not run again.
async fn retries_have_a_limit(sandbox: &Sandbox) {
    let mut queue = sandbox.open_with(Settings { crash_limit: 2, ..Settings::default() }).await;
    queue.submit(&study("a", &["deadly", "bad"])).await.unwrap();
    // An interruption counts as an attempt, not as a crash.
    claim(&mut queue, Scope::All, 1).await;
    assert!(finish(&mut queue, "deadly", 1, FinishedOutcome::Released).await);
    for expected in [TakenBack { pending: 1, failed: 0 }, TakenBack { pending: 0, failed: 1 }] {
        let mut dead = sandbox.open_as(&dead_worker()).await;
        assert_eq!(keys(&claim(&mut dead, Scope::All, 1).await), ["deadly"]);
        assert_eq!(queue.take_back().await.unwrap(), expected);
    }
    claim(&mut queue, Scope::All, 1).await;
    assert!(finish(&mut queue, "bad", 1, failed("diverged")).await);
    assert!(claim(&mut queue, Scope::All, 9).await.is_empty());
    let rows = queue.rows("a").await.unwrap();
    assert_eq!((rows[0].state, rows[0].attempt, rows[0].crashes), (JobState::Failed, 3, 2));
    let error = rows[0].error.as_ref().unwrap();
    assert!(error.starts_with("its process died 2 times") && error.contains("tribosweep retry"), "{error}");
    assert_eq!(rows[0].wall_s, None, "the time is unknown");
    assert_eq!((rows[1].state, rows[1].attempt, rows[1].crashes), (JobState::Failed, 1, 0));
}

/// Protects: without other settings, a job fails when its process has died three times.
async fn three_crashes_fail_a_job(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["deadly"])).await.unwrap();
    for expected in [(1, 0), (1, 0), (0, 1)] {
        let mut dead = sandbox.open_as(&dead_worker()).await;
        claim(&mut dead, Scope::All, 1).await;
        let taken_back = queue.take_back().await.unwrap();
        assert_eq!((taken_back.pending, taken_back.failed), expected);
    }
}

/// Protects: the next attempt receives the checkpoint, whichever worker runs it. A job that makes progress does not
/// reach the crash limit. A worker that has lost the job cannot save a checkpoint. No checkpoint remains when the job
/// ends.
async fn checkpoints_reach_the_next_attempt(sandbox: &Sandbox) {
    let mut queue = sandbox.open_with(Settings { crash_limit: 2, ..Settings::default() }).await;
    queue.submit(&study("a", &["x"])).await.unwrap();
    let mut bytes: Option<Vec<u8>> = None;
    for attempt in 1..=4 {
        let mut dead = sandbox.open_as(&dead_worker()).await;
        let job = claim(&mut dead, Scope::All, 1).await.remove(0);
        assert_eq!((job.attempt, &job.checkpoint), (attempt, &bytes));
        for now in [0, 255] {
            bytes = Some(vec![now, attempt as u8, 0]);
            assert!(dead.save_checkpoint("x", attempt, bytes.as_ref().unwrap()).await.unwrap());
        }
        assert!(!dead.save_checkpoint("x", attempt + 1, b"wrong").await.unwrap());
        assert!(!queue.save_checkpoint("x", attempt, b"not its owner").await.unwrap());
        assert_eq!(queue.take_back().await.unwrap(), TakenBack { pending: 1, failed: 0 });
        assert!(!dead.save_checkpoint("x", attempt, b"late").await.unwrap());
    }
    assert_eq!(claim(&mut queue, Scope::All, 1).await[0].checkpoint, bytes);
    assert!(finish(&mut queue, "x", 5, done("r")).await);
    assert!(!queue.save_checkpoint("x", 5, b"after the end").await.unwrap());
    assert_eq!(sandbox.number("SELECT COUNT(*) FROM checkpoints").await, 0);
}

/// Protects: the death of a process that had been asked to stop is not a crash of its jobs: they are pending again,
/// however often they crashed before.
async fn a_stopped_process_has_not_crashed(sandbox: &Sandbox) {
    let mut queue = sandbox.open_with(Settings { crash_limit: 2, ..Settings::default() }).await;
    queue.submit(&study("a", &["x"])).await.unwrap();
    for (is_stopped, expected) in [
        (true, TakenBack { pending: 1, failed: 0 }),
        (false, TakenBack { pending: 1, failed: 0 }),
        (true, TakenBack { pending: 1, failed: 0 }),
        (false, TakenBack { pending: 0, failed: 1 }),
    ] {
        let mut dead = sandbox.open_as(&dead_worker()).await;
        claim(&mut dead, Scope::All, 1).await;
        if is_stopped {
            dead.mark_stopping().await.unwrap();
        }
        assert_eq!(queue.take_back().await.unwrap(), expected);
    }
    assert_eq!(queue.rows("a").await.unwrap()[0].crashes, 2);
}

/// Protects: a job that failed because its processes died, or that was cancelled, continues from its checkpoint when it
/// is requested again. A job that failed by itself starts from the beginning.
async fn a_checkpoint_outlasts_crashes(sandbox: &Sandbox) {
    let mut queue = sandbox.open_with(Settings { crash_limit: 1, ..Settings::default() }).await;
    queue.submit(&study("a", &["x"])).await.unwrap();
    let mut dead = sandbox.open_as(&dead_worker()).await;
    claim(&mut dead, Scope::All, 1).await;
    assert!(dead.save_checkpoint("x", 1, b"kept").await.unwrap());
    assert_eq!(queue.take_back().await.unwrap(), TakenBack { pending: 0, failed: 1 });
    queue.retry("a", Retry::Failed).await.unwrap();
    queue.cancel("a").await.unwrap();
    queue.retry("a", Retry::All).await.unwrap();
    assert_eq!(claim(&mut queue, Scope::All, 1).await[0].checkpoint.as_deref(), Some(&b"kept"[..]));
    assert!(finish(&mut queue, "x", 2, failed("diverged")).await);
    queue.retry("a", Retry::Failed).await.unwrap();
    assert_eq!(claim(&mut queue, Scope::All, 1).await[0].checkpoint, None);
}

/// Protects: a worker that ends in order gives back the jobs that it still holds, and that is not a crash.
async fn an_orderly_end_gives_everything_back(sandbox: &Sandbox) {
    let mut ending = left_by(sandbox, &foreign_worker()).await;
    ending.unregister().await.unwrap();
    let mut queue = sandbox.open().await;
    assert_eq!(queue.take_back().await.unwrap(), NOTHING);
    assert_eq!(queue.counts(&Scope::All).await.unwrap(), counts(3, 0, 1, 0));
    assert!(queue.rows("a").await.unwrap().iter().all(|row| row.crashes == 0));
}

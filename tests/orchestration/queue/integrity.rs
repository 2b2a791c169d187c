//! What is stored is as it was stored, and what cannot be is no end of the queue.

use tribosweep::queue::{
    FinishedOutcome, Integrity, JobState, Pages, Queue, QueueError, Scope, Worker, examine,
};

use crate::orchestration::support::{Engine, Sandbox, claim, counts, done, failed, finish, job, of, study};

on_both_databases! {
    results_have_digests,
    results_that_cannot_be_used_are_made_again,
    final_states_have_digests,
    rows_that_cannot_be,
    a_job_of_an_unknown_worker,
    a_worker_that_owns_what_it_does_not_know,
    missing_tables_are_found,
    a_damaged_payload_is_repaired,
}

/// Runs a statement that the constraints of the tables forbid.
async fn force(sandbox: &Sandbox, sqlite: &'static str, postgres: [&'static str; 2]) {
    match sandbox.engine {
        Engine::Sqlite => sandbox.run(sqlite).await,
        Engine::Postgres => {
            for statement in postgres {
                sandbox.run(statement).await;
            }
        }
    }
}

/// A queue with one done job and one that failed.
async fn ended(sandbox: &Sandbox) -> Queue {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    claim(&mut queue, of("a"), 2).await;
    assert!(finish(&mut queue, "x", 1, done("0.3512")).await);
    assert!(finish(&mut queue, "y", 1, failed("diverged")).await);
    queue
}

async fn integrities(queue: &mut Queue) -> Vec<Integrity> {
    let rows = queue.rows("a").await.unwrap().into_iter().map(|row| row.integrity).collect::<Vec<_>>();
    let results = queue.all_pages(Pages::of_results()).await.unwrap();
    assert!(results.iter().all(|result| result.counts));
    assert_eq!(rows, results.into_iter().map(|result| result.integrity).collect::<Vec<_>>());
    for (key, integrity) in [("x", rows[0]), ("y", rows[1])] {
        assert_eq!(queue.jobs(key, 1).await.unwrap()[0].integrity, integrity);
    }
    rows
}

/// Protects: a changed digit of a result is noticed by every way to read it, also in a copy. A result of an earlier version has
/// no digest and is readable.
async fn results_have_digests(sandbox: &Sandbox) {
    let mut queue = ended(sandbox).await;
    assert_eq!(integrities(&mut queue).await, [Integrity::Intact; 2]);
    sandbox.run("UPDATE results SET record = '0.3612' WHERE record IS NOT NULL").await;
    assert_eq!(integrities(&mut queue).await, [Integrity::Damaged, Integrity::Intact]);
    sandbox.run("UPDATE results SET digest = NULL WHERE error IS NOT NULL").await;
    assert_eq!(integrities(&mut queue).await, [Integrity::Damaged, Integrity::WithoutDigest]);
    let elsewhere = sandbox.another();
    let mut copy = elsewhere.open().await;
    copy.absorb(&mut queue, None).await.unwrap();
    assert_eq!(integrities(&mut copy).await, [Integrity::Damaged, Integrity::WithoutDigest]);
}

/// Protects: a job whose result cannot be used is run again when its user asks for it, and that result is gone. Other jobs stay.
async fn results_that_cannot_be_used_are_made_again(sandbox: &Sandbox) {
    let mut queue = ended(sandbox).await;
    assert_eq!(queue.run_again("a", &["x".to_owned(), "none".to_owned()]).await.unwrap(), 1);
    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(1, 0, 0, 1));
    assert_eq!(sandbox.number("SELECT COUNT(*) FROM results").await, 1);
    assert_eq!(claim(&mut queue, of("a"), 2).await[0].attempt, 2);
    assert!(finish(&mut queue, "x", 2, done("0.3512")).await);
    assert_eq!(integrities(&mut queue).await, [Integrity::Intact; 2]);
    // A running job is not touched.
    queue.submit(&study("a", &["x", "y", "z"])).await.unwrap();
    claim(&mut queue, of("a"), 1).await;
    assert_eq!(queue.run_again("a", &["z".to_owned()]).await.unwrap(), 0);
}

/// Protects: a job does not begin from a state that was damaged or belongs to another job. One of an earlier version has no
/// digest and is used.
async fn final_states_have_digests(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    let mut study = study("a", &["x", "w"]);
    queue.submit(&study).await.unwrap();
    claim(&mut queue, of("a"), 2).await;
    for (key, state) in [("x", vec![1, 2, 3]), ("w", vec![4, 5, 6])] {
        let outcome =
            FinishedOutcome::Done { record: "r".into(), label: "end".into(), final_state: Some(state) };
        assert!(finish(&mut queue, key, 1, outcome).await);
    }
    let mut child = job("y", 1.0);
    child.parent = Some("x".into());
    study.jobs.push(child);
    queue.submit(&study).await.unwrap();
    for (statement, state, is_damaged) in [
        ("SELECT 1", Some(vec![1, 2, 3]), false),
        (
            "UPDATE final_states SET bytes = (SELECT f.bytes FROM final_states AS f ORDER BY f.job_id DESC LIMIT 1)",
            None,
            true,
        ),
        ("UPDATE final_states SET digest = NULL", Some(vec![4, 5, 6]), false),
    ] {
        sandbox.run(statement).await;
        let claimed = claim(&mut queue, of("a"), 1).await.remove(0);
        assert_eq!(claimed.parent.as_deref(), Some("x"));
        assert_eq!((claimed.parent_state, claimed.parent_is_damaged), (state, is_damaged), "{statement}");
        finish(&mut queue, "y", claimed.attempt, FinishedOutcome::Unstarted).await;
    }
}

/// Protects: numbers and states that no version writes are an error, or are passed over. Nothing panics or runs for ever.
async fn rows_that_cannot_be(sandbox: &Sandbox) {
    let mut queue = ended(sandbox).await;
    queue.submit(&study("b", &["p"])).await.unwrap();
    // The last row of a study, and a negative number of starts.
    sandbox.run("UPDATE study_jobs SET ordinal = 9223372036854775807 WHERE ordinal = 1").await;
    sandbox.run("UPDATE jobs SET attempt = -5, crashes = -1 WHERE key = 'p'").await;
    assert_eq!(queue.rows("a").await.unwrap().len(), 2);
    let pages = queue.pages_of_parameters("a").await.unwrap();
    assert_eq!(queue.all_pages(pages).await.unwrap().len(), 2);
    let elsewhere = sandbox.another();
    assert_eq!(elsewhere.open().await.absorb(&mut queue, Some("a")).await.unwrap().rows, 2);
    assert_eq!(queue.rows("b").await.unwrap()[0].attempt, 0);
    let claimed = claim(&mut queue, of("b"), 1).await;
    assert_eq!(claimed[0].attempt, 1);
    assert!(finish(&mut queue, "p", 1, done("r")).await);
    sandbox.run("UPDATE jobs SET state = 'pending', attempt = 8589934592 WHERE key = 'p'").await;
    let error = queue.exchange(&[], &[tribosweep::queue::Claim { scope: Scope::All, limit: 1, batch: None }]);
    let error = error.await.unwrap_err();
    assert!(matches!(error, QueueError::Inconsistent(_)), "{error:?}");
    assert_eq!(queue.counts(&of("b")).await.unwrap(), counts(1, 0, 0, 0), "nothing was claimed");
    force(
        sandbox,
        "PRAGMA ignore_check_constraints = ON; UPDATE jobs SET state = 'lost' WHERE key = 'x'",
        [
            "ALTER TABLE jobs DROP CONSTRAINT jobs_state_check",
            "UPDATE jobs SET state = 'lost' WHERE key = 'x'",
        ],
    )
    .await;
    for error in [
        queue.counts(&Scope::All).await.unwrap_err(),
        queue.rows("a").await.unwrap_err(),
        queue.jobs("x", 1).await.unwrap_err(),
        queue.states(&["x"]).await.unwrap_err(),
    ] {
        assert!(matches!(error, QueueError::Inconsistent(_)), "{error:?}");
        assert!(error.to_string().contains("`lost`"), "{error}");
    }
    let findings = examine(&sandbox.location(), sandbox.clock.clock()).await.unwrap();
    let rows = findings.iter().find(|finding| finding.subject == "rows").unwrap();
    assert!(rows.is_problem && rows.text.contains("a state that there is not: 1"), "{}", rows.text);
    assert!(rows.text.contains("impossible number of starts: 1"), "{}", rows.text);
}

/// Protects: a running job whose owner the database does not know is pending again, whatever its lease.
async fn a_job_of_an_unknown_worker(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x"])).await.unwrap();
    force(
        sandbox,
        "PRAGMA foreign_keys = OFF;
         UPDATE jobs SET state = 'running', owner = 999, lease_until_ms = 9000000000000000000",
        [
            "ALTER TABLE jobs DROP CONSTRAINT jobs_owner_fkey",
            "UPDATE jobs SET state = 'running', owner = 999, lease_until_ms = 9000000000000000000",
        ],
    )
    .await;
    let findings = examine(&sandbox.location(), sandbox.clock.clock()).await.unwrap();
    assert!(
        findings.iter().any(|finding| finding.text.contains("processes that are gone have left 1")),
        "{findings:#?}"
    );
    assert_eq!(queue.take_back().await.unwrap().pending, 1);
    let row = queue.rows("a").await.unwrap().remove(0);
    assert_eq!((row.state, row.crashes), (JobState::Pending, 0));
    assert!(row.note.unwrap().contains("does not know the worker"));
}

/// Protects: a worker gives back a job that it owns in the database without running it. It would wait for itself for ever.
async fn a_worker_that_owns_what_it_does_not_know(sandbox: &Sandbox) {
    let mut queue = sandbox.open().await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    let own = claim(&mut queue, of("a"), 1).await.remove(0);
    sandbox
        .run("UPDATE jobs SET state = 'running', owner = (SELECT MAX(id) FROM workers), lease_until_ms = 1 WHERE state = 'pending'")
        .await;
    queue.heartbeat().await.unwrap();
    assert_eq!(queue.counts(&of("a")).await.unwrap(), counts(1, 1, 0, 0));
    assert!(finish(&mut queue, &own.key, 1, done("r")).await);
}

/// Protects: a table that is missing is found before a worker needs it.
async fn missing_tables_are_found(sandbox: &Sandbox) {
    sandbox.open().await.close().await.unwrap();
    let problems = async || {
        let findings = examine(&sandbox.location(), sandbox.clock.clock()).await.unwrap();
        let problems =
            findings.into_iter().filter(|finding| finding.is_problem && finding.subject == "tables");
        problems.map(|finding| finding.text).collect::<Vec<_>>()
    };
    assert!(problems().await.is_empty());
    sandbox.run("DROP TABLE plans").await;
    assert!(problems().await[0].starts_with("missing: plans;"), "{:?}", problems().await);
}

/// Protects: a failed job whose payload was damaged has that of its study when the study is submitted again. A job that is done
/// keeps what it was made from.
async fn a_damaged_payload_is_repaired(sandbox: &Sandbox) {
    let mut queue = ended(sandbox).await;
    sandbox.run("UPDATE payloads SET payload = '{}'").await;
    queue.submit(&study("a", &["x", "y"])).await.unwrap();
    let payload = |details: Vec<tribosweep::queue::JobDetails>| details[0].payload.clone();
    assert_eq!(payload(queue.jobs("x", 1).await.unwrap()), "{}");
    assert_eq!(payload(queue.jobs("y", 1).await.unwrap()), "payload of y");
}

/// Protects: a stopped process that holds jobs is named, with what to do, as long as it is stopped; it keeps its jobs, and does
/// not count as an active worker.
#[cfg(target_os = "linux")]
#[tokio::test]
async fn a_stopped_process_is_named() {
    let sandbox = Sandbox::new();
    let mut child = std::process::Command::new("sleep").arg("60").spawn().unwrap();
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", child.id())).unwrap();
    let start = stat.rsplit_once(')').unwrap().1.split_ascii_whitespace().nth(19).unwrap();
    let worker = Worker {
        pid: child.id(),
        process_start: Some(start.parse().unwrap()),
        ..Worker::this_process(1, "test", "provenance")
    };
    let mut stopped = sandbox.open_as(&worker).await;
    stopped.submit(&study("a", &["x", "y"])).await.unwrap();
    claim(&mut stopped, of("a"), 2).await;
    let mut queue = sandbox.open().await;
    sandbox.clock.set(10 * 60_000);
    assert!(queue.stopped_workers().await.unwrap().is_empty());
    assert_eq!(queue.active_workers().await.unwrap().workers, 2);
    let send = |signal: &str| {
        let sent = std::process::Command::new("kill").args([signal, &child.id().to_string()]).status();
        assert!(sent.unwrap().success());
    };
    send("-STOP");
    let begun = std::time::Instant::now();
    let advice = loop {
        assert!(begun.elapsed().as_secs() < 30, "nobody notices that the process is stopped");
        if let Some(advice) = queue.stopped_workers().await.unwrap().pop() {
            break advice;
        }
    };
    let pid = child.id();
    assert_eq!(
        advice,
        format!(
            "process {pid} has been stopped for 10 min and holds 2 jobs: continue it (`kill -CONT {pid}`) or end it \
             (`kill {pid}; kill -CONT {pid}`)"
        )
    );
    assert_eq!(queue.take_back().await.unwrap().pending, 0);
    assert_eq!(queue.active_workers().await.unwrap().workers, 1);
    let findings = examine(&sandbox.location(), sandbox.clock.clock()).await.unwrap();
    assert!(findings.iter().any(|finding| finding.is_problem && finding.text == advice), "{findings:#?}");
    // Whoever waits for a lock in the meantime is told of the process that probably holds it.
    let settings = tribosweep::queue::Settings {
        busy_timeout: std::time::Duration::from_millis(20),
        ..tribosweep::queue::Settings::default()
    };
    let mut foreign = sandbox.raw().await;
    sqlx::raw_sql("BEGIN IMMEDIATE").execute(&mut foreign).await.unwrap();
    let mut waiting = Queue::open_with(sandbox.location(), sandbox.clock.clock(), settings).await.unwrap();
    let error = waiting.cancel("a").await.unwrap_err().to_string();
    assert!(error.contains(&format!("process {pid}, a worker of this database that is stopped")), "{error}");
    send("-CONT");
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(queue.stopped_workers().await.unwrap().is_empty());
    sqlx::raw_sql("ROLLBACK").execute(&mut foreign).await.unwrap();
    assert_eq!(queue.take_back().await.unwrap().pending, 2);
}

/// Protects: both databases have an index for the same queries, so that none of them is slow on one of them.
#[tokio::test]
async fn both_databases_have_the_same_indexes() {
    let file = Sandbox::new();
    file.open().await.close().await.unwrap();
    let Some(server) = Sandbox::of(Engine::Postgres) else { return };
    server.open().await.close().await.unwrap();
    // What the primary key of SQLite's table orders, and the few workers of a file, need no index there.
    let own = "SELECT group_concat(name, ' ') FROM (
                   SELECT name FROM sqlite_schema WHERE type = 'index' AND sql IS NOT NULL ORDER BY name)";
    let others = "SELECT string_agg(indexname, ' ' ORDER BY indexname COLLATE \"C\") FROM pg_indexes
                  WHERE schemaname = 'tribosweep' AND indexdef NOT LIKE '%UNIQUE%'
                    AND indexname NOT IN ('workers_there', 'study_pending_order')";
    let names = "jobs_owner jobs_pending jobs_pending_batch jobs_state study_jobs_job study_pending_batch";
    assert_eq!((file.text(own).await.as_str(), server.text(others).await.as_str()), (names, names));
}

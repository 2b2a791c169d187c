//! Several processes on one database, some of which are killed: every job is stored once, no finished job is lost, and the
//! results are those of an uninterrupted run.
#![cfg(unix)]

use crate::random::Random;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use serde_json::{Value, json};
use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions, SqliteConnection};

use crate::cli::support::{
    Folder, Running, long, rows, small, stderr, stdout, wait, wall_times, without_wall_times,
};

/// More jobs than a process finishes before it is killed here. They take some tens of milliseconds each.
fn many() -> Value {
    let mut study = small(&json!({
        "mu": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
        "omega_rpm": [5, 20],
        "limit_s": [0.03, 0.04, 0.05, 0.06, 0.07],
    }));
    study["run"] = json!({ "stop_early": false });
    study
}

/// Jobs that a thread advances together.
const LANES: u64 = 8;

/// The largest number of jobs that a thread holds: in its lanes, waiting for a lane, and ended but not stored yet.
const HELD: u64 = 3 * LANES;

fn undisturbed(study: &Value) -> String {
    let folder = Folder::with("study", study);
    folder.ok("run study.json");
    without_wall_times(&folder.ok("export study"))
}

/// The rows of an SQL statement on the database.
pub fn read<T>(folder: &Folder, statement: &'static str) -> Vec<T>
where
    T: Send + Unpin + for<'r> sqlx::FromRow<'r, sqlx::sqlite::SqliteRow>,
{
    tokio::runtime::Builder::new_current_thread().build().unwrap().block_on(async {
        let options = SqliteConnectOptions::new().filename(folder.path("tribosweep.db"));
        let mut connection: SqliteConnection = options.connect().await.unwrap();
        sqlx::query_as(statement).fetch_all(&mut connection).await.unwrap()
    })
}

/// Protects: two processes share the jobs of a study: both run some of them, no job is run twice, and both end with success.
#[test]
fn two_workers_share_a_study() {
    let folder = Folder::with("study", &many());
    folder.ok("submit study.json");
    let workers = [folder.start("work --threads 1"), folder.start("work --threads 1")];
    for worker in workers {
        let (code, _, messages) = worker.end();
        assert_eq!(code, Some(0), "{messages}");
        assert!(!messages.contains("taken back"), "{messages}");
    }
    assert_eq!(without_wall_times(&folder.ok("export study")), undisturbed(&many()));
    let attempts: Vec<(i64, i64)> = read(&folder, "SELECT MIN(attempt), MAX(attempt) FROM jobs");
    assert_eq!(attempts, [(1, 1)]);
    let by_worker: Vec<(i64, i64)> =
        read(&folder, "SELECT provenance ->> 'pid', COUNT(*) FROM results GROUP BY 1");
    assert_eq!(by_worker.len(), 2, "{by_worker:?}");
    assert_eq!(by_worker.iter().map(|(_, count)| count).sum::<i64>(), 60);
    assert!(folder.ok("doctor").contains("none at work"));
}

/// Protects: when one of two processes is killed, the other takes its jobs back and runs them. No finished job is run again.
#[test]
fn the_other_worker_takes_jobs_back() {
    let folder = Folder::with("study", &many());
    folder.ok("submit study.json");
    let survivor = folder.start("work --threads 1");
    let killed = folder.start("work --threads 1");
    folder.wait_for("study", |counts| counts["done"] >= 2 && counts["running"] > LANES);
    let pid = i64::from(killed.id());
    killed.signal("KILL");
    assert_eq!(killed.end().0, None);
    // The survivor takes jobs back only when it has no work or sends a heartbeat.
    let owners: Vec<(i64,)> = read(
        &folder,
        "SELECT w.pid FROM jobs AS j JOIN workers AS w ON w.id = j.owner WHERE j.state = 'running'",
    );
    let held: i64 = owners.iter().map(|owner| i64::from(owner.0 == pid)).sum();
    let before = wall_times(&folder.ok("export study"));
    let (code, _, messages) = survivor.end();
    assert_eq!(code, Some(0), "{messages}");
    let export = folder.ok("export study");
    assert_eq!(without_wall_times(&export), undisturbed(&many()));
    let after = wall_times(&export);
    for (job, wall_s) in &before {
        assert_eq!(&after[job], wall_s, "{job} was run again");
    }
    let crashes: Vec<(i64, i64)> = read(&folder, "SELECT SUM(crashes), SUM(attempt) - COUNT(*) FROM jobs");
    let (crashes, repeated) = crashes[0];
    assert!((1..=HELD).contains(&crashes.unsigned_abs()), "{crashes} jobs were held by the one thread");
    assert_eq!((crashes, repeated), (held, held), "the jobs that it held, and no others");
}

/// Protects: a job whose process dies several times in a row fails with that reason, and `retry` runs it again.
#[test]
fn a_job_that_kills_its_process_fails() {
    let mut study = long();
    study["grid"] = json!({ "mu": [0.2] });
    study["run"]["limit_s"] = json!(4.0);
    let folder = Folder::with("study", &study);
    folder.ok("submit study.json");
    for attempt in 1..=2 {
        let work = folder.start("work --max-crashes 2");
        // The state does not tell the attempts apart: the job stays running until this process has taken it back.
        wait("the attempt", || read::<(i64,)>(&folder, "SELECT attempt FROM jobs") == [(attempt,)]);
        work.signal("KILL");
        assert_eq!(work.end().0, None);
    }
    let (code, _, messages) = folder.start("work --max-crashes 2").end();
    assert_eq!(code, Some(1), "{messages}");
    assert!(messages.contains("died several times in a row"), "{messages}");
    let status = folder.ok("status study");
    assert!(status.contains("its process died 2 times"), "{status}");
    folder.ok("retry study --failed");
    folder.ok("work");
    assert_eq!(rows(&folder.ok("export study"))[0]["error"], "");
}

/// Protects: a long job whose process is killed continues from its last checkpoint to the same result. Progress resets its
/// count of crashes.
#[test]
fn a_killed_long_job_continues_from_its_checkpoint() {
    let mut study = long();
    study["grid"] = json!({ "mu": [0.2, 0.4] });
    study["run"]["limit_s"] = json!(1.0);
    let undisturbed = Folder::with("study", &study);
    undisturbed.ok("run study.json");
    let folder = Folder::with("study", &study);
    folder.ok("submit study.json");
    let checkpoints = || read::<(i64,)>(&folder, "SELECT COALESCE(SUM(attempt), 0) FROM checkpoints");
    for attempt in 1..=3 {
        let work = folder.start("work --checkpoint-every 0.02 --max-crashes 2");
        // Both jobs have one from this attempt.
        wait("a checkpoint", || checkpoints() == [(2 * attempt,)]);
        work.signal("KILL");
        assert_eq!(work.end().0, None);
    }
    folder.ok("work --max-crashes 2");
    let [expected, found] = [&undisturbed, &folder].map(|of| without_wall_times(&of.ok("export study")));
    assert_eq!(found, expected);
}

/// Protects: a copy of the database's files at any instant while a process writes, as after a power cut or in a backup, can
/// be opened and has every result that was finished before. The order of copying does not matter.
#[test]
fn a_copy_at_any_instant_is_consistent() {
    let mut random = Random::new(11);
    let mut instants = BTreeSet::new();
    // Jobs that are advanced together end together, so on a fast machine one sweep may have only a few instants.
    for _ in 0..10 {
        instants.extend(copy_at_instants(&mut random));
        if instants.len() > 5 {
            return;
        }
    }
    panic!("copies at different instants: {instants:?}");
}

/// Copies the database of a sweep several times, checks the copies, and returns the number of finished jobs in each.
fn copy_at_instants(random: &mut Random) -> Vec<usize> {
    let folder = Folder::with("study", &many());
    let run = folder.start("run study.json --threads 2");
    folder.wait_for("study", |counts| counts["done"] > 0);
    let finished = || {
        let jobs = "SELECT key FROM jobs WHERE state = 'done'";
        read::<(String,)>(&folder, jobs).into_iter().map(|(job,)| job).collect::<BTreeSet<_>>()
    };
    let mut copies = Vec::new();
    for copy in 0..12 {
        std::thread::sleep(Duration::from_millis(random.below(90) as u64));
        let before = finished();
        if before.len() == 60 {
            // The process may close the database before it stops.
            break;
        }
        // The process is stopped while its files are copied, with all locks that it holds, and while the copy is checked,
        // so that there are several instants on a slow machine too.
        run.signal("STOP");
        wait_until_stopped(&run);
        let other = Folder::new();
        let mut files = ["", "-wal", "-shm"];
        files.rotate_left(copy % 3);
        let copied = files.iter().filter(|suffix| copy % 4 > 0 || **suffix != "-shm").all(|suffix| {
            let name = format!("tribosweep.db{suffix}");
            std::fs::copy(folder.path(&name), other.path(&name)).is_ok()
        });
        if !copied {
            // The process had closed the database.
            run.signal("CONT");
            break;
        }
        let then = wall_times(&other.ok("export study"));
        // The process that owns the jobs is stopped, which is a problem that `doctor` names.
        let doctor = stdout(&other.command("doctor").assert());
        run.signal("CONT");
        assert!(doctor.contains("integrity    ok"), "{doctor}");
        assert!(
            before.iter().all(|job| then.contains_key(job)),
            "the copy lacks finished jobs: {before:?}, {then:?}"
        );
        copies.push(then);
    }
    let (code, _, messages) = run.end();
    assert_eq!(code, Some(0), "{messages}");
    let after = wall_times(&folder.ok("export study"));
    for then in &copies {
        let finished = then.iter().all(|(job, wall_s)| after.get(job) == Some(wall_s));
        assert!(finished, "the copy has jobs that were not finished: {then:?}, {after:?}");
    }
    copies.iter().map(BTreeMap::len).collect()
}

/// Waits until every thread of the process is stopped.
fn wait_until_stopped(run: &Running) {
    let tasks = format!("/proc/{}/task", run.id());
    wait("the process to stop", || {
        std::fs::read_dir(&tasks).unwrap().all(|task| {
            let stat = std::fs::read_to_string(task.unwrap().path().join("stat")).unwrap_or_default();
            stat.rsplit(')').next().is_some_and(|rest| rest.starts_with(" T") || rest.starts_with(" Z"))
        })
    });
}

/// Protects: many random kills of several processes lose no finished result, repeat only jobs that were running, store no
/// result twice, and end with the results of an uninterrupted run. (`scripts/torture.py` is a longer version.)
#[test]
fn many_kills_lose_nothing() {
    const WORKERS: usize = 3;
    const MOST_KILLS: u64 = 80;
    let folder = Folder::with("study", &many());
    folder.ok("submit study.json");
    let mut random = Random::new(5);
    let start = || folder.start("work --threads 1 --max-crashes 1000");
    let mut workers: Vec<Running> = (0..WORKERS).map(|_| start()).collect();
    let mut kills = 0;
    let mut finished = BTreeMap::new();
    while kills < MOST_KILLS && finished.len() < 60 {
        // Short enough for many kills on a fast machine, and long enough for some jobs to end.
        std::thread::sleep(Duration::from_millis(random.below(80) as u64));
        let index = random.below(WORKERS);
        let killed = std::mem::replace(&mut workers[index], start());
        killed.signal("KILL");
        kills += u64::from(killed.end().0.is_none());
        let results = "SELECT key, wall_s FROM results AS r JOIN jobs AS j ON j.id = r.job_id";
        let now: BTreeMap<String, f64> = read(&folder, results).into_iter().collect();
        for (job, wall_s) in &finished {
            assert_eq!(now.get(job), Some(wall_s), "{job} was lost or run again");
        }
        finished = now;
    }
    for worker in workers {
        let (code, _, messages) = worker.end();
        assert_eq!(code, Some(0), "{messages}");
    }
    assert_eq!(without_wall_times(&folder.ok("export study")), undisturbed(&many()));
    let counts: Vec<(i64, i64, i64)> = read(
        &folder,
        "SELECT COUNT(*), SUM(attempt), (SELECT COUNT(*) FROM results) FROM jobs WHERE state = 'done'",
    );
    let (jobs, attempts, results) = counts[0];
    assert_eq!((jobs, results), (60, 60));
    assert!(kills >= 10, "only {kills} kills");
    let repeated = (attempts - jobs).unsigned_abs();
    let most = HELD * kills;
    assert!(repeated <= most, "{repeated} jobs were repeated after {kills} kills of one thread each");
    println!("{kills} kills, {repeated} jobs repeated, {jobs} jobs");
}

/// Lets a worker that is idle be idle for a second: another worker with an idle exit after that time begins later, finds
/// no job either, and ends by itself.
fn let_a_second_pass(folder: &Folder) {
    let (code, _, messages) = folder.start("work --idle-exit 1s").end();
    assert_eq!(code, Some(0), "{messages}");
}

/// Protects: a worker with an idle exit runs jobs that are submitted while it is idle, and ends when no job has come for that
/// time.
#[test]
fn an_idle_worker_runs_new_jobs() {
    let folder = Folder::with("first", &small(&json!({ "mu": [0.2, 0.3] })));
    folder.add("second", &small(&json!({ "mu": [0.4, 0.5] })));
    folder.add("third", &small(&json!({ "mu": [0.1] })));
    folder.ok("submit first.json");
    let patient = folder.start("work --idle-exit 1h");
    folder.wait_for("first", |jobs| jobs["done"] == 2);
    let_a_second_pass(&folder);
    folder.ok("submit second.json");
    folder.wait_for("second", |jobs| jobs["done"] == 2);
    let by_worker: Vec<(i64, i64)> =
        read(&folder, "SELECT provenance ->> 'pid', COUNT(*) FROM results GROUP BY 1");
    assert_eq!(by_worker, [(i64::from(patient.id()), 4)], "the patient worker runs all jobs");
    patient.signal("KILL");
    patient.end();

    folder.ok("submit third.json");
    let (code, _, messages) = folder.start("work --idle-exit 1s").end();
    assert_eq!(code, Some(0), "{messages}");
    assert!(messages.contains("5 done, 0 failed, 0 left"), "{messages}");
    let assert = folder.command("work --idle-exit soon").assert().code(2);
    assert!(stderr(&assert).contains("expected a duration such as 60s"), "{}", stderr(&assert));
}

/// Protects: a worker with an idle exit does not wait for jobs that a stopped process holds, and says what to do. It takes over the
/// jobs of a worker that died.
#[test]
fn an_idle_worker_does_not_wait_for_a_straggler() {
    let mut study = long();
    study["grid"] = json!({ "mu": [0.2, 0.4] });
    study["run"]["limit_s"] = json!(2.0);
    let folder = Folder::with("study", &study);
    folder.ok("submit study.json");
    let straggler = folder.start("work --threads 1");
    folder.wait_for("study", |jobs| jobs["running"] == 2);
    straggler.signal("STOP");
    wait_until_stopped(&straggler);
    let (code, _, messages) = folder.start("work --idle-exit 1s").end();
    assert_eq!(code, Some(3), "{messages}");
    assert!(messages.contains("holds 2 jobs: continue it"), "{messages}");

    let staying = folder.start("work --idle-exit 5s");
    wait("a worker to stay", || {
        read::<(i64,)>(&folder, "SELECT COUNT(*) FROM workers WHERE ended_ms IS NULL") == [(2,)]
    });
    straggler.signal("KILL");
    straggler.end();
    let (code, _, messages) = staying.end();
    assert_eq!(code, Some(0), "{messages}");
    assert!(messages.contains("2 jobs left running by an interrupted process were taken back"), "{messages}");
    assert!(folder.ok("status study").contains("2 done"));
}

/// Protects: Ctrl-C stops an idle worker immediately and with success, since no job is left.
#[cfg(target_os = "linux")]
#[test]
fn an_idle_worker_can_be_stopped() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    folder.ok("submit mine.json");
    let worker = folder.start("work --idle-exit 1h");
    folder.wait_for("mine", |jobs| jobs["done"] == 1);
    let_a_second_pass(&folder);
    worker.signal("INT");
    let (code, _, err) = worker.end();
    assert_eq!(code, Some(0), "{err}");
}

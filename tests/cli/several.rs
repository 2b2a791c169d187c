//! Several processes on one database, some of which are killed: every job is done once, nothing that was finished is
//! lost, and the bytes are those of an undisturbed run.
#![cfg(unix)]

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions, SqliteConnection};

use crate::support::{Folder, Running, long, rows, small, stderr, wait, wall_times, without_wall_times};

/// More jobs than a process does in its life here, of different lengths, some tens of milliseconds each.
fn many() -> Value {
    let mut study = small(&json!({
        "mu": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
        "omega_rpm": [5, 20],
        "limit_s": [0.04, 0.06, 0.08, 0.10, 0.12],
    }));
    study["run"] = json!({ "stop_early": false });
    study
}

/// Jobs that a thread runs at once.
const LANES: u64 = 8;

/// Jobs that a thread holds at most: in its lanes, waiting for one, and ended but not stored yet.
const HELD: u64 = 3 * LANES;

fn undisturbed(study: &Value) -> String {
    let folder = Folder::with("study", study);
    folder.ok("run study.json");
    without_wall_times(&folder.ok("export study"))
}

/// Rows of a statement, past the program.
fn read<T>(folder: &Folder, statement: &'static str) -> Vec<T>
where
    T: Send + Unpin + for<'r> sqlx::FromRow<'r, sqlx::sqlite::SqliteRow>,
{
    tokio::runtime::Builder::new_current_thread().build().unwrap().block_on(async {
        let options = SqliteConnectOptions::new().filename(folder.path("tribosweep.db"));
        let mut connection: SqliteConnection = options.connect().await.unwrap();
        sqlx::query_as(statement).fetch_all(&mut connection).await.unwrap()
    })
}

/// Numbers that look random and are the same in every run.
struct Draw(u64);

impl Draw {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }
}

/// Protects: two processes that work on one study share it: both do some of its jobs, none does another's, and both
/// say that all is done.
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

/// Protects: when one of two processes is killed, the other takes its jobs back while it works, does them, and ends
/// with everything done; nothing that either had finished is done again.
#[test]
fn the_other_goes_on() {
    let folder = Folder::with("study", &many());
    folder.ok("submit study.json");
    let survivor = folder.start("work --threads 1");
    let killed = folder.start("work --threads 1");
    folder.wait_for("study", |counts| counts["done"] >= 2 && counts["running"] > LANES);
    let pid = i64::from(killed.id());
    killed.signal("KILL");
    assert_eq!(killed.end().0, None);
    // The survivor has work of its own, and takes nothing back before it has none or its heartbeat comes.
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
        assert_eq!(&after[job], wall_s, "{job} was done again");
    }
    let crashes: Vec<(i64, i64)> = read(&folder, "SELECT SUM(crashes), SUM(attempt) - COUNT(*) FROM jobs");
    let (crashes, repeated) = crashes[0];
    assert!((1..=HELD).contains(&crashes.unsigned_abs()), "{crashes} jobs were held by the one thread");
    assert_eq!((crashes, repeated), (held, held), "what it held, and nothing else");
}

/// Protects: a job whose processes die again and again fails with that reason, and is run again when it is asked for.
#[test]
fn a_deadly_job_fails() {
    let mut study = long();
    study["grid"] = json!({ "mu": [0.2] });
    study["run"]["limit_s"] = json!(4.0);
    let folder = Folder::with("study", &study);
    folder.ok("submit study.json");
    for attempt in 1..=2 {
        let work = folder.start("work --max-crashes 2");
        // The job is "running" from the process before until this one has taken it.
        wait("the attempt", || read::<(i64,)>(&folder, "SELECT attempt FROM jobs") == [(attempt,)]);
        work.signal("KILL");
        assert_eq!(work.end().0, None);
    }
    let (code, _, messages) = folder.start("work --max-crashes 2").end();
    assert_eq!(code, Some(1), "{messages}");
    assert!(messages.contains("died again and again"), "{messages}");
    let status = folder.ok("status study");
    assert!(status.contains("its process died 2 times"), "{status}");
    folder.ok("retry study --failed");
    folder.ok("work");
    assert_eq!(rows(&folder.ok("export study"))[0]["error"], "");
}

/// Protects: a long job whose process is killed goes on from its last checkpoint to the same bytes, and is not blamed.
#[test]
fn a_killed_long_job_goes_on() {
    let mut study = long();
    study["grid"] = json!({ "mu": [0.2, 0.4] });
    study["run"]["limit_s"] = json!(2.0);
    let undisturbed = Folder::with("study", &study);
    undisturbed.ok("run study.json");
    let folder = Folder::with("study", &study);
    folder.ok("submit study.json");
    let kept = || read::<(i64,)>(&folder, "SELECT COALESCE(SUM(attempt), 0) FROM checkpoints");
    for attempt in 1..=3 {
        let work = folder.start("work --checkpoint-every 0.02 --max-crashes 2");
        // Both jobs, each by this attempt.
        wait("a checkpoint", || kept() == [(2 * attempt,)]);
        work.signal("KILL");
        assert_eq!(work.end().0, None);
    }
    folder.ok("work --max-crashes 2");
    let [expected, found] = [&undisturbed, &folder].map(|of| without_wall_times(&of.ok("export study")));
    assert_eq!(found, expected);
}

/// Protects: a copy of the database's files at any instant of a process that writes it, as a power cut or a backup
/// leaves them, in whatever order they are copied, opens whole and holds every result that was finished by then.
#[test]
fn a_copy_at_any_instant_is_whole() {
    let mut draw = Draw(11);
    let mut instants = BTreeSet::new();
    // Jobs that are computed together end together, and a sweep is as fast as the machine: not every one has as many.
    for _ in 0..10 {
        instants.extend(copy_at_instants(&mut draw));
        if instants.len() > 5 {
            return;
        }
    }
    panic!("copies at different instants: {instants:?}");
}

/// Copies the database of a sweep again and again, looks at the copies, and returns how many jobs they had finished.
fn copy_at_instants(draw: &mut Draw) -> Vec<usize> {
    let folder = Folder::with("study", &many());
    let run = folder.start("run study.json --threads 2");
    folder.wait_for("study", |counts| counts["done"] > 0);
    let finished = || {
        let jobs = "SELECT key FROM jobs WHERE state = 'done'";
        read::<(String,)>(&folder, jobs).into_iter().map(|(job,)| job).collect::<BTreeSet<_>>()
    };
    let mut copies = Vec::new();
    for copy in 0..12 {
        std::thread::sleep(Duration::from_millis(draw.below(90)));
        let before = finished();
        if before.len() == 60 {
            // The process may close the database before it stops.
            break;
        }
        // The instant: the process stands still while its files are copied, with whatever locks it holds, and while
        // the copy is looked at, so that there are several instants on a slow machine, too.
        run.signal("STOP");
        stopped(&run);
        let other = Folder::new();
        let mut files = ["", "-wal", "-shm"];
        files.rotate_left(copy % 3);
        let copied = files.iter().filter(|suffix| copy % 4 > 0 || **suffix != "-shm").all(|suffix| {
            let name = format!("tribosweep.db{suffix}");
            std::fs::copy(folder.path(&name), other.path(&name)).is_ok()
        });
        if !copied {
            // It had closed the database.
            run.signal("CONT");
            break;
        }
        let then = wall_times(&other.ok("export study"));
        let doctor = other.ok("doctor");
        run.signal("CONT");
        assert!(doctor.contains("integrity    ok"), "{doctor}");
        assert!(
            before.iter().all(|job| then.contains_key(job)),
            "the copy lacks what was finished: {before:?}, {then:?}"
        );
        copies.push(then);
    }
    let (code, _, messages) = run.end();
    assert_eq!(code, Some(0), "{messages}");
    let after = wall_times(&folder.ok("export study"));
    for then in &copies {
        let finished = then.iter().all(|(job, wall_s)| after.get(job) == Some(wall_s));
        assert!(finished, "the copy has what was never finished: {then:?}, {after:?}");
    }
    copies.iter().map(BTreeMap::len).collect()
}

/// Waits until every thread of the process stands still.
fn stopped(run: &Running) {
    let tasks = format!("/proc/{}/task", run.id());
    wait("the process to stop", || {
        std::fs::read_dir(&tasks).unwrap().all(|task| {
            let stat = std::fs::read_to_string(task.unwrap().path().join("stat")).unwrap_or_default();
            stat.rsplit(')').next().is_some_and(|rest| rest.starts_with(" T") || rest.starts_with(" Z"))
        })
    });
}

/// Protects: many random kills of several processes lose no finished result, repeat no more than what was running,
/// record nothing twice, and end in the bytes of an undisturbed run. (`scripts/torture.py` does the same for long.)
#[test]
fn many_kills_lose_nothing() {
    const WORKERS: usize = 3;
    const TIME: Duration = Duration::from_secs(8);
    let folder = Folder::with("study", &many());
    folder.ok("submit study.json");
    let mut draw = Draw(5);
    let start = || folder.start("work --threads 1 --max-crashes 1000");
    let mut workers: Vec<Running> = (0..WORKERS).map(|_| start()).collect();
    let mut kills = 0;
    let mut finished = BTreeMap::new();
    let begun = Instant::now();
    while begun.elapsed() < TIME && finished.len() < 60 {
        // Often enough for many kills before the last job on a fast machine, and not so often that none ends.
        std::thread::sleep(Duration::from_millis(draw.below(80)));
        let index = draw.below(WORKERS as u64) as usize;
        let killed = std::mem::replace(&mut workers[index], start());
        killed.signal("KILL");
        kills += u64::from(killed.end().0.is_none());
        let results = "SELECT key, wall_s FROM results AS r JOIN jobs AS j ON j.id = r.job_id";
        let now: BTreeMap<String, f64> = read(&folder, results).into_iter().collect();
        for (job, wall_s) in &finished {
            assert_eq!(now.get(job), Some(wall_s), "{job} was lost or done again");
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
    assert!(kills >= 10, "{kills} kills are no torture");
    let repeated = (attempts - jobs).unsigned_abs();
    let most = HELD * kills;
    assert!(repeated <= most, "{repeated} jobs were repeated after {kills} kills of one thread each");
    println!("{kills} kills, {repeated} jobs repeated, {jobs} jobs");
}

/// Protects: a worker that is told to stay takes up what is submitted while it is idle, and ends by itself when nothing
/// has come for as long as it was told.
#[test]
fn an_idle_worker_takes_up_what_comes() {
    let folder = Folder::with("first", &small(&json!({ "mu": [0.2, 0.3] })));
    folder.add("second", &small(&json!({ "mu": [0.4, 0.5] })));
    folder.ok("submit first.json");
    let worker = folder.start("work --idle-exit 3s");
    folder.wait_for("first", |jobs| jobs["done"] == 2);
    // It is idle for a moment.
    std::thread::sleep(Duration::from_millis(700));
    folder.ok("submit second.json");
    folder.wait_for("second", |jobs| jobs["done"] == 2);
    let (code, _, err) = worker.end();
    assert_eq!(code, Some(0), "{err}");
    let assert = folder.command("work --idle-exit soon").assert().code(2);
    assert!(stderr(&assert).contains("expected a duration such as 60s"), "{}", stderr(&assert));
}

/// Protects: a worker that was told how long to stay does not wait for what others run while they are there, and says
/// so; one that is still there takes over from one that died.
#[test]
fn an_idle_worker_waits_for_no_straggler() {
    let mut study = long();
    study["grid"] = json!({ "mu": [0.2, 0.4] });
    study["run"]["limit_s"] = json!(2.0);
    let folder = Folder::with("study", &study);
    folder.ok("submit study.json");
    let straggler = folder.start("work --threads 1");
    folder.wait_for("study", |jobs| jobs["running"] == 2);
    straggler.signal("STOP");
    stopped(&straggler);
    let (code, _, messages) = folder.start("work --idle-exit 1s").end();
    assert_eq!(code, Some(0), "{messages}");
    assert!(messages.contains("other workers run 2 jobs"), "{messages}");

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

/// Protects: an idle worker is stopped by Ctrl-C at once, and nothing is left over.
#[cfg(target_os = "linux")]
#[test]
fn an_idle_worker_can_be_stopped() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    folder.ok("submit mine.json");
    let worker = folder.start("work --idle-exit 1h");
    folder.wait_for("mine", |jobs| jobs["done"] == 1);
    std::thread::sleep(Duration::from_millis(700));
    worker.signal("INT");
    let (code, _, err) = worker.end();
    assert_eq!(code, Some(0), "{err}");
}

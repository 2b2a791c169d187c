//! Full and read-only disks, locks and damaged files: the command ends with a message that says what to do, and no result
//! is lost.
#![cfg(unix)]

use std::fs;

use serde_json::{Value, json};
use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions, SqliteConnection};

use crate::cli::support::{Folder, long, small, stderr, stdout, wait, without_wall_times};
use crate::mount::Mount;

fn undisturbed(study: &Value) -> String {
    let folder = Folder::with("study", study);
    folder.ok("run study.json");
    without_wall_times(&folder.ok("export study"))
}

/// Asserts that the command fails with a message.
fn assert_refused(folder: &Folder, arguments: &str, expected: &str) {
    let message = stderr(&folder.command(arguments).assert().code(2));
    assert!(message.contains(expected), "{arguments}: {message}");
    assert!(!message.contains("panicked"), "{message}");
}

/// Protects: when the disk fills up, the work ends with a message that says so. When there is room again, the same command
/// runs the other jobs.
#[test]
fn a_disk_that_fills_up() {
    let folder = Folder::new();
    let Some(_mount) = Mount::new(&folder.path(""), "size=4M") else { return };
    let mut study = long();
    study["run"]["limit_s"] = json!(0.25);
    folder.add("study", &study);
    folder.ok("submit study.json");
    let work = folder.start("work --threads 1");
    folder.wait_for("study", |counts| counts["running"] > 0);
    let filler = folder.path("filler");
    // This is more than the free space.
    let _ = fs::write(&filler, vec![0; 5_000_000]);
    let (code, _, message) = work.end();
    assert_eq!(code, Some(2), "{message}");
    assert!(message.contains("the disk of the database is full"), "{message}");
    assert_refused(&folder, "work", "the disk of the database is full");
    fs::remove_file(&filler).unwrap();
    folder.ok("work");
    assert_eq!(without_wall_times(&folder.ok("export study")), undisturbed(&study));
}

/// Protects: a disk with room for results but not for checkpoints does not stop a sweep.
#[test]
fn a_disk_that_is_too_small_for_checkpoints() {
    let folder = Folder::new();
    let Some(_mount) = Mount::new(&folder.path(""), "size=1500k") else { return };
    // A checkpoint takes a megabyte.
    let mut study = small(&json!({ "mu": [0.2, 0.4], "omega_rpm": [7, 20] }));
    study["scene"]["pin"]["elements"] = json!([24, 30, 20]);
    study["run"] = json!({ "limit_s": 0.002, "stop_early": false });
    folder.add("study", &study);
    folder.ok("submit study.json");
    let (code, _, message) = folder.start("work --checkpoint-every 0.05").end();
    assert_eq!(code, Some(0), "{message}");
    assert!(
        message.contains("the state of running jobs cannot be stored: the disk of the database is full"),
        "{message}"
    );
    assert_eq!(folder.counts("study")["done"], 4);
}

/// Protects: a database on a read-only disk can be read, and a command that has to write says why it cannot. The sweep
/// continues when the disk can be written.
#[test]
fn a_read_only_disk() {
    let folder = Folder::new();
    let Some(mount) = Mount::new(&folder.path(""), "size=50M") else { return };
    folder.add("study", &long());
    folder.ok("submit study.json");
    mount.remount("ro");
    assert_eq!(folder.counts("study")["pending"], 24);
    assert_refused(&folder, "work", "Read-only file system");
    assert_refused(&folder, "cancel study", "Read-only file system");
    mount.remount("rw");
    folder.ok("work");
    let export = folder.ok("export study");
    mount.remount("ro");
    assert_eq!(folder.ok("export study"), export);
    assert_eq!(without_wall_times(&export), undisturbed(&long()));
}

/// Locks the database as another program does, until the returned connection rolls its transaction back.
async fn lock(folder: &Folder) -> SqliteConnection {
    let options = SqliteConnectOptions::new().filename(folder.path("tribosweep.db"));
    let mut other = options.connect().await.unwrap();
    sqlx::raw_sql("BEGIN IMMEDIATE").execute(&mut other).await.unwrap();
    other
}

async fn unlock(mut other: SqliteConnection) {
    sqlx::raw_sql("ROLLBACK").execute(&mut other).await.unwrap();
}

/// Protects: a worker that starts while another program has a lock on the database waits for it. After a quarter of its
/// lease it gives up and says why. Meanwhile the database can be read.
#[tokio::test]
async fn a_lock_is_waited_for() {
    let folder = Folder::with("study", &long());
    folder.ok("submit study.json");
    let other = lock(&folder).await;
    let patient = folder.start("work");
    // This worker came later and has the shortest lease. When it gives up, the other one has been waiting for longer.
    assert_refused(&folder, "work --lease 5s", "the database is locked");
    assert_eq!(folder.counts("study")["pending"], 24, "the database can still be read");
    unlock(other).await;
    let (code, _, messages) = patient.end();
    assert_eq!(code, Some(0), "{messages}");
    assert_eq!(without_wall_times(&folder.ok("export study")), undisturbed(&long()));
}

/// Protects: results that a worker computes while another program has a lock on the database are not lost: the worker says
/// that it waits, and stores them afterwards.
#[tokio::test]
async fn results_wait_for_a_lock() {
    let mut study = long();
    // Jobs still run when the lock comes, on a fast machine too.
    study["run"]["limit_s"] = json!(0.25);
    let folder = Folder::with("study", &study);
    folder.ok("submit study.json");
    let work = folder.start_with_messages_in("messages", "work --threads 1 --lease 5s");
    folder.wait_for("study", |counts| counts["running"] > 0);
    let other = lock(&folder).await;
    let before = folder.counts("study");
    assert!(before["running"] > 0, "{before:?}");
    // The worker writes to the database when a job has ended.
    wait("the message", || folder.read("messages").contains("waiting: the database is locked"));
    assert_eq!(folder.counts("study"), before, "nobody can write");
    unlock(other).await;
    assert_eq!(work.end().0, Some(0), "{}", folder.read("messages"));
    assert_eq!(without_wall_times(&folder.ok("export study")), undisturbed(&study));
}

/// Protects: commands that read or work on a damaged file say that it is damaged, and do not change it.
#[test]
fn a_damaged_file() {
    let folder = Folder::with("study", &long());
    folder.ok("run study.json");
    let path = folder.path("tribosweep.db");
    let mut bytes = fs::read(&path).unwrap();
    // The first pages, which hold the definitions of the tables, stay intact.
    let whole = bytes.len();
    bytes[whole / 3..whole / 3 * 2].fill(0xa5);
    fs::write(&path, &bytes).unwrap();
    let message = folder.command("doctor").assert().code(2);
    assert!(stdout(&message).contains("PROBLEM"), "{}", stdout(&message));
    for arguments in ["export study", "report study", "run study.json"] {
        assert_refused(&folder, arguments, "the database is damaged");
        assert_refused(&folder, arguments, "help: the database is tribosweep.db");
    }
    assert_eq!(fs::read(&path).unwrap(), bytes);
}

//! Full and read-only disks, locks and damage, as the command meets them: each ends in a message that says what to do,
//! and nothing is lost.
#![cfg(unix)]

use std::fs;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use sqlx::ConnectOptions;
use sqlx::sqlite::SqliteConnectOptions;

use crate::mount::Mount;
use crate::support::{Folder, long, small, stderr, stdout, without_wall_times};

fn undisturbed(study: &Value) -> String {
    let folder = Folder::with("study", study);
    folder.ok("run study.json");
    without_wall_times(&folder.ok("export study"))
}

/// Fails with a message.
fn refused(folder: &Folder, arguments: &str, message: &str) {
    let told = stderr(&folder.command(arguments).assert().code(2));
    assert!(told.contains(message), "{arguments}: {told}");
    assert!(!told.contains("panicked"), "{told}");
}

/// Protects: a disk that fills up in the middle ends the work with a message that says so; with room again the same
/// command does the rest.
#[test]
fn a_disk_that_fills_up() {
    let folder = Folder::new();
    let Some(_mount) = Mount::new(&folder.path(""), "size=4M") else { return };
    let mut study = long();
    study["run"]["limit_s"] = json!(1.0);
    folder.add("study", &study);
    folder.ok("submit study.json");
    let work = folder.start("work");
    folder.wait_for("study", |counts| counts["running"] > 0);
    let filler = folder.path("filler");
    // All that is left, and then some.
    let _ = fs::write(&filler, vec![0; 5_000_000]);
    let (code, _, told) = work.end();
    assert_eq!(code, Some(2), "{told}");
    assert!(told.contains("the disk of the database is full"), "{told}");
    refused(&folder, "work", "the disk of the database is full");
    fs::remove_file(&filler).unwrap();
    folder.ok("work");
    assert_eq!(without_wall_times(&folder.ok("export study")), undisturbed(&study));
}

/// Protects: a disk with room for results and none for the states of running jobs does not stop a sweep.
#[test]
fn a_disk_that_is_too_small_for_checkpoints() {
    let folder = Folder::new();
    let Some(_mount) = Mount::new(&folder.path(""), "size=1500k") else { return };
    // A state takes a megabyte.
    let mut study = small(&json!({ "mu": [0.2, 0.4], "omega_rpm": [7, 20] }));
    study["scene"]["pin"]["elements"] = json!([24, 30, 20]);
    study["run"] = json!({ "limit_s": 0.002, "stop_early": false });
    folder.add("study", &study);
    folder.ok("submit study.json");
    let (code, _, told) = folder.start("work --checkpoint-every 0.05").end();
    assert_eq!(code, Some(0), "{told}");
    assert!(
        told.contains("the state of running jobs cannot be stored: the disk of the database is full"),
        "{told}"
    );
    assert_eq!(folder.counts("study")["done"], 4);
}

/// Protects: a sweep on a disk that can only be read can be looked at, and says why it cannot be worked on; it goes on
/// where it can be written.
#[test]
fn a_disk_that_can_only_be_read() {
    let folder = Folder::new();
    let Some(mount) = Mount::new(&folder.path(""), "size=50M") else { return };
    folder.add("study", &long());
    folder.ok("submit study.json");
    mount.remount("ro");
    assert_eq!(folder.counts("study")["pending"], 24);
    refused(&folder, "work", "Read-only file system");
    refused(&folder, "cancel study", "Read-only file system");
    mount.remount("rw");
    folder.ok("work");
    let export = folder.ok("export study");
    mount.remount("ro");
    assert_eq!(folder.ok("export study"), export);
    assert_eq!(without_wall_times(&export), undisturbed(&long()));
}

/// Protects: a lock of another program is waited for; the work that goes on meanwhile is not lost.
#[tokio::test]
async fn a_lock_is_waited_for() {
    const KEPT: Duration = Duration::from_secs(1);
    let folder = Folder::with("study", &long());
    folder.ok("submit study.json");
    let options = SqliteConnectOptions::new().filename(folder.path("tribosweep.db"));
    let mut other = options.connect().await.unwrap();
    sqlx::raw_sql("BEGIN IMMEDIATE").execute(&mut other).await.unwrap();
    let (begun, work) = (Instant::now(), folder.start("work"));
    tokio::time::sleep(KEPT).await;
    assert_eq!(folder.counts("study")["pending"], 24, "reading goes on");
    sqlx::raw_sql("ROLLBACK").execute(&mut other).await.unwrap();
    assert_eq!(work.end().0, Some(0));
    assert!(begun.elapsed() > KEPT);
    assert_eq!(without_wall_times(&folder.ok("export study")), undisturbed(&long()));
}

/// Protects: a damaged file is called that by whoever reads or works, and the file stays as it is.
#[test]
fn a_damaged_file() {
    let folder = Folder::with("study", &long());
    folder.ok("run study.json");
    let path = folder.path("tribosweep.db");
    let mut bytes = fs::read(&path).unwrap();
    // All but the first pages, which hold the tables' definitions.
    let whole = bytes.len();
    bytes[whole / 3..whole / 3 * 2].fill(0xa5);
    fs::write(&path, &bytes).unwrap();
    let told = folder.command("doctor").assert().code(2);
    assert!(stdout(&told).contains("PROBLEM"), "{}", stdout(&told));
    for arguments in ["export study", "report study", "run study.json"] {
        refused(&folder, arguments, "the database is damaged");
    }
    assert_eq!(fs::read(&path).unwrap(), bytes);
}

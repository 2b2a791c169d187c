//! What happens to a database behind the program's back: it is moved, its folder becomes read-only, its disk fills up, and its
//! rows change.
#![cfg(target_os = "linux")]

use std::fs;
use std::os::unix::fs::PermissionsExt;

use serde_json::json;
use sqlx::ConnectOptions;
use sqlx::sqlite::SqliteConnectOptions;

use crate::cli::support::{Folder, LONG_JOBS, long, rows, small, stderr, stdout, without_wall_times};
use crate::mount::Mount;

async fn change(folder: &Folder, statement: &'static str) {
    let options = SqliteConnectOptions::new().filename(folder.path("tribosweep.db"));
    let mut other = options.connect().await.unwrap();
    sqlx::raw_sql(statement).execute(&mut other).await.unwrap();
}

/// Protects: a worker whose database is moved, deleted, and whose disk then fills up ends with 2 each time and says where the
/// results are; whoever follows that has the results of an undisturbed run. No result is claimed that is not there. (`scripts/torture.py
/// --places` is a longer version.)
#[test]
fn a_database_that_does_not_stay() {
    let calm = Folder::with("study", &long());
    calm.ok("run study.json");
    let folder = Folder::with("study", &long());
    let Some(mount) = Mount::new(&folder.path(""), "size=8M") else { return };
    folder.add("study", &long());
    folder.ok("submit study.json");
    let database = folder.path("tribosweep.db");
    let started = || {
        let work = folder.start("work --threads 1");
        let done = folder.counts("study")["done"];
        folder.wait_for("study", |counts| counts["done"] > done || counts["running"] > 0);
        work
    };
    // Moved.
    let work = started();
    fs::rename(&database, folder.path("moved.db")).unwrap();
    let (code, _, message) = work.end();
    assert_eq!(code, Some(2), "{message}");
    let moved = folder.path("moved.db").canonicalize().unwrap();
    assert!(message.contains(&format!("was moved to {}", moved.display())), "{message}");
    assert!(!folder.files().contains(&"tribosweep.db-wal".to_owned()), "{:?}", folder.files());
    fs::rename(&moved, &database).unwrap();
    // Deleted.
    let work = started();
    let before = folder.counts("study")["done"];
    for file in folder.files().into_iter().filter(|file| file.starts_with("tribosweep.db")) {
        fs::remove_file(folder.path(file)).unwrap();
    }
    let (code, _, message) = work.end();
    assert_eq!(code, Some(2), "{message}");
    assert!(message.contains("was deleted") && message.contains("tribosweep.db.rescued-1"), "{message}");
    fs::rename(folder.path("tribosweep.db.rescued-1"), &database).unwrap();
    assert!(folder.counts("study")["done"] >= before);
    // Full.
    let work = started();
    let _ = fs::write(folder.path("filler"), vec![0; 9_000_000]);
    let (code, _, message) = work.end();
    // All jobs may have ended just before.
    assert!(code == Some(2) && message.contains("is full") || code == Some(0), "{code:?} {message}");
    mount.remount("size=20M");
    folder.ok("work");
    assert_eq!(folder.counts("study")["done"], LONG_JOBS);
    assert_eq!(without_wall_times(&folder.ok("export study")), without_wall_times(&calm.ok("export study")));
}

/// Protects: in a folder that cannot be written, a worker ends with 2 and says why, and what is done can be read.
#[test]
fn a_folder_that_becomes_read_only() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.2, 0.4] })));
    folder.ok("run study.json");
    folder.add("study", &small(&json!({ "mu": [0.2, 0.3, 0.4] })));
    folder.ok("submit study.json");
    let path = folder.path("");
    // The other user may have no access to the folder of the program.
    fs::copy(crate::cli::support::TRIBOSWEEP, path.join("program")).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o555)).unwrap();
    fs::set_permissions(folder.path("tribosweep.db"), fs::Permissions::from_mode(0o444)).unwrap();
    fs::set_permissions(folder.path("tribosweep.db.lock"), fs::Permissions::from_mode(0o444)).unwrap();
    // Root may write everywhere, so the commands are those of another user.
    let run = |arguments: &str| {
        let mut command = std::process::Command::new("setpriv");
        command.args(["--reuid", "65534", "--regid", "65534", "--clear-groups", "./program"]);
        command.args(arguments.split(' ')).current_dir(&path).env_remove("TRIBOSWEEP_DB");
        command.output()
    };
    let Ok(work) = run("work") else { return crate::tools::missing("no setpriv", "install util-linux") };
    if String::from_utf8_lossy(&work.stderr).contains("setpriv") {
        return crate::tools::missing("setpriv is refused", "run the tests as root");
    }
    assert_eq!(work.status.code(), Some(2), "{work:?}");
    let message = String::from_utf8(work.stderr).unwrap();
    assert!(message.contains("Permission denied") || message.contains("cannot be written"), "{message}");
    let export = run("export study").unwrap();
    assert_eq!(export.status.code(), Some(0), "{export:?}");
    assert_eq!(String::from_utf8(export.stdout).unwrap(), folder.ok("export study"));
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
}

/// Protects: a result in which one digit was changed, and one that cannot be parsed, are in no table: they are named, the others
/// are exported and reported, and the exit code is 1. The deep examination names them too. `retry --unreadable` runs them again,
/// and then all is as before.
#[tokio::test]
async fn damaged_results() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.2, 0.3, 0.4] })));
    folder.ok("run study.json");
    let before = folder.ok("export study");
    let jobs: Vec<String> = rows(&before).iter().map(|row| row["job"].clone()).collect();
    change(
        &folder,
        "UPDATE results SET record = replace(record, '\"mu_star\":0.', '\"mu_star\":1.') WHERE job_id = 1",
    )
    .await;
    change(&folder, "UPDATE results SET record = 'x', digest = NULL WHERE job_id = 2").await;
    for command in ["export study", "export study --all --format json", "report study"] {
        let assert = folder.command(command).assert().code(1);
        let message = stderr(&assert);
        for (job, reason) in [(&jobs[0], "does not have its digest"), (&jobs[1], "cannot be read")] {
            assert!(
                message.contains(&format!("job {job} of study: ")) && message.contains(reason),
                "{message}"
            );
        }
        assert!(message.contains("retry STUDY --unreadable"), "{message}");
    }
    let export = stdout(&folder.command("export study").assert().code(1));
    let states: Vec<_> =
        rows(&export).iter().map(|row| (row["status"].clone(), row["mu_star"].clone())).collect();
    let unreadable = ("unreadable".to_owned(), String::new());
    assert_eq!(states[..2], [unreadable.clone(), unreadable]);
    assert_eq!(states[2].1, rows(&before)[2]["mu_star"]);
    assert!(folder.read("reports/study/report.md").contains("does not have its digest"));
    let shown: serde_json::Value =
        serde_json::from_str(&folder.ok(&format!("show {} --json", jobs[0]))).unwrap();
    assert!(shown["record"].is_null() && shown["unreadable"].is_string(), "{shown}");
    let deep = stdout(&folder.command("doctor --deep").assert().code(2));
    let line = deep.lines().find(|line| line.contains("results ")).unwrap();
    assert!(line.starts_with("PROBLEM") && line.contains("3 read, 1 without a digest"), "{deep}");
    assert!(line.contains(&format!("damaged: 1 ({})", jobs[0])) && line.contains(&jobs[1]), "{deep}");
    folder.command("doctor").assert().code(0);
    let again = stderr(&folder.command("retry study --unreadable").assert().code(0));
    assert!(again.contains("makes 2 jobs pending again"), "{again}");
    folder.ok("work");
    assert_eq!(without_wall_times(&folder.ok("export study")), without_wall_times(&before));
    folder.ok("doctor --deep");
    let again = stderr(&folder.command("retry study --unreadable").assert().code(0));
    assert!(again.contains("makes 0 jobs pending again"), "{again}");
}

/// Protects: a specification that is not that of its job's key is found by the deep examination; its job fails, and has its
/// own result when the study is submitted again.
#[tokio::test]
async fn damaged_specifications() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.2, 0.3] })));
    folder.ok("submit study.json");
    change(
        &folder,
        "UPDATE payloads SET payload = (SELECT payload FROM payloads WHERE job_id = 2) WHERE job_id = 1",
    )
    .await;
    let deep = stdout(&folder.command("doctor --deep").assert().code(2));
    assert!(deep.contains("2 read, changed, so that they are not those of their keys: 1 ("), "{deep}");
    // The parameters of a row are written anew with the study.
    change(&folder, "UPDATE study_jobs SET parameters = 'x' WHERE ordinal = 1").await;
    let deep = stdout(&folder.command("doctor --deep").assert().code(2));
    assert!(deep.contains("2 rows read, damaged: 1 of study"), "{deep}");
    let failed = stderr(&folder.command("work").assert().code(1));
    assert!(failed.contains("submit the study again, then `tribosweep retry` it"), "{failed}");
    folder.ok("submit study.json");
    folder.ok("retry study");
    folder.ok("work");
    let calm = Folder::with("study", &small(&json!({ "mu": [0.2, 0.3] })));
    calm.ok("run study.json");
    assert_eq!(without_wall_times(&folder.ok("export study")), without_wall_times(&calm.ok("export study")));
}

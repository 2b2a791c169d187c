//! A sweep that is interrupted continues where it stopped and ends with the same bytes, however it was interrupted.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::cli::support::{Folder, LONG_JOBS, Running, long, rows, wall_times, without_wall_times};

/// The export of the study without an interruption, without wall times.
fn undisturbed() -> &'static str {
    static EXPORT: OnceLock<String> = OnceLock::new();
    EXPORT.get_or_init(|| {
        let folder = Folder::with("study", &long());
        folder.ok("run study.json --threads 2");
        without_wall_times(&folder.ok("export study"))
    })
}

/// Starts the sweep and returns when some of its jobs are done.
fn in_the_middle(threads: usize) -> (Folder, Running) {
    let folder = Folder::with("study", &long());
    let run = folder.start(&format!("run study.json --threads {threads}"));
    folder.wait_for("study", |counts| counts["done"] > 0);
    (folder, run)
}

/// Asserts that the sweep is partly done and consistent: some but not all jobs have results, and no line or file is
/// incomplete. Returns the wall times of the finished jobs.
fn assert_partly_done(folder: &Folder) -> BTreeMap<String, String> {
    let export = folder.ok("export study");
    let rows = rows(&export);
    let (done, others): (Vec<_>, Vec<_>) = rows.iter().partition(|row| !row["mu_star"].is_empty());
    assert!(!done.is_empty() && !others.is_empty(), "{export}");
    for row in others {
        assert!(["pending", "running"].contains(&row["status"].as_str()), "{row:?}");
        assert!(row["wall_s"].is_empty() && row["error"].is_empty(), "{row:?}");
    }
    // Finished jobs have the results of the uninterrupted sweep.
    for line in without_wall_times(&export).lines().filter(|line| !line.contains("pending,,")) {
        assert!(line.contains("running,,") || undisturbed().lines().any(|other| other == line), "{line}");
    }
    let temporary = |file: &String| file.contains(".partial") || file.contains(".tmp");
    let left: Vec<_> = folder.files().into_iter().filter(temporary).collect();
    assert!(left.is_empty(), "{left:?}");
    wall_times(&export)
}

/// Asserts that the sweep is complete with the same bytes, and that the jobs in `before` were not run again.
fn assert_complete(folder: &Folder, before: &BTreeMap<String, String>) {
    let export = folder.ok("export study");
    assert_eq!(without_wall_times(&export), undisturbed());
    let after = wall_times(&export);
    assert_eq!(after.len() as u64, LONG_JOBS);
    for (job, wall_s) in before {
        assert_eq!(&after[job], wall_s, "{job} was run again");
    }
}

/// Sends a signal that asks to stop. Asserts exit code 3, that running jobs are back in the queue, and that the report has
/// the finished jobs.
fn stop(folder: &Folder, run: Running, signal: &str) -> BTreeMap<String, String> {
    run.signal(signal);
    let (code, table, messages) = run.end();
    assert_eq!(code, Some(3), "{messages}");
    assert!(messages.contains("running jobs go back to the queue"), "{messages}");
    assert!(messages.contains("run the same command again"), "{messages}");
    assert!(table.contains("\n| ω [rpm] |") && table.contains('–'), "{table}");
    assert!(folder.read("reports/study/report.md").contains("This report is incomplete"));
    let counts = folder.counts("study");
    assert_eq!((counts["running"], counts["failed"], counts["total"]), (0, 0, LONG_JOBS), "{counts:?}");
    assert!(counts["done"] > 0 && counts["pending"] > 0, "{counts:?}");
    let before = assert_partly_done(folder);
    assert_eq!(before.len() as u64, counts["done"]);
    before
}

/// Protects: after Ctrl-C the same command continues the sweep.
#[test]
fn ctrl_c_and_run_again() {
    let (folder, run) = in_the_middle(1);
    let before = stop(&folder, run, "INT");
    folder.ok("run study.json --threads 2");
    assert_complete(&folder, &before);
    assert!(!folder.read("reports/study/report.md").contains("incomplete"));
}

/// Protects: after the SIGTERM of a batch system `work` continues the sweep.
#[test]
fn sigterm_and_work() {
    let (folder, run) = in_the_middle(2);
    let before = stop(&folder, run, "TERM");
    folder.ok("work --threads 1");
    assert_complete(&folder, &before);
}

/// Protects: `work` can be interrupted by Ctrl-C twice in a row, each time with the code for jobs that are left.
#[test]
fn work_is_interrupted_and_continued() {
    let folder = Folder::with("study", &long());
    folder.ok("submit study.json");
    let mut before = BTreeMap::new();
    for done in [1, 3] {
        let work = folder.start("work --threads 1");
        // A process that runs jobs handles signals already.
        folder.wait_for("study", |counts| counts["done"] >= done && counts["running"] > 0);
        work.signal("INT");
        let (code, out, messages) = work.end();
        assert_eq!((code, out.as_str()), (Some(3), ""), "{messages}");
        let now = assert_partly_done(&folder);
        assert!(before.iter().all(|(job, wall_s)| now[job] == *wall_s), "{before:?} {now:?}");
        before = now;
    }
    folder.ok("work --threads 2");
    assert_complete(&folder, &before);
}

/// Protects: a process that is killed leaves a consistent database. The next one takes its jobs back, says so, and ends
/// with the same bytes.
#[test]
fn a_killed_process_loses_nothing() {
    let (folder, run) = in_the_middle(2);
    run.signal("KILL");
    let (code, table, _) = run.end();
    assert_eq!((code, table.as_str()), (None, ""));
    let counts = folder.counts("study");
    assert!(counts["running"] > 0 && counts["done"] > 0 && counts["done"] < LONG_JOBS, "{counts:?}");
    let before = assert_partly_done(&folder);
    let (code, _, messages) = folder.start("run study.json --threads 2").end();
    assert_eq!(code, Some(0), "{messages}");
    let taken = format!("{} jobs left running by an interrupted process were taken back", counts["running"]);
    assert!(messages.contains(&taken), "{messages}");
    assert_complete(&folder, &before);
}

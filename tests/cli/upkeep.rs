//! Maintenance of studies and their database: retry, cancel, rm, gc, doctor, show, priorities.

use serde_json::{Value, json};

use crate::cli::support::{Folder, diverging, rows, small, stderr, stdout};

/// Protects: cancelled jobs are not run and are counted as cancelled. `retry` or another submission makes them pending.
#[test]
fn cancelled_jobs_are_not_run_until_requested() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4] })));
    folder.ok("submit mine.json");
    let cancelled = folder.command("cancel mine").assert().code(0);
    assert!(stderr(&cancelled).contains("mine: 2 pending jobs cancelled; `tribosweep retry mine`"));
    folder.ok("work");
    assert_eq!(folder.counts("mine")["cancelled"], 2);
    assert!(folder.ok("status mine").contains("0 pending, 2 cancelled"));
    assert!(rows(&folder.ok("export mine")).iter().all(|row| row["status"] == "cancelled"));
    let retried = folder.command("retry mine.json").assert().code(0);
    assert!(stderr(&retried).contains("0 failed jobs and 2 cancelled jobs pending again"));
    folder.ok("cancel mine");
    folder.ok("run mine.json");
    assert_eq!(folder.counts("mine")["done"], 2);
}

/// Protects: `retry --failed` runs failed jobs again and no others.
#[test]
fn failed_jobs_are_retried() {
    let folder = Folder::with("bad", &diverging(&[0.2]));
    folder.command("run bad.json").assert().code(1);
    let done = |export: &str| rows(export)[0]["wall_s"].clone();
    let before = done(&folder.ok("export bad"));
    folder.ok("retry bad --failed");
    assert_eq!(folder.counts("bad")["pending"], 1);
    folder.command("work").assert().code(1);
    let export = folder.ok("export bad");
    assert_eq!(done(&export), before);
    let shown: Value =
        serde_json::from_str(&folder.ok(&format!("show {} --json", rows(&export)[1]["job"]))).unwrap();
    assert_eq!((shown["state"].as_str(), shown["attempt"].as_u64()), (Some("failed"), Some(2)));
}

/// Protects: the results of a removed study stay in the database until `gc`, which prints how many it deleted.
#[test]
fn removed_studies_leave_no_garbage() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4] })));
    folder.add("other", &small(&json!({ "mu": [0.4] })));
    folder.ok("run mine.json");
    folder.ok("submit other.json");
    folder.ok("rm mine");
    folder.command("status mine").assert().code(2);
    let collected = folder.ok("gc");
    assert!(collected.starts_with("dropped 1 job, 1 result and "), "{collected}");
    assert!(folder.ok("gc").starts_with("dropped 0 jobs, 0 results and 0 "));
    assert_eq!(folder.counts("other")["done"], 1, "the job is shared with the removed study");
    assert_eq!(folder.command("rm mine").assert().get_output().status.code(), Some(2));
}

/// Protects: the priority counts more than the cost: the urgent study is run first, although its job is the cheapest.
#[test]
fn an_urgent_study_goes_first() {
    let folder = Folder::with("slow", &small(&json!({ "mu": [0.2, 0.3] })));
    let mut cheap = small(&json!({ "mu": [0.4] }));
    cheap["run"]["limit_s"] = json!(0.006);
    // A thread advances jobs of one model together. With another time step this job has a model of its own.
    cheap["numerics"] = json!({ "safety_factor": 0.9 });
    folder.add("urgent", &cheap);
    folder.ok("submit slow.json --priority -3");
    folder.ok("submit urgent.json");
    folder.ok("work --threads 1");
    let ended = |study: &str| {
        let jobs = rows(&folder.ok(&format!("export {study}")));
        let shown =
            |job: &str| serde_json::from_str::<Value>(&folder.ok(&format!("show {job} --json"))).unwrap();
        jobs.iter().map(|row| shown(&row["job"])["finished_ms"].as_i64().unwrap()).collect::<Vec<_>>()
    };
    assert!(ended("urgent")[0] <= *ended("slow").iter().min().unwrap());
}

/// Protects: `show` has the provenance of a result, and accepts the first characters of a key if they are unique.
#[test]
fn results_have_a_provenance() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4] })));
    folder.ok("run mine.json --threads 2");
    let job = rows(&folder.ok("export mine"))[0]["job"].clone();
    let shown: Value = serde_json::from_str(&folder.ok(&format!("show {} --json", &job[..10]))).unwrap();
    assert_eq!(shown["job"].as_str(), Some(job.as_str()));
    let study = &shown["studies"][0];
    let submitted: Value = serde_json::from_str(&folder.read("mine.json")).unwrap();
    assert_eq!((&study["name"], &study["document"]), (&json!("mine"), &submitted));
    let provenance = &shown["provenance"];
    assert_eq!(provenance["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(provenance["threads"], 2);
    for field in ["commit", "host", "vectors"] {
        assert!(!provenance[field].as_str().unwrap().is_empty(), "{provenance}");
    }
    assert!(shown["started_ms"].as_i64().unwrap() <= shown["finished_ms"].as_i64().unwrap());
    let several = folder.command("show").arg("").assert().code(2);
    assert!(stderr(&several).contains("several jobs have keys that begin with"), "{}", stderr(&several));
    let none = folder.command("show zz").assert().code(2);
    assert!(stderr(&none).contains("no job has a key that begins with `zz`"), "{}", stderr(&none));
}

/// Protects: `doctor` finds no problem in a healthy database. A file that is not a database is a problem with exit code 2,
/// and so is a missing file.
#[test]
fn doctor_finds_problems() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4] })));
    folder.ok("run mine.json");
    let healthy = folder.ok("doctor");
    for subject in ["SQLite", "journal", "synchronous", "integrity", "references", "leases", "worker"] {
        let line = healthy
            .lines()
            .find(|line| line.contains(subject))
            .unwrap_or_else(|| panic!("{subject}: {healthy}"));
        assert!(line.starts_with("ok "), "{line}");
    }
    assert!(healthy.contains("wal") && healthy.contains("normal"), "{healthy}");
    folder.write("text.db", &"this is no database ".repeat(100));
    let ill = folder.command("doctor --db text.db").assert().code(2);
    assert!(stdout(&ill).contains("PROBLEM  opens"), "{}", stdout(&ill));
    let missing = folder.command("doctor --db none.db").assert().code(2);
    assert!(stderr(&missing).contains("no database at none.db"), "{}", stderr(&missing));
}

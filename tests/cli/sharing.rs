//! No job is simulated twice.

use serde_json::json;

use crate::cli::support::{Folder, rows, small, stderr, wall_times};

/// Protects: a repeated submission adds no jobs, and a repeated run simulates nothing: the wall times are those of the first
/// run.
#[test]
fn a_repeated_run_costs_nothing() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4], "omega_rpm": [2, 7] })));
    folder.ok("submit mine.json");
    let again = folder.command("submit mine.json").assert().code(0);
    assert_eq!(stderr(&again), "mine: 4 jobs, 0 new, 0 already done\n");
    let first = folder.ok("run mine.json");
    let export = folder.ok("export mine");
    assert_eq!(wall_times(&export).len(), 4);

    let again = folder.command("run mine.json").assert().code(0);
    assert!(stderr(&again).starts_with("mine: 4 jobs, 0 new, 4 already done\n"), "{}", stderr(&again));
    assert_eq!(folder.ok("run mine.json"), first);
    folder.ok("work");
    assert_eq!(folder.ok("export mine"), export);
}

/// Protects: studies whose grids overlap share jobs, whether a parameter is in the grid or in the scene.
#[test]
fn overlapping_studies_share_jobs() {
    let folder = Folder::with("first", &small(&json!({ "mu": [0.4], "omega_rpm": [2, 7] })));
    // The same jobs at ω = 7, which is in the grid of one study and in the scene of the other.
    let mut second = small(&json!({ "mu": [0.4, 0.2] }));
    second["scene"]["disk"] = json!({ "omega_rpm": 7.0 });
    folder.add("second", &second);
    folder.ok("run first.json");
    let submitted = folder.command("submit second.json").assert().code(0);
    assert_eq!(stderr(&submitted), "second: 2 jobs, 1 new, 1 already done\n");
    let before = wall_times(&folder.ok("export first"));
    folder.ok("run second.json");

    let first = rows(&folder.ok("export first"));
    let second = rows(&folder.ok("export second"));
    let (own, other) = (&first[1], &second[0]);
    assert_eq!((own["omega_rpm"].as_str(), own["mu"].as_str()), ("7", "0.4"));
    assert_eq!((other["omega_rpm"].as_str(), other["mu"].as_str()), ("7", "0.4"));
    assert_eq!(own["job"], other["job"]);
    assert_eq!(other["wall_s"], before[&own["job"]]);
    assert_ne!(second[1]["job"], first[0]["job"]);
}

/// Protects: a study that is changed and submitted again has its new jobs and keeps the results of the old ones.
#[test]
fn a_larger_study_simulates_only_new_jobs() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2], "omega_rpm": [2, 7] })));
    folder.ok("run mine.json");
    let before = wall_times(&folder.ok("export mine"));
    folder.add("mine", &small(&json!({ "mu": [0.2], "omega_rpm": [2, 5, 7] })));
    let run = folder.command("run mine.json").assert().code(0);
    assert!(stderr(&run).contains("\nmine: 3 jobs, 1 new, 2 already done\n"), "{}", stderr(&run));
    let after = wall_times(&folder.ok("export mine"));
    assert_eq!(after.len(), 3);
    assert!(before.iter().all(|(job, wall_s)| after[job] == *wall_s), "{before:?} {after:?}");
}

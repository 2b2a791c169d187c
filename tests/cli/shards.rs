//! A study in shards, and merging and copying databases.

use serde_json::json;

use crate::cli::support::{Folder, rows, small, stderr, without_wall_times};

/// Protects: a study that is submitted, run and merged in shards has the results of the whole study, byte for byte except
/// for run times. Merging again changes nothing, and jobs that no shard has run are still pending. A shard has a report of
/// its own jobs.
#[test]
fn shards_are_the_whole_study() {
    let study = small(&json!({ "mu": [0.2, 0.3, 0.4], "omega_rpm": [5, 20] }));
    let folder = Folder::with("study", &study);
    folder.ok("run study.json --db whole.db");
    let whole = folder.ok("export study --db whole.db");
    for shard in 1..=4 {
        folder.ok(&format!("submit study.json --shard {shard}/4 --db {shard}.db"));
        if shard < 4 {
            folder.ok(&format!("work --db {shard}.db"));
        }
    }
    let merged = folder.ok("merge 1.db 2.db 3.db 4.db --db merged.db");
    assert!(merged.lines().last().unwrap().contains("still to be run: 1"), "{merged}");
    let partly = folder.ok("export study --db merged.db");
    assert_eq!(rows(&partly).iter().filter(|row| row["status"] == "pending").count(), 1);
    folder.ok("work --db merged.db");
    let done = folder.ok("export study --db merged.db");
    assert_eq!(without_wall_times(&done), without_wall_times(&whole));
    folder.ok("merge 1.db 4.db --db merged.db");
    assert_eq!(folder.ok("export study --db merged.db"), done);
    folder.ok("report study --db 1.db --out part");
    assert!(folder.read("part/report.md").contains("jobs done: 2 of 2"), "{}", folder.read("part/report.md"));
}

/// Protects: wrong shards and databases that cannot be merged are refused before anything is written.
#[test]
fn wrong_shards_and_databases_are_refused() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.2, 0.3] })));
    for shard in ["0/2", "3/2", "1", "1/0", "a/b", "1/2/3", "-1/2"] {
        let message = stderr(&folder.command(&format!("submit study.json --shard={shard}")).assert().code(2));
        assert!(message.contains("1/4"), "{shard}: {message}");
    }
    assert!(!folder.path("tribosweep.db").exists());
    folder.ok("submit study.json --db a.db");
    let message = stderr(&folder.command("merge a.db missing.db --db b.db").assert().code(2));
    assert!(message.contains("missing.db") && !folder.path("b.db").exists(), "{message}");
    let message = stderr(&folder.command("copy --from a.db --to ./a.db").assert().code(2));
    assert!(message.contains("both"), "{message}");
    let message = stderr(&folder.command("copy other --from a.db --to b.db").assert().code(2));
    assert!(message.contains("no study `other`"), "{message}");
    folder.add("study", &small(&json!({ "mu": [0.5] })));
    folder.ok("submit study.json --db b.db");
    let message = stderr(&folder.command("copy --from a.db --to b.db").assert().code(2));
    assert!(message.contains("another one"), "{message}");
}

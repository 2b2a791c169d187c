//! A result depends only on the job, not on the number of threads, the order, or the other jobs.

use serde_json::{Value, json};

use crate::cli::support::{Folder, rows, small, without_wall_times};

/// Protects: except for wall times the export on several threads is the same as on one, byte for byte.
#[test]
fn threads_change_no_byte() {
    let export = |threads: usize| {
        let folder = Folder::new();
        folder.write("mini.json", include_str!("../../studies/mini.json"));
        folder.ok(&format!("run mini.json --threads {threads}"));
        without_wall_times(&folder.ok("export mini"))
    };
    let one = export(1);
    assert_eq!(rows(&one).len(), 6);
    assert!(rows(&one).iter().all(|row| !row["mu_star"].is_empty()));
    assert_eq!(export(2), one);
    assert_eq!(export(5), one);
}

/// Protects: the same for jobs that start from the limit cycle of a coarser mesh. `show` and the export say what they started
/// from.
#[test]
fn threads_change_no_byte_after_a_coarser_mesh() {
    let study = json!({
        "name": "nested",
        "scene": { "pin": { "elements": [12, 12, 11] }, "clamp": { "width_m": 0.002 } },
        "run": { "limit_s": 0.004 },
        "detection": { "cycles": 4, "tolerance": 0.3, "drift_tolerance": 0.2 },
        "grid": { "mu": [0.1, 0.4], "omega_rpm": [7, 20], "start": ["rest", "nested"] }
    });
    let export = |threads: usize| {
        let folder = Folder::with("nested", &study);
        folder.ok(&format!("run nested.json --threads {threads}"));
        let all = folder.ok("export nested --all");
        for row in rows(&all) {
            let shown = folder.ok(&format!("show {}", row["job"]));
            let is_nested = row["start"] == "nested";
            assert_eq!(
                (!row["start_outcome"].is_empty(), shown.contains("start_outcome")),
                (is_nested, is_nested)
            );
        }
        without_wall_times(&folder.ok("export nested"))
    };
    let one = export(1);
    assert_eq!(rows(&one).len(), 8);
    assert_eq!(export(3), one);
}

/// Protects: a job's figures do not depend on which other jobs are in the study, nor in which order.
#[test]
fn other_jobs_change_no_byte() {
    let lines = |grid: &Value| {
        let folder = Folder::with("mine", &small(grid));
        folder.ok("run mine.json");
        let export = without_wall_times(&folder.ok("export mine"));
        let mut lines: Vec<_> = export.lines().map(str::to_owned).collect();
        lines.sort();
        lines
    };
    let all = lines(&json!({ "mu": [0.2, 0.4], "omega_rpm": [2, 7] }));
    assert_eq!(all.len(), 5);
    assert_eq!(lines(&json!({ "mu": [0.4, 0.2], "omega_rpm": [7, 2] })), all);
    for line in lines(&json!({ "mu": [0.4], "omega_rpm": [7] })) {
        assert!(all.contains(&line), "{line}");
    }
}

//! A result depends only on the job, not on the number of threads, the order, or the other jobs.

use serde_json::{Value, json};

use crate::support::{Folder, rows, small, without_wall_times};

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

//! `report --watch`: a report that is updated while its study runs.

use serde_json::json;

use crate::cli::support::{Folder, LONG_JOBS, long, small, stderr, stdout, wait};

const REFRESH: &str = "http-equiv=\"refresh\"";

/// Protects: while another process works, the page is updated and reloads itself. When no job is left, the page is complete
/// and does not reload itself any more, and the command ends.
#[test]
fn a_watched_report_is_updated() {
    let folder = Folder::with("long", &long());
    folder.ok("submit long.json");
    let watching = folder.start("report long --watch 1 --out out");
    let page = || std::fs::read_to_string(folder.path("out/report.html")).unwrap_or_default();
    wait("the first page", || page().contains(REFRESH));
    assert!(page().contains(&format!("{LONG_JOBS} of {LONG_JOBS} jobs are missing")));
    folder.ok("work");
    let (code, stdout, stderr) = watching.end();
    assert_eq!((code, stdout.trim_end()), (Some(0), "out/report.html"), "{stderr}");
    assert!(stderr.matches("report written").count() >= 2, "{stderr}");
    let page = page();
    assert!(page.contains(&format!("{LONG_JOBS} of {LONG_JOBS}")) && !page.contains("incomplete"));
    assert!(!page.contains(REFRESH));
}

/// Protects: a report is not written again while its study does not change, whatever happens to other studies of the
/// database. After an interruption the page does not reload itself any more.
#[test]
fn an_interrupted_watch_ends_the_reloading() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4] })));
    folder.ok("submit mine.json");
    let watching = folder.start("report mine --watch 1 --out out");
    let page = |out: &str| folder.path(out).join("report.html");
    let refreshes = |out: &str| std::fs::read_to_string(page(out)).is_ok_and(|page| page.contains(REFRESH));
    wait("the first page", || refreshes("out"));
    // Other studies are the clock: when a watch with the same interval that began later has seen that its study is
    // finished, this watch has looked at its own study too.
    for (other, mu) in [("second", 0.3), ("third", 0.5)] {
        folder.add(other, &small(&json!({ "mu": [mu] })));
        folder.ok(&format!("submit {other}.json"));
        let clock = folder.start(&format!("report {other} --watch 1 --out {other}"));
        wait("the first page of the other study", || refreshes(other));
        folder.ok(&format!("run {other}.json"));
        let (code, _, stderr) = clock.end();
        assert_eq!(code, Some(0), "{stderr}");
    }
    watching.signal("INT");
    let (code, _, stderr) = watching.end();
    assert_eq!(code, Some(0), "{stderr}");
    assert_eq!(stderr.matches("report written").count(), 2, "{stderr}");
    assert!(folder.read("out/report.html").contains("2 of 2 jobs are missing") && !refreshes("out"));
}

/// Protects: a finished study is reported once, and an interval of 0 is refused.
#[test]
fn a_finished_study_is_reported_once() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    folder.ok("run mine.json --out out");
    let page = folder.read("out/report.html");
    assert!(page.contains("Provenance") && page.contains("The study as it was submitted"));
    let watched = folder.command("report mine --watch").assert().code(0);
    assert_eq!(stdout(&watched), "reports/mine/report.html\n");
    assert_eq!(stderr(&watched).matches("report written").count(), 1, "{}", stderr(&watched));
    assert!(!folder.read("reports/mine/report.html").contains(REFRESH));
    let refused = folder.command("report mine --watch 0").assert().code(2);
    assert!(stderr(&refused).contains("'--watch "), "{}", stderr(&refused));
}

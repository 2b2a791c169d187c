//! `report --watch`: a report that is updated while its study runs.

use serde_json::json;

use crate::support::{Folder, LONG_JOBS, long, small, wait};

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

/// Protects: a report is not written again while nothing changes. After an interruption the page does not reload itself any
/// more.
#[test]
fn an_interrupted_watch_ends_the_reloading() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4] })));
    folder.ok("submit mine.json");
    let watching = folder.start("report mine --watch 1 --out out");
    let page = || std::fs::read_to_string(folder.path("out/report.html")).unwrap_or_default();
    wait("the first page", || page().contains(REFRESH));
    std::thread::sleep(std::time::Duration::from_millis(2_500));
    watching.signal("INT");
    let (code, _, stderr) = watching.end();
    assert_eq!(code, Some(0), "{stderr}");
    assert_eq!(stderr.matches("report written").count(), 2, "{stderr}");
    assert!(page().contains("2 of 2 jobs are missing") && !page().contains(REFRESH));
}

/// Protects: a finished study is reported once, and an interval of 0 is refused.
#[test]
fn a_finished_study_is_reported_once() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    folder.ok("run mine.json --out out");
    let page = folder.read("out/report.html");
    assert!(page.contains("Provenance") && page.contains("The study as it was submitted"));
    assert_eq!(folder.ok("report mine --watch").trim_end(), "reports/mine/report.html");
    assert!(!folder.read("reports/mine/report.html").contains(REFRESH));
    folder.command("report mine --watch 0").assert().code(2);
}

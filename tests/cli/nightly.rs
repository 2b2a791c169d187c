//! The comparison of the nightly sweep with its reference values.

use std::process::Command;

use crate::support::Folder;
use crate::tools;

/// Exit code and output of the comparison; `None` without Python.
fn compared(folder: &Folder, jobs: &str) -> Option<(i32, String)> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/nightly.py");
    let Ok(output) = Command::new("python3").arg(script).arg(folder.path(jobs)).arg(folder.path("")).output()
    else {
        tools::missing("python3 cannot be started", "install Python 3 (Debian: apt-get install python3)");
        return None;
    };
    let text = String::from_utf8(output.stdout).unwrap() + &String::from_utf8(output.stderr).unwrap();
    Some((output.status.code().unwrap(), text))
}

/// Protects: the mini sweep is within the tolerances of its reference. A figure beyond them, a failed job and a missing job
/// are drifts and are listed with their parameters. Files that cannot be compared have another exit code.
#[test]
fn drifts_are_listed() {
    let folder = Folder::new();
    folder.write("mini.json", include_str!("../../studies/mini.json"));
    folder.ok("run mini.json");
    let export = folder.ok("export mini");
    folder.write("jobs.csv", &export);
    let Some((code, text)) = compared(&folder, "jobs.csv") else { return };
    assert_eq!(code, 0, "{text}");
    assert_eq!(folder.read("nightly.csv").lines().filter(|line| line.ends_with(",ok")).count(), 6 * 8);

    let job = export.lines().find(|line| line.contains(",7.0,0.4,") || line.contains(",7,0.4,")).unwrap();
    let mu_star = job.split(',').nth(6).unwrap();
    let more = format!("{}", mu_star.parse::<f64>().unwrap() * 1.002);
    for (changed, what) in [
        (export.replace(mu_star, &more), "mu_star"),
        (export.replace(job, &job.replace(",periodic,", ",failed,")), "status"),
        (export.replace(&format!("{job}\n"), ""), "not in the sweep"),
    ] {
        folder.write("changed.csv", &changed);
        let (code, text) = compared(&folder, "changed.csv").unwrap();
        assert_eq!(code, 1, "{text}");
        assert!(text.contains("have drifted") && text.contains(&format!("| 7 | 0.4 | {what} |")), "{text}");
    }
    for broken in ["none.csv", "mini.json"] {
        assert_eq!(compared(&folder, broken).unwrap().0, 2, "{broken}");
    }
}

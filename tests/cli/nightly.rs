//! The scripts of the nightly runs: the comparison of the sweep with its reference values, and the kill storm.

use std::process::Command;

use crate::cli::support::Folder;
use crate::tools;

/// What makes another export of one.
type Change<'a> = &'a dyn Fn(&str) -> String;

/// Exit code and output of the comparison of a folder; `None` without Python.
fn compared(folder: &Folder, name: &str) -> Option<(i32, String)> {
    script("nightly.py", &[&folder.path(name).to_string_lossy()])
}

/// Exit code and output of a script; `None` without Python.
fn script(name: &str, arguments: &[&str]) -> Option<(i32, String)> {
    let script = format!("{}/scripts/{name}", env!("CARGO_MANIFEST_DIR"));
    let Ok(output) = Command::new("python3").arg(script).args(arguments).output() else {
        tools::missing("python3 cannot be started", "install Python 3 (Debian: apt-get install python3)");
        return None;
    };
    let text = String::from_utf8(output.stdout).unwrap() + &String::from_utf8(output.stderr).unwrap();
    Some((output.status.code().unwrap(), text))
}

/// Protects: both sweeps of the mini study are within the tolerances of their reference. A figure beyond them, a job that was decided in another
/// way, a failed job and a missing job are drifts and are listed with their parameters. Files that cannot be compared have another exit code.
#[test]
fn drifts_are_listed() {
    let folder = Folder::new();
    folder.write("mini.json", include_str!("../../studies/mini.json"));
    // As scripts/nightly.sh runs them.
    folder.ok("run mini.json");
    folder.ok("run mini.json --preset standard --set elements=[[12,16,12]]");
    let exports = ["mini", "mini-standard"].map(|study| (study, folder.ok(&format!("export {study} --all"))));
    // A folder with these exports, of which one is changed.
    let write = |name: &str, study: &str, change: &dyn Fn(&str) -> String| {
        for (own, export) in &exports {
            std::fs::create_dir_all(folder.path(format!("{name}/{own}"))).unwrap();
            let text = if *own == study { change(export) } else { export.clone() };
            folder.write(&format!("{name}/{own}/jobs.csv"), &text);
        }
        compared(&folder, name)
    };
    let Some((code, text)) = write("same", "", &str::to_owned) else { return };
    assert_eq!(code, 0, "{text}");
    let lines = folder.read("same/nightly.csv");
    assert_eq!(lines.lines().filter(|line| line.ends_with(",ok")).count(), 6 * 11 + 6 * 12);
    assert!(text.contains("| mini-standard | 7 | 0.2 | decayed | eigenvalues |"), "{text}");

    let job = |export: &str| {
        let wanted = |line: &&str| line.contains(",7.0,0.4,") || line.contains(",7,0.4,");
        export.lines().find(wanted).unwrap().to_owned()
    };
    let other_mu_star = |export: &str, factor: f64| {
        let job = job(export);
        let mu_star = job.split(',').nth(6).unwrap();
        export.replace(mu_star, &format!("{}", mu_star.parse::<f64>().unwrap() * factor))
    };
    let with_job =
        |export: &str, old: &str, new: &str| export.replace(&job(export), &job(export).replace(old, new));
    let changes: [(&str, Change, &str); 6] = [
        ("mini", &|export| other_mu_star(export, 1.002), "mu_star"),
        // The bits of the presets are the same on all machines.
        ("mini-standard", &|export| other_mu_star(export, 1.0 + 1.0e-9), "mu_star"),
        ("mini", &|export| with_job(export, ",periodic,", ",failed,"), "status"),
        ("mini-standard", &|export| with_job(export, ",run,", ",eigenvalues,"), "decided_by"),
        ("mini-standard", &|export| with_job(export, ",single,", ",double,"), "precision"),
        ("mini", &|export| export.replace(&format!("{}\n", job(export)), ""), "not in the sweep"),
    ];
    for (study, change, what) in changes {
        let (code, text) = write("changed", study, change).unwrap();
        assert_eq!(code, 1, "{what}: {text}");
        let line = format!("| {study} | 7 | 0.4 | {what} |");
        assert!(text.contains("have drifted") && text.contains(&line), "{what}: {text}");
    }
    assert_eq!(compared(&folder, "none").unwrap().0, 2);
    assert_eq!(write("broken", "mini", &|_| "study\n".to_owned()).unwrap().0, 2);
}

/// Protects: the script of the kill storm runs to its end: a job may be killed as often as the draw wants, and no job fails by it.
#[test]
fn a_short_kill_storm_ends_well() {
    let program = env!("CARGO_BIN_EXE_tribosweep");
    let arguments =
        ["--program", program, "--kills", "6", "--workers", "2", "--jobs", "40", "--pause", "0.1"];
    let Some((code, text)) = script("torture.py", &[&arguments[..], &["--places", "0"]].concat()) else {
        return;
    };
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("jobs: 40, results: 40") && text.contains("lost: 0"), "{text}");
}

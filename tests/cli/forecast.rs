//! What `validate` and `submit --dry-run` say before a run, and what a run shows meanwhile.

use std::collections::BTreeSet;
use std::process::{Command, Stdio};

use serde_json::{Value, json};

use crate::cli::several::read;
use crate::cli::support::{Folder, TRIBOSWEEP, rows, small, stderr, stdout};
use crate::tools::missing;

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Protects: the forecast has the nodes, the time step and the steps of the run, for each mesh and time step, and a range of
/// time and sizes that make sense.
#[test]
fn the_forecast_is_that_of_the_run() {
    let mut study = small(&json!({ "safety_factor": [0.7, 0.35], "mu": [0.2, 0.4] }));
    study["run"] = json!({ "limit_s": 0.002, "stop_early": false });
    let folder = Folder::with("mine", &study);
    let forecast = parsed(&folder.ok("validate mine.json --json --threads 1"));
    assert_eq!((forecast["study"].as_str(), forecast["jobs"].as_u64()), (Some("mine"), Some(4)));
    assert_eq!(forecast["database"], Value::Null);
    assert_eq!(forecast["speed"], json!({ "fast_ns": 3.0, "slow_ns": 12.0, "finished_jobs": 0 }));
    folder.ok("run mine.json --threads 1");
    let run = rows(&folder.ok("export mine"));
    let groups = forecast["groups"].as_array().unwrap();
    assert_eq!(groups.len(), 2);
    for group in groups {
        assert_eq!((group["nodes"].as_u64(), group["jobs"].as_u64()), (Some(4 * 5 * 4), Some(2)));
        let step_s = group["time_step_s"].as_f64().unwrap();
        let same: Vec<_> =
            run.iter().filter(|row| row["time_step_s"].parse::<f64>().unwrap() == step_s).collect();
        assert_eq!(same.len(), 2, "{group}");
        let steps = group["steps"].to_string();
        assert!(same.iter().all(|row| row["steps"] == steps), "{group}");
        assert!(step_s < group["time_step_limit_s"].as_f64().unwrap());
        assert!(group["thread_memory_bytes"].as_f64().unwrap() > 1e4);
    }
    let time = &forecast["time_s"];
    let [low, high, limit] = ["low", "high", "limit"].map(|name| time[name].as_f64().unwrap());
    assert!(0.0 < low && low < high && high <= 1.001 * limit, "{time}");
    assert!(forecast["results_bytes"].as_f64().unwrap() > 0.0);
    assert!(forecast["memory_bytes"].as_f64().unwrap() > 0.0);
}

/// Protects: a dry run says which jobs are done, submits nothing, and creates no database.
#[test]
fn a_dry_run_changes_nothing() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    folder.add("more", &small(&json!({ "mu": [0.2, 0.3, 0.4] })));
    let text = folder.ok("submit more.json --dry-run");
    assert!(text.starts_with("more: 3 jobs, nothing was submitted\n"), "{text}");
    assert!(text.contains("tribosweep.db does not exist yet"), "{text}");
    assert_eq!(folder.files(), ["mine.json", "more.json"]);

    folder.ok("run mine.json");
    let before = folder.ok("status --json");
    let text = folder.ok("submit more.json --dry-run");
    assert!(text.contains("database  1 of 3 jobs done\n"), "{text}");
    let known = &parsed(&folder.ok("submit more.json --dry-run --json"))["database"];
    assert_eq!(known, &json!({ "done": 1, "failed": 0, "open": 0 }));
    assert!(folder.ok("validate mine.json").contains("none: no job is left"));
    folder.add("other", &small(&json!({ "mu": [0.3] })));
    let other = folder.read("other.json").replacen('{', r#"{ "name": "mine","#, 1);
    folder.write("other.json", &other);
    let refused = folder.command("submit other.json --dry-run --json").assert().code(2);
    let replaced = &parsed(&stdout(&refused))["replaced"];
    assert_eq!(replaced, &json!({ "kept": 0, "new": 1, "dropped": 1, "dropped_done": 1, "cancelled": 0 }));
    assert!(stderr(&refused).contains("--replace"), "{}", stderr(&refused));
    assert_eq!(folder.ok("status --json"), before);
}

/// Protects: a forecast says what it is based on. Once ten jobs have finished in the database, it is their speed, and the
/// range for the same jobs is narrower.
#[test]
fn finished_jobs_give_the_speed() {
    let mut study = small(&json!({ "mu": [0.2, 0.25, 0.3, 0.35, 0.4], "omega_rpm": [2, 7] }));
    study["run"] = json!({ "limit_s": 0.002, "stop_early": false });
    let folder = Folder::with("mine", &study);
    study["run"]["limit_s"] = json!(0.02);
    folder.add("long", &study);
    let width = |jobs: u64, words: &str| {
        let forecast = parsed(&folder.ok("validate long.json --json --threads 1"));
        assert_eq!(forecast["speed"]["finished_jobs"], json!(jobs));
        let [fast, slow] = ["fast_ns", "slow_ns"].map(|end| forecast["speed"][end].as_f64().unwrap());
        assert!(folder.ok("validate long.json").contains(words));
        slow / fast
    };
    let first = width(0, "at a typical speed");
    folder.ok("run mine.json --threads 1");
    // Equal jobs took equal times. Those of a busy machine may differ by more than typical machines do.
    let jobs: Vec<(i64,)> = read(&folder, "UPDATE results SET wall_s = 0.01 RETURNING job_id");
    assert_eq!(jobs.len(), 10);
    let later = width(10, "at the speed of 10 finished jobs in the database");
    assert!(1.0 < later && later < first, "{later} {first}");
}

/// Protects: what a run refuses because of its surroundings, `validate` refuses with the same message, and it creates nothing.
#[test]
fn validate_refuses_what_a_run_refuses() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    folder.write("taken", "a file and no folder");
    folder.write("other.db", "no database, but long enough to be looked at as one, if a program did so");
    for options in ["--db missing/my.db", "--db other.db", "--db .", "--out taken", "--out taken/below"] {
        let message = |command: &str| {
            let end = folder.command(&format!("{command} mine.json {options}")).assert().code(2);
            assert_eq!(stdout(&end), "", "{command} {options}");
            stderr(&end)
        };
        let [validate, run] = ["validate", "run"].map(message);
        let subject = options.split(' ').next_back().unwrap();
        let subject = subject.split('/').next().unwrap();
        assert!(validate.starts_with("error: ") && validate.contains(subject), "{validate}");
        if options.starts_with("--db") {
            assert_eq!(validate, run, "{options}");
        }
    }
}

/// Protects: on a terminal of 80 columns the progress is shown whole: the jobs, the time left from the beginning, and the
/// simulated time with its limit.
#[test]
#[cfg(unix)]
fn progress_fits_a_terminal_of_eighty_columns() {
    if Command::new("script").arg("--version").stdout(Stdio::null()).status().is_err() {
        return missing("`script` is not installed", "install util-linux");
    }
    if Command::new("timeout").arg("--version").stdout(Stdio::null()).status().is_err() {
        return missing("`timeout` is not installed", "install coreutils");
    }
    // The jobs take seconds to minutes, and are interrupted.
    let mut study = small(&json!({ "mu": [0.2, 0.3, 0.4], "omega_rpm": [2, 7, 20] }));
    study["run"] = json!({ "limit_s": 0.3, "stop_early": false });
    let folder = Folder::with("mine", &study);
    let run =
        format!("stty cols 80; timeout --signal=INT 3 {TRIBOSWEEP} --db mine.db run mine.json --threads 1");
    let output = Command::new("script")
        .args(["--quiet", "--return", "--command", &run, "typescript"])
        .current_dir(folder.path(""))
        .env("TERM", "xterm")
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let plain = anstream::adapter::strip_str(&text).to_string();
    // Lines are filled with spaces up to the width of the terminal.
    let parts = plain.split(['\r', '\n']).flat_map(|line| line.split("   "));
    let lines: BTreeSet<&str> = parts.map(str::trim).collect();
    let progress: Vec<&&str> = lines.iter().filter(|line| line.contains('░')).collect();
    assert!(!progress.is_empty(), "{lines:?}");
    assert!(progress.iter().all(|line| line.chars().count() <= 80), "{progress:?}");
    assert!(
        progress.iter().all(|line| line.contains("/9 jobs, ") && line.ends_with(" left")),
        "{progress:?}"
    );
    let running = |line: &&&str| line.starts_with("running: ") && line.ends_with(" of at most 300 ms");
    assert!(lines.iter().any(|line| running(&line)), "{lines:?}");
}

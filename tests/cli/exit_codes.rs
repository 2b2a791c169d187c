//! Exit codes: 1 when jobs failed, 2 for bad input or usage. (Code 0 is in all files, code 3 in `interruption`.)

use serde_json::{Value, json};
use tribosweep::queue::{Clock, NewJob, NewStudy, Queue};

use crate::cli::support::{Folder, diverging, rows, small, stderr, stdout};

/// Asserts that the command ends with code 2, prints no result, and that its message contains each of `expected`.
fn refuses(folder: &Folder, arguments: &str, expected: &[&str]) {
    let end = folder.command(arguments).assert().code(2);
    assert_eq!(stdout(&end), "", "{arguments}");
    for text in expected {
        assert!(stderr(&end).contains(text), "{arguments}: {text:?} is not in: {}", stderr(&end));
    }
}

/// Asserts that every command that reads a study refuses this one and writes no file.
fn refuses_study(text: &str, expected: &[&str]) {
    let folder = Folder::new();
    folder.write("bad.json", text);
    for command in ["validate", "submit", "run"] {
        refuses(&folder, &format!("{command} bad.json"), expected);
    }
    assert_eq!(folder.files(), ["bad.json"]);
}

fn with(pointer: &str, value: Value) -> String {
    let mut study = small(&json!({ "mu": [0.2], "omega_rpm": [7] }));
    let (parent, name) = pointer.rsplit_once('/').unwrap();
    study.pointer_mut(parent).unwrap()[name] = value;
    study.to_string()
}

/// Protects: the message names a missing study file.
#[test]
fn a_missing_file() {
    let folder = Folder::new();
    for command in ["validate", "submit", "run", "solve", "export", "report", "status"] {
        refuses(&folder, &format!("{command} missing.json"), &["error: missing.json: cannot be read"]);
    }
    assert_eq!(folder.files(), Vec::<String>::new());
}

/// Protects: the message has the position of invalid JSON.
#[test]
fn bad_json() {
    refuses_study("{\n  \"grid\": {\n", &["error: bad.json:2:11: not valid JSON: no } closes this object"]);
}

/// Protects: a misspelt field is refused and not ignored.
#[test]
fn an_unknown_field() {
    refuses_study(
        "{ \"scene\": { \"pin\": { \"young_modulus\": 1e9 } } }",
        &["bad.json:1:", "young_modulus"],
    );
    refuses_study("{ \"grid\": { \"nu\": [0.3] } }", &["grid.nu", "no such parameter"]);
}

/// Protects: values that are not physical are refused with field and value, in the scene and in the grid.
#[test]
fn values_that_are_not_physical() {
    let nu = with("/scene/pin/poisson_ratio", json!(0.5));
    refuses_study(&nu, &["scene.pin.poisson_ratio = 0.5: expected", "ν < 0.5"]);
    refuses_study(&with("/grid/poisson_ratio", json!([0.3, 0.5])), &["scene.pin.poisson_ratio = 0.5"]);
    refuses_study(&with("/grid/mu", json!([0.2, -0.1])), &["scene.contact.mu = -0.1: expected"]);
    refuses_study(&with("/grid/omega_rpm", json!([0])), &["scene.disk.omega_rpm = 0"]);
}

/// Protects: a grid without points is refused. A sweep without jobs must not succeed.
#[test]
fn an_empty_grid() {
    refuses_study("{ \"grid\": {} }", &["grid = {}: expected at least one parameter"]);
    refuses_study("{ \"grid\": { \"mu\": [] } }", &["grid.mu"]);
}

/// Protects: a clamp whose edge is not on a node row is refused before the first job, with possible widths, even if only one
/// job of the grid has it.
#[test]
fn a_clamp_off_the_mesh() {
    let clamp = with("/scene/clamp/width_m", json!(0.0025));
    refuses_study(&clamp, &["scene.clamp.width_m = 0.0025 m", "0.004 m"]);
    let grid = with("/grid/clamp_width_m", json!([0.004, 0.006]));
    refuses_study(&grid, &["scene.clamp.width_m = 0.006 m", "(at ", "clamp_width_m = 0.006"]);
}

/// Protects: a time step above the stability limit is refused before the first job, and the message has both numbers.
#[test]
fn a_time_step_above_the_limit() {
    let study = with("/numerics", json!({ "time_step_s": 1e-5 }));
    refuses_study(&study, &["numerics.time_step_s = 1e-5 s is above the stability limit"]);

    // The default step is the safety factor times the limit in the message.
    let folder = Folder::new();
    folder.write("bad.json", &study);
    let refused = folder.command("solve bad.json").assert().code(2);
    let message = stderr(&refused);
    let limit = message.split("the stability limit ").nth(1).unwrap().split(' ').next().unwrap();
    let limit: f64 = limit.parse().unwrap();
    folder.write("good.json", &with("/run/limit_s", json!(0.001)));
    let record: Value = serde_json::from_str(&folder.ok("solve good.json --json")).unwrap();
    assert!((record["time_step_s"].as_f64().unwrap() / (0.7 * limit) - 1.0).abs() < 1e-9, "{message}");
}

/// Protects: commands that read need an existing database and do not create one.
#[test]
fn no_database() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    for command in ["status", "status mine", "work", "export mine", "report mine.json"] {
        refuses(&folder, command, &["error: no database at tribosweep.db", "tribosweep run"]);
    }
    assert_eq!(folder.files(), ["mine.json"]);
    refuses(&folder, "submit mine.json --db no/such.db", &["folder", "no"]);
    folder.write("text.db", &"this is no database ".repeat(100));
    refuses(&folder, "run mine.json --db text.db", &["is not a SQLite database"]);
    assert_eq!(folder.read("text.db"), "this is no database ".repeat(100));
}

/// Protects: the message about an unknown study lists the studies of the database.
#[test]
fn an_unknown_study() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    folder.add("other", &small(&json!({ "mu": [0.2] })));
    folder.ok("submit mine.json");
    for command in ["status other", "export other", "report other", "export other.json"] {
        refuses(&folder, command, &["there is no study `other` in the database; it has: mine"]);
    }
}

/// Protects: usage errors end with code 2, name the wrong or missing argument, and write no file. `--help` is not an error.
#[test]
fn usage() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4] })));
    for (arguments, expected) in [
        ("", "The commands to begin with:\n  validate "),
        ("sweep", "'sweep'"),
        ("run", "<STUDY>"),
        ("run mine.json --threads 0", "'--threads <N>'"),
        ("run mine.json --threads many", "'many'"),
        ("solve mine.json --set mu", "expected NAME=VALUE"),
        ("solve mine.json --set mu=0.2 --history h.csv --every 0", "'--every <N>'"),
        ("export mine --format xml", "'xml'"),
        ("completions", "<SHELL>"),
    ] {
        refuses(&folder, arguments, &[expected]);
    }
    assert_eq!(folder.files(), ["mine.json"]);
    let help = folder.ok("--help");
    let codes = help.split_once("Exit codes:").expect("the help has the exit codes").1;
    let page = include_str!("../../docs/long_sweeps.md");
    for code in 0..=3 {
        let line = codes.lines().find_map(|line| line.strip_prefix(&format!("  {code}  ")));
        let meaning = line.unwrap_or_else(|| panic!("{code}: {codes}"));
        assert!(
            page.contains(&format!("| **{code}** | {meaning} |")),
            "docs/long_sweeps.md: {code} is {meaning}"
        );
    }
    // Number, and with a repository commit and day.
    let version = folder.ok("--version");
    let rest = version.trim_end().strip_prefix(&format!("tribosweep {}", env!("CARGO_PKG_VERSION")));
    let build = rest.unwrap_or_else(|| panic!("{version}"));
    assert!(
        build.is_empty() || (build.starts_with(" (") && build.ends_with(')') && build.contains(", 20")),
        "{version}"
    );
}

/// Protects: `validate` and `submit` refuse what a worker would refuse before its first step, and say in how many jobs: too
/// many steps because of the time step, the density or the damping.
#[test]
fn jobs_with_too_many_steps() {
    let endless = "more than the 5e7 that a run may have";
    refuses_study(&with("/numerics", json!({ "time_step_s": 1e-12 })), &["steps of 1.000e-12 s", endless]);
    // A value that looks like another unit is the likely reason, and comes first.
    refuses_study(
        &with("/scene/pin/density_kg_m3", json!(2.5e-9)),
        &[endless, "error: bad.json:1:", "density_kg_m3 = 2.5e-9: lighter than cork"],
    );
    let folder = Folder::new();
    folder.write("slow.json", r#"{ "scene": { "holder": { "mass_kg": 8, "stiffness_y_n_m": 0.5 } } }"#);
    let message = stderr(&folder.command("validate slow.json").assert().code(2));
    let [cause, consequence] = ["stiffness_y_n_m = 0.5: with a mass of 8 kg", "run.limit_s"]
        .map(|part| message.find(part).expect(part));
    assert!(message.starts_with("error: slow.json:1:") && cause < consequence, "{message}");
    let study = small(&json!({ "beta_r_s": [5e-8, 1, 2], "mu": [0.2, 0.3] }));
    refuses_study(&study.to_string(), &[endless, "(in 4 of 6 jobs, first at beta_r_s = 1, mu = 0.2)"]);
}

/// Protects: a wrong name of a command has the one that is meant, and an option of another command names this command.
#[test]
fn what_is_meant_is_offered() {
    let folder = Folder::new();
    refuses(&folder, "stauts", &["'stauts'", "'status'"]);
    refuses(&folder, "run mine.json --near 11kHz", &["'--near'", "--near is an option of `stability`"]);
    refuses(&folder, "run mine.json --bins 3", &["--bins is an option of `report`, `calibrate`"]);
    refuses(&folder, "run mine.json --treads 2", &["'--treads'", "'--threads'"]);
}

/// Protects: a single job needs a value for every parameter of the grid, and settings are checked as the study is.
#[test]
fn settings_of_a_single_job() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4], "omega_rpm": [7] })));
    refuses(&folder, "solve mine.json", &["grid.mu = [0.2, 0.4]", "--set mu=0.2"]);
    refuses(&folder, "solve mine.json --set mu=-1", &["--set: scene.contact.mu = -1"]);
    refuses(
        &folder,
        "solve mine.json --set my=1",
        &["no such parameter", "`tribosweep parameters` lists all of them"],
    );
    refuses(
        &folder,
        "solve mine.json --set mu=0.2 --set clamp_width_m=0.006",
        &["scene.clamp.width_m = 0.006 m"],
    );
}

/// Protects: jobs that diverge fail and the others do not. The exit code is 1, also when the command is repeated, and
/// status, export and report name the failed jobs.
#[test]
fn failed_jobs() {
    let folder = Folder::with("bad", &diverging(&[0.2, 0.3]));
    let run = folder.command("run bad.json").assert().code(1);
    assert!(stdout(&run).contains("failed"), "{}", stdout(&run));
    assert!(stderr(&run).contains("2 done, 2 failed, 0 left"), "{}", stderr(&run));
    let job_messages = stderr(&run).lines().filter(|line| line.starts_with("job ")).count();
    assert_eq!(job_messages, 2, "{}", stderr(&run));

    let export = rows(&folder.ok("export bad"));
    for row in &export {
        let good = row["omega_rpm"] == "7";
        assert_eq!(row["status"] == "failed", !good, "{row:?}");
        assert_eq!(row["mu_star"].is_empty(), !good, "{row:?}");
        assert_eq!(row["error"].is_empty(), good, "{row:?}");
        assert!(!row["wall_s"].is_empty(), "{row:?}");
    }
    assert!(export.iter().any(|row| row["error"].contains("diverged at step")), "{export:?}");

    let status: Value = serde_json::from_str(&folder.ok("status bad --json")).unwrap();
    assert_eq!(status["failures"].as_array().unwrap().len(), 2);
    let text = folder.ok("status bad");
    let is_region =
        |line: &str| line.starts_with("failed: 2 jobs at ") && line.contains(": diverged at step");
    assert!(text.lines().any(is_region), "{text}");
    let report = folder.read("reports/bad/report.md");
    assert!(report.contains("## Failed jobs (2)"), "{report}");
    assert!(report.contains("form a region:\n\n- failed: 2 jobs at "), "{report}");

    let again = folder.command("run bad.json").assert().code(1);
    assert!(stderr(&again).contains("2 already done, 2 failed before"), "{}", stderr(&again));
    folder.command("work").assert().code(1);
}

/// Protects: a single job that diverges ends with code 1 and its history is written. A job with too many steps is refused
/// with code 2 before it starts.
#[test]
fn a_single_job_that_fails() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    // One element at the stability limit, where friction excites the highest mode (see docs/evidence/stability.md).
    let at_the_limit = "--set elements=1x1x1 --set size_x_m=0.01 --set size_y_m=0.01 --set poisson_ratio=0.499 --set mu=2 \
        --set clamp_side=trailing_end --set clamp_width_m=0 --set ramp_s=0 --set beta_r_s=0 --set safety_factor=1 \
        --set stop_early=false";
    let diverged =
        folder.command(&format!("solve mine.json {at_the_limit} --history history.csv")).assert().code(1);
    assert!(stderr(&diverged).contains("error: diverged at step"), "{}", stderr(&diverged));
    assert_eq!(stdout(&diverged), "");
    assert!(folder.read("history.csv").lines().count() > 10);
    let endless = folder.command("solve mine.json --set beta_r_s=1 --json").assert().code(2);
    assert!(stderr(&endless).contains("more than the"), "{}", stderr(&endless));
    assert_eq!(stdout(&endless), "");
}

/// Protects: a job that this version cannot read fails, and the others are run.
#[test]
fn an_unreadable_job() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    folder.ok("submit mine.json");
    let job = NewJob {
        key: "spoilt".into(),
        payload: "no job".into(),
        parameters: json!({ "omega_rpm": 7.0, "mu": 0.4, "grid": [], "numerics": {
            "case": "c", "elements": [1, 1, 1], "element_size_m": 0.01, "nodes": 8, "beta2": 0.5, "beta_r_s": 5e-8,
            "safety_factor": 0.9, "limit_s": 0.01, "stop_early": true, "average_last_fraction": 0.5, "cycles": 20,
            "tolerance": 0.01, "drift_tolerance": 0.001, "precision": "double", "start": "rest",
        } })
        .to_string(),
        cost: 1.0,
        batch: String::new(),
        priority: None,
        parent: None,
    };
    let study = NewStudy { name: "spoilt".into(), document: String::new(), jobs: vec![job], grows: false };
    tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap().block_on(async {
        let mut queue = Queue::open(folder.path("tribosweep.db"), Clock::OfDatabase).await.unwrap();
        queue.submit(&study).await.unwrap();
        queue.close().await.unwrap();
    });
    let work = folder.command("work").assert().code(1);
    assert!(stderr(&work).contains("job spoilt failed: unreadable job: "), "{}", stderr(&work));
    assert_eq!(folder.counts("mine")["done"], 1);
    let export = rows(&folder.ok("export spoilt"));
    assert_eq!((export[0]["status"].as_str(), export[0]["mu"].as_str()), ("failed", "0.4"));
    // The failure belongs to the other study.
    folder.ok("run mine.json");
}

//! Commands that show, check and write: status, report, export, validate, schema, completions, manual pages.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::CommandFactory;
use serde_json::{Value, json};
use tribosweep::cli::Cli;
use tribosweep::solver;
use tribosweep::study::{Study, schema};

use crate::cli::support::{Folder, HEADER, long, rows, small, stderr, stdout};
use crate::report_files::{LIST, REPORT};

/// Protects: the progress of one and of all studies, as text and as JSON, before and after the work.
#[test]
fn status_counts_jobs() {
    let folder = Folder::with("first", &small(&json!({ "mu": [0.2, 0.4] })));
    folder.add("second", &small(&json!({ "omega_rpm": [20] })));
    folder.ok("submit first.json");
    // There are no colours without a terminal. The time left is known before the first job ends.
    let text = folder.ok("status first");
    let (head, rest) = text.split_once(" with ").unwrap();
    let head = head.replace(['█', '░'], "");
    assert!(
        head.starts_with(
            "first: 2 jobs: 0 done, 0 failed, 0 running, 2 pending\n 0 %, no worker is running; it would take "
        ),
        "{text}"
    );
    let (_, rest) = rest.split_once(" here\n").unwrap();
    assert_eq!(
        rest,
        "μ \\ ω [rpm] 7\n        0.4 .\n        0.2 .\n. pending\ncontinue with `tribosweep work`\n"
    );
    folder.ok("work");
    folder.ok("submit second.json");
    assert_eq!(
        folder.ok("status"),
        "first   2 jobs: 2 done, 0 failed, 0 running, 0 pending\n\
         second  1 job: 0 done, 0 failed, 0 running, 1 pending\n"
    );
    let all: Value = serde_json::from_str(&folder.ok("status --json")).unwrap();
    let jobs = |total, done, pending| json!({ "total": total, "done": done, "failed": 0, "running": 0, "pending": pending, "cancelled": 0 });
    assert_eq!(
        all,
        json!([{ "study": "first", "jobs": jobs(2, 2, 0) }, { "study": "second", "jobs": jobs(1, 0, 1) }])
    );
    let one: Value = serde_json::from_str(&folder.ok("status first.json --json")).unwrap();
    assert_eq!(one["study"], "first");
    assert_eq!(one["jobs"], jobs(2, 2, 0));
    assert_eq!(one["failures"], json!([]));
    assert_eq!(one["outlook"], json!(null), "no job is left");
}

/// Protects: the remaining time is estimated for the workers that are running, and the status says if none is. Text and
/// JSON agree.
#[test]
fn status_estimates_the_remaining_time() {
    let folder = Folder::with("long", &long());
    let working = folder.start("run long.json --threads 1");
    folder.wait_for("long", |jobs| jobs["running"] > 0);
    let read_status = || -> Value { serde_json::from_str(&folder.ok("status long --json")).unwrap() };
    let text = folder.ok("status long");
    let status = read_status();
    assert_eq!((&status["outlook"]["workers"], &status["outlook"]["worker_threads"]), (&json!(1), &json!(1)));
    let remaining = &status["outlook"]["remaining_s"];
    let (low, high) = (remaining["low"].as_f64().unwrap(), remaining["high"].as_f64().unwrap());
    assert!(low >= 0.0 && low <= high && high > 0.0, "{status}");
    assert!(text.contains("░") && text.contains(" left with 1 thread\n"), "{text}");
    assert!(!text.contains('\u{1b}'), "there are no colours without a terminal");

    working.signal("KILL");
    working.end();
    let status = read_status();
    assert_eq!((&status["outlook"]["workers"], &status["outlook"]["worker_threads"]), (&json!(0), &json!(0)));
    assert!(status["outlook"]["remaining_s"]["high"].as_f64().unwrap() > 0.0, "{status}");
    let text = folder.ok("status long");
    assert!(text.contains("no worker is running; it would take "), "{text}");
    let share = status["outlook"]["ended_share"].as_f64().unwrap();
    assert!(text.contains(&format!(" {:.0} %", (100.0 * share).floor())), "{text}");
}

/// Protects: the status names jobs that reached their time limit: their figures are not averages over limit cycles.
#[test]
fn status_names_jobs_that_did_not_become_periodic() {
    let mut study = small(&json!({ "mu": [0.4] }));
    study["run"]["limit_s"] = json!(0.002);
    let folder = Folder::with("short", &study);
    folder.ok("run short.json");
    assert_eq!(rows(&folder.ok("export short"))[0]["status"], "not_periodic");
    assert!(folder.ok("status short").contains("1 done job reached the time limit"));
    let status: Value = serde_json::from_str(&folder.ok("status short --json")).unwrap();
    assert_eq!(status["not_periodic"], 1);
    let region = &status["regions"][0];
    assert_eq!(
        (&region["what"], &region["jobs"], &region["of"]),
        (&json!("not periodic"), &json!(1), &json!(1))
    );
    let why = region["why"].as_str().unwrap();
    assert!(
        why.contains("cycles that have to repeat") || why.contains("(tolerated: 0.01 and 0.001)"),
        "{why}"
    );
}

/// Protects: the status of a database without studies is not an error and says what to do.
#[test]
fn status_of_an_empty_database() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    folder.ok("submit mine.json --db other.db");
    // An empty file is a database without tables.
    folder.write("empty.db", "");
    assert!(folder.ok("status --db empty.db").contains("no studies yet"));
    assert_eq!(folder.ok("status --db empty.db --json"), "[]\n");
}

/// Protects: the database is that of the flag, otherwise that of the variable, otherwise the default. The three databases
/// are independent.
#[test]
fn the_database_is_the_users_choice() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    folder.command("submit mine.json").env("TRIBOSWEEP_DB", "from_variable.db").assert().code(0);
    assert!(folder.path("from_variable.db").exists() && !folder.path("tribosweep.db").exists());
    let mut both = folder.command("submit mine.json --db from_flag.db");
    both.env("TRIBOSWEEP_DB", "unused.db").assert().code(0);
    assert!(folder.path("from_flag.db").exists() && !folder.path("unused.db").exists());
    folder.ok("submit mine.json");
    assert!(folder.path("tribosweep.db").exists());
    // Work in one is not work in the other.
    folder.command("work").env("TRIBOSWEEP_DB", "from_variable.db").assert().code(0);
    for (database, done) in [("from_variable.db", 1), ("from_flag.db", 0), ("tribosweep.db", 0)] {
        let status: Value =
            serde_json::from_str(&folder.ok(&format!("--db {database} status mine --json"))).unwrap();
        assert_eq!(status["jobs"]["done"], done, "{database}");
    }
}

/// Protects: a report is written into the requested folder, and the path of its page is printed. Every folder gets all
/// files of a report and no others. No file is empty, and the page links all others and nothing else.
#[test]
fn report_writes_a_folder() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2], "omega_rpm": [2, 7] })));
    folder.ok("run mine.json --out first");
    assert!(!folder.path("reports").exists());
    let printed = folder.ok("report mine.json --out deep/down");
    assert_eq!(Path::new(printed.trim_end()), Path::new("deep/down/report.html"));
    assert_eq!(folder.read("deep/down/report.md"), folder.read("first/report.md"));
    assert_eq!(Path::new(folder.ok("report mine").trim_end()), Path::new("reports/mine/report.html"));
    let files = folder.files();
    // A study over one parameter has no maps.
    let maps = ["frequency_map.svg", "growth_rate.svg", "regime_map.svg", "regime_plane.svg"];
    let expected: Vec<&str> = REPORT.into_iter().filter(|file| !maps.contains(file)).collect();
    let others: BTreeSet<&str> =
        expected.iter().copied().filter(|file| ![LIST, "report.md"].contains(file)).collect();
    for report in ["first", "deep/down", "reports/mine"] {
        let found = files.iter().filter_map(|file| file.strip_prefix(report)?.strip_prefix('/'));
        let found: Vec<&str> = found.collect();
        assert_eq!(found, expected, "{report}");
        for file in found {
            assert!(!folder.read(Path::new(report).join(file)).is_empty(), "{report}/{file}");
        }
        let page = folder.read(Path::new(report).join("report.md"));
        let linked = page.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0));
        let linked = linked.filter(|address| !address.starts_with('#'));
        assert_eq!(linked.collect::<BTreeSet<_>>(), others, "{report}");
    }
}

/// Protects: parameters other than ω and μ are columns after the fixed ones, in the order of the study.
#[test]
fn further_parameters_follow_the_header() {
    let grid = r#"{ "mu": [0.2], "load_n": [10, 30], "clamp_side": ["inner_side", "whole_top"] }"#;
    let folder = Folder::new();
    // As text: the order of the grid is that of the file.
    folder.write("further.json", &small(&json!(null)).to_string().replace("null", grid));
    folder.ok("run further.json");
    let export = folder.ok("export further");
    let header = export.lines().next().unwrap();
    let further: Vec<_> = header.strip_prefix(HEADER).unwrap().split(',').skip(1).collect();
    assert_eq!(further, ["load_n", "clamp_side"]);
    let rows = rows(&export);
    assert_eq!(rows.len(), 4);
    for (clamp, load) in
        [("inner_side", "10"), ("inner_side", "30"), ("whole_top", "10"), ("whole_top", "30")]
    {
        let found = rows.iter().filter(|row| row["clamp_side"] == clamp && row["load_n"] == load);
        assert_eq!(found.count(), 1, "{clamp} {load}");
    }
    // The grid does not vary ω: it is the scene's.
    assert!(rows.iter().all(|row| row["omega_rpm"] == "7" && row["mu"] == "0.2"));
}

/// Protects: `validate` prints the size of the grid of a valid study and writes no file.
#[test]
fn validate_writes_no_file() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.3, 0.4], "omega_rpm": [2, 7] })));
    let printed = folder.ok("validate mine.json");
    assert!(printed.starts_with("mine.json: valid, 6 jobs ("), "{printed}");
    assert!(printed.contains("mu 3") && printed.contains("omega_rpm 2"), "{printed}");
    assert_eq!(folder.files(), ["mine.json"]);
    // Who reads this line alone sees that there are warnings.
    let doubtful = folder.ok("validate mine.json --set mu=[2,3,4]");
    assert!(doubtful.lines().next().is_some_and(|line| line.ends_with(", 1 warning")), "{doubtful}");
    assert!(!printed.lines().next().is_some_and(|line| line.contains("warning")), "{printed}");
    // The mesh that is named has the error that is asked for.
    let pin = json!({ "size_m": [0.008, 0.010, 0.012], "elements": [20, 10, 12] });
    folder.write(
        "clamp.json",
        &json!({ "scene": { "pin": pin, "clamp": { "width_m": 0.002 } }, "run": { "start": "compared" } })
            .to_string(),
    );
    let clamped = |more: &str| folder.command(&format!("validate clamp.json{more}")).assert().code(0);
    let other = clamped("");
    let warning = "the mesh error stays unknown in 1 job: the clamp is 2 mm wide on the mesh, and 2.4 mm on the coarser one; 24 elements in x have the \
                   same clamp on both";
    assert!(stderr(&other).contains(warning), "{}", stderr(&other));
    assert!(
        stdout(&other).lines().next().is_some_and(|line| line.ends_with(", 1 warning")),
        "{}",
        stdout(&other)
    );
    assert!(!stderr(&clamped(" --set elements=[24,10,12]")).contains("mesh error"));
}

/// Every shipped study.
fn shipped_studies() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies");
    let mut studies: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    studies.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    studies.sort();
    studies
}

/// The model of an elastic disk takes long to build in a program without optimisation.
const LONGEST_CHECK: Duration = Duration::from_mins(10);

/// Protects: the shipped studies are valid for the solver, not only for the parser. The printed number of jobs is that of
/// the study's own grid.
#[test]
fn the_shipped_studies_are_valid() {
    let studies = shipped_studies();
    assert!(studies.iter().any(|study| study.ends_with("figure7.json")), "{studies:?}");
    let folder = Folder::new();
    for study in studies {
        let jobs = Study::load(&study).unwrap().expand(solver::VERSION).unwrap().len();
        let printed = stdout(&folder.command("validate").timeout(LONGEST_CHECK).arg(&study).assert().code(0));
        let noun = if jobs == 1 { "job" } else { "jobs" };
        let expected = format!("{}: valid, {jobs} {noun}", study.display());
        let rest = printed.strip_prefix(&expected);
        assert!(
            rest.is_some_and(|rest| rest.starts_with('\n') || rest.starts_with(" (")),
            "{expected}: {printed}"
        );
    }
}

/// Protects: the command prints the whole schema of the library as text that an editor can load. (`tests/study` compares
/// that schema with the parser.)
#[test]
fn the_schema_is_that_of_the_library() {
    let printed = Folder::new().ok("schema");
    assert_eq!(serde_json::from_str::<Value>(&printed).unwrap(), schema());
    assert_eq!(printed, format!("{:#}\n", schema()));
}

/// How the completion script of a shell offers a command.
fn offer(shell: &str, command: &str) -> String {
    match shell {
        "bash" => format!(" tribosweep,{command})\n"),
        "elvish" => format!("\n            cand {command} '"),
        "fish" => format!("-n \"__fish_tribosweep_needs_command\" -f -a \"{command}\" "),
        "powershell" => format!("[CompletionResult]::new('{command}', '{command}', "),
        "zsh" => format!("\n'{command}:"),
        other => panic!("this test has to know how a script for {other} offers a command"),
    }
}

/// Protects: every supported shell completes every command, and the help lists the same commands.
#[test]
fn completions_name_every_command() {
    let folder = Folder::new();
    let mut program = Cli::command();
    // This adds `help`.
    program.build();
    let commands: BTreeSet<&str> = program.get_subcommands().map(clap::Command::get_name).collect();
    let help = folder.ok("--help");
    let (_, listed) = help.split_once("\nCommands:\n").unwrap();
    let listed = listed.lines().take_while(|line| !line.is_empty());
    // The second line of a description is indented more.
    let names = listed.filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    assert_eq!(names.filter(|name| !name.is_empty()).collect::<BTreeSet<_>>(), commands);
    assert!(["run", "work", "completions"].iter().all(|known| commands.contains(known)), "{commands:?}");

    let completions = program.find_subcommand("completions").unwrap();
    let shells = completions.get_positionals().next().unwrap().get_possible_values();
    assert!(shells.iter().any(|shell| shell.get_name() == "bash"), "{shells:?}");
    for shell in shells {
        let shell = shell.get_name();
        let script = folder.ok(&format!("completions {shell}"));
        for command in &commands {
            assert!(script.contains(&offer(shell, command)), "{shell}: {command}");
        }
    }
}

/// Protects: the program and every command have a manual page with the name of the command, and a folder that cannot be made is named.
#[test]
fn manual_pages_of_every_command() {
    let folder = Folder::new();
    folder.ok("man pages");
    let page = folder.read("pages/tribosweep.1");
    for command in Cli::command().get_subcommands().map(clap::Command::get_name) {
        let own = folder.read(format!("pages/tribosweep-{command}.1"));
        assert!(own.contains(".SH SYNOPSIS") && own.contains(command), "{own}");
        assert!(page.contains(&format!("tribosweep\\-{command}(1)")), "{command}: {page}");
    }
    folder.write("file", "");
    let refused = folder.command("man file/pages").assert().code(2);
    assert!(stderr(&refused).contains("file/pages"), "{}", stderr(&refused));
}

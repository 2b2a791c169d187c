//! Errors against run times and the accuracy presets, from the command line.

use serde_json::{Value, json};

use crate::cli::support::{Folder, rows, small, stderr, stdout, without_wall_times};

/// Protects: `pareto` prints a table and writes files into the report's folder, for a study by name or by file and for
/// several studies at once.
#[test]
fn pareto_prints_a_table_and_writes_files() {
    let grid = json!({ "elements": [[3, 4, 3], [6, 8, 6]], "safety_factor": [0.8, 0.4] });
    let folder = Folder::with("mine", &small(&grid));
    folder.ok("run mine.json");
    let comparison = folder.command("pareto mine.json").assert().code(0);
    let table = stdout(&comparison);
    assert!(table.contains("Reference: 6 × 8 × 6") && table.contains("| elements |"), "{table}");
    assert!(stderr(&comparison).contains("reports/mine"), "{}", stderr(&comparison));
    let page = folder.read("reports/mine/pareto.md");
    assert!(table.lines().filter(|line| line.starts_with('|')).all(|line| page.contains(line)), "{page}");
    assert!(folder.read("reports/mine/pareto.svg").starts_with("<svg"));
    let refinement = rows(&folder.read("reports/mine/refinement.csv"));
    assert!(refinement.iter().any(|line| line["figure"] == "mu_star"), "{refinement:?}");
    let lines = rows(&folder.read("reports/mine/pareto.csv"));
    assert_eq!(lines.len(), 4);
    let nodes: Vec<f64> = lines.iter().map(|line| line["nodes"].parse().unwrap()).collect();
    assert_eq!(nodes, [80.0, 80.0, 441.0, 441.0]);
    let export = rows(&folder.ok("export mine"));
    for (line, job) in lines.iter().zip(&export) {
        assert_eq!(
            (&line["job"], &line["mu_star"], &line["wall_s"]),
            (&job["job"], &job["mu_star"], &job["wall_s"])
        );
        let steps: f64 = job["steps"].parse().unwrap();
        assert_eq!(line["node_steps"].parse::<f64>().unwrap(), line["nodes"].parse::<f64>().unwrap() * steps);
    }
    assert_eq!(lines.iter().filter(|line| line["reference"] == "true").count(), 1);
    assert_eq!(lines[3]["reference"], "true", "the finest mesh and step");

    // A second study of the same scene is compared with the first, in another folder.
    folder.add("more", &small(&json!({ "elements": [[3, 4, 3]], "safety_factor": [0.6, 0.4] })));
    folder.ok("run more.json");
    folder.ok("pareto mine more --out both");
    assert_eq!(rows(&folder.read("both/pareto.csv")).len(), 5);
}

/// Protects: a study without comparable jobs is refused with exit code 2 and advice.
#[test]
fn nothing_to_compare_is_refused() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4] })));
    folder.ok("submit mine.json");
    let refused = |arguments: &str| {
        let end = folder.command(arguments).assert().code(2);
        assert_eq!(stdout(&end), "");
        stderr(&end)
    };
    assert!(refused("pareto mine").contains("jobs done: 0 of 2"), "{}", refused("pareto mine"));
    folder.ok("work");
    assert!(refused("pareto mine").contains("same physical case"), "{}", refused("pareto mine"));
    assert!(refused("pareto other").contains("other"), "{}", refused("pareto other"));
    assert!(!folder.files().iter().any(|file| file.starts_with("reports")), "{:?}", folder.files());
}

/// Protects: `presets` shows every preset with settings and measured errors, as text and as JSON.
#[test]
fn presets_are_shown_with_their_errors() {
    let folder = Folder::new();
    let text = folder.ok("presets");
    let json: Value = serde_json::from_str(&folder.ok("presets --json")).unwrap();
    let presets = json["presets"].as_array().unwrap();
    let names: Vec<_> = presets.iter().map(|preset| preset["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["draft", "standard", "reference", "two_percent", "one_percent"]);
    let measured = json["evidence"]["presets"].as_array().unwrap();
    assert_eq!(measured.len(), 3, "the others have no error but what they ask for");
    for (place, preset) in presets.iter().enumerate() {
        let line = text.lines().find(|line| line.starts_with(preset["name"].as_str().unwrap())).unwrap();
        let share = |share: &Value| format!("{:.1} %", 100.0 * share.as_f64().unwrap());
        let error = match measured.get(place) {
            Some(measured) => {
                format!("{}, {}", share(&measured["mu_star_median"]), share(&measured["mu_star_95"]))
            }
            None => share(&preset["accuracy"]["mu_star"]),
        };
        assert!(line.contains(&error) && line.contains(&preset["safety_factor"].to_string()), "{line}");
    }
}

/// Protects: `solve --preset` solves the job of a study with that preset, and an unknown name is refused with a list of the
/// presets.
#[test]
fn one_job_with_a_preset() {
    let study = json!({ "scene": { "clamp": { "width_m": 0.002 } }, "run": { "limit_s": 0.002 },
        "detection": { "decay_observation_s": 0.0026 } });
    let folder = Folder::with("plain", &study);
    let mut preset = study;
    preset["preset"] = "draft".into();
    folder.add("preset", &preset);
    assert_eq!(folder.ok("solve plain.json --preset draft --json"), folder.ok("solve preset.json --json"));
    let end = folder.command("solve plain.json --preset exact").assert().code(2);
    assert!(
        stderr(&end).contains("draft, standard, reference, two_percent, one_percent"),
        "{}",
        stderr(&end)
    );
}

/// Two jobs that ask for an accuracy, on meshes that end with this number of elements in each direction.
fn asking(mu_star: f64, finest: usize) -> Value {
    json!({
        "scene": { "pin": { "elements": [finest, finest, finest] }, "clamp": { "width_m": 0.002 }, "contact": { "mu": 0.4 } },
        "numerics": { "precision": "single" },
        "accuracy": { "mu_star": mu_star },
        "grid": { "omega_rpm": [10, 20] },
    })
}

/// Protects: a job that asks for an accuracy ends on the first mesh that has it, and its row has this mesh. If the finest one has not, the
/// command and the report say so.
#[test]
fn an_accuracy_is_reached_or_not() {
    for (mu_star, finest, elements, reached) in [(0.2, 48, "24", "true"), (1.0e-4, 24, "24", "false")] {
        let folder = Folder::with("mine", &asking(mu_star, finest));
        let run = folder.command("run mine.json").assert().code(0);
        let warning = "warning: in 2 jobs (the first one at ω = 10 rpm";
        assert_eq!(stderr(&run).contains(warning), reached == "false", "{}", stderr(&run));
        for row in rows(&folder.ok("export mine --all")) {
            assert_eq!(
                (row["mesh_elements_x"].as_str(), row["accuracy_reached"].as_str()),
                (elements, reached)
            );
            let number = |name: &str| row[name].parse::<f64>().unwrap();
            assert_eq!(number("mu_star_mesh_error") <= mu_star * number("mu_star"), reached == "true");
        }
        let page = folder.read("reports/mine/report.md");
        assert_eq!(page.contains("Accuracy not reached (2)"), reached == "false");
        let solved = folder.ok("solve mine.json --set omega_rpm=10");
        assert!(
            solved.lines().any(|line| line.contains("mesh_elements_x") && line.contains(elements)),
            "{solved}"
        );
    }
}

/// Protects: a sweep that is killed on different meshes goes on from its checkpoints and ends with the same bytes.
#[test]
fn an_accuracy_survives_interruptions() {
    let undisturbed = Folder::with("mine", &asking(1.0e-4, 24));
    undisturbed.ok("run mine.json --threads 1");
    let expected = without_wall_times(&undisturbed.ok("export mine --all"));
    let folder = Folder::with("mine", &asking(1.0e-4, 24));
    let mut stopped = 0;
    for wait_ms in [200, 400, 700, 1000] {
        let run = folder.start("run mine.json --threads 1");
        // A process that runs jobs handles signals already.
        folder.wait_for("mine", |counts| counts["running"] > 0 || counts["done"] == 2);
        std::thread::sleep(std::time::Duration::from_millis(wait_ms));
        run.signal("INT");
        let (code, _, messages) = run.end();
        // The process may have finished before the signal.
        assert!(matches!(code, Some(0 | 3)), "{code:?}: {messages}");
        stopped += usize::from(code == Some(3));
    }
    assert!(stopped > 0, "no run was interrupted");
    folder.ok("run mine.json --threads 2");
    assert_eq!(without_wall_times(&folder.ok("export mine --all")), expected);
}

/// Protects: the command line takes an accuracy in percent or as a share, in the place of the study's mesh.
#[test]
fn an_accuracy_on_the_command_line() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    for text in ["2%", "2 %", "0.02"] {
        let end = folder.command("validate mine.json --accuracy").arg(text).assert().code(0);
        let printed = stdout(&end);
        // The clamp of 4 mm is a third of the pin, so 10 elements become 12.
        assert!(printed.contains("48×60×40"), "{printed}");
    }
    let limits = "expected a share of μ* from 0.0001 to 0.5: 0.01 is 1 %";
    for (wrong, why) in [("two", "for example 1% or 0.01"), ("0%", limits), ("200%", limits), ("-1%", limits)]
    {
        let end = folder.command("validate mine.json --accuracy").arg(wrong).assert().code(2);
        assert!(stderr(&end).contains(why), "{}", stderr(&end));
    }
}

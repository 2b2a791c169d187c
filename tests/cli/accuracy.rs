//! Errors against run times and the accuracy presets, from the command line.

use serde_json::{Value, json};

use crate::support::{Folder, rows, small, stderr, stdout};

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
    assert_eq!(names, ["draft", "standard", "reference"]);
    for (preset, measured) in presets.iter().zip(json["evidence"]["presets"].as_array().unwrap()) {
        let line = text.lines().find(|line| line.starts_with(preset["name"].as_str().unwrap())).unwrap();
        let error = format!("{:.1} %", 100.0 * measured["mu_star_error"].as_f64().unwrap());
        assert!(line.contains(&error) && line.contains(&preset["safety_factor"].to_string()), "{line}");
        assert_eq!(preset["elements"], measured["elements"]);
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
    assert!(stderr(&end).contains("draft, standard, reference"), "{}", stderr(&end));
}

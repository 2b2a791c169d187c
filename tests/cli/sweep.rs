//! The whole sweep in one command, and the files that it writes.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::cli::support::{Folder, HEADER, rows, stderr, stdout};
use crate::report_files::REPORT;

/// Protects: one command runs the shipped quick study and prints the table of μ*, writes all files of the report and no
/// others, and the export has all four contact regimes.
#[test]
fn the_mini_study_in_one_command() {
    let folder = Folder::new();
    folder.write("mini.json", include_str!("../../studies/mini.json"));
    let run = folder.command("run mini.json").assert().code(0);

    let table = stdout(&run);
    let mut lines = table.lines();
    assert_eq!(lines.next().unwrap(), "# mini: macroscopic friction coefficient μ\\*");
    assert_eq!(lines.nth(1).unwrap(), "| ω [rpm] | μ = 0.2 | μ = 0.4 |");
    let speeds: Vec<_> = lines.skip(1).take(3).map(|line| line.split('|').nth(1).unwrap().trim()).collect();
    assert_eq!(speeds, ["2", "7", "35"]);
    let page = folder.read("reports/mini/report.md");
    assert!(table.lines().filter(|line| line.starts_with('|')).all(|line| page.contains(line)), "{page}");
    assert!(stderr(&run).contains("mini: 6 jobs, 6 new, 0 already done"), "{}", stderr(&run));
    assert!(stderr(&run).contains("6 done, 0 failed, 0 left"), "{}", stderr(&run));

    let export = folder.ok("export mini");
    assert_eq!(export.lines().next().unwrap(), HEADER);
    assert_eq!(export, folder.read("reports/mini/jobs.csv"));
    let regimes: BTreeSet<_> = rows(&export).into_iter().map(|row| row["regime"].clone()).collect();
    let expected = ["slip_separation", "stable", "stick_slip", "stick_slip_separation"];
    assert_eq!(regimes.iter().collect::<Vec<_>>(), expected.iter().collect::<Vec<_>>());

    let report: Vec<_> = REPORT.iter().map(|file| format!("reports/mini/{file}")).collect();
    let others = ["mini.json", "tribosweep.db", "tribosweep.db.lock"];
    let mut expected: Vec<_> = others.iter().map(|&file| file.to_owned()).chain(report).collect();
    expected.sort();
    assert_eq!(folder.files(), expected);
}

/// Protects: the table has the μ* of the export, which is between half of the local coefficient and the whole of it.
#[test]
fn the_table_agrees_with_the_export() {
    let folder = Folder::new();
    folder.write("mini.json", include_str!("../../studies/mini.json"));
    let table = folder.ok("run mini.json");
    let export = rows(&folder.ok("export mini --format csv"));
    for row in &export {
        let (mu, mu_star): (f64, f64) = (row["mu"].parse().unwrap(), row["mu_star"].parse().unwrap());
        assert!(mu_star < mu && mu_star > 0.5 * mu, "{row:?}");
        let line = table.lines().find(|line| line.split('|').nth(1).unwrap_or("").trim() == row["omega_rpm"]);
        let column = if row["mu"] == "0.2" { 2 } else { 3 };
        // The error of limit cycles on this mesh is unknown, so they have three decimals. That of steady sliding is known.
        let digits = if row["mu_star_mesh_error"].is_empty() { 3 } else { 4 };
        assert_eq!(line.unwrap().split('|').nth(column).unwrap().trim(), format!("{mu_star:.digits$}"));
    }
}

/// Protects: CSV and JSON lines have the same values, on standard output and in a file.
#[test]
fn json_lines_agree_with_the_csv() {
    let folder = Folder::new();
    folder.write("mini.json", include_str!("../../studies/mini.json"));
    folder.ok("submit mini.json");
    // Rows with and without a result.
    for command in ["status", "work"] {
        folder.ok(command);
        let csv = folder.ok("export mini");
        let json = folder.ok("export mini --format json");
        let rows = rows(&csv);
        assert_eq!(json.lines().count(), rows.len());
        for (line, row) in json.lines().zip(&rows) {
            let object: serde_json::Map<String, Value> = serde_json::from_str(line).unwrap();
            assert_eq!(object.keys().collect::<BTreeSet<_>>(), row.keys().collect::<BTreeSet<_>>());
            for (name, value) in &object {
                let cell = &row[name];
                match value {
                    Value::Null => assert_eq!(cell, "", "{name}"),
                    Value::String(text) => assert_eq!(cell, text, "{name}"),
                    number => {
                        assert_eq!(number.as_f64().unwrap(), cell.parse::<f64>().unwrap(), "{name}");
                    }
                }
            }
        }
        assert_eq!(folder.ok("export mini --csv out.csv"), "");
        assert_eq!(folder.read("out.csv"), csv);
        assert_eq!(folder.ok("export mini --format json --csv out.jsonl"), "");
        assert_eq!(folder.read("out.jsonl"), json);
    }
}

/// Protects: a study with another preset or other values stands beside the one of the file, under a name that the messages
/// say. The database has the changed study, and a cluster gets it as a file.
#[test]
fn changed_studies_stand_beside_their_file() {
    let folder = Folder::new();
    folder.write("mini.json", include_str!("../../studies/mini.json"));
    let valid = folder.ok("validate mini.json --preset draft");
    let expected = "mini.json as mini-draft: valid, 6 jobs (mu 2 × omega_rpm 3)\n";
    assert!(valid.starts_with(expected), "{valid}");
    let log = |arguments: &str| stderr(&folder.command(arguments).assert().code(0));
    assert!(log("submit mini.json").contains("mini: 6 jobs, 6 new"));
    assert!(log("submit mini.json --preset draft").contains("mini-draft: 6 jobs, 6 new"));
    assert!(
        log("submit mini.json --set omega_rpm=7 --set preset=[\"draft\"] --name one")
            .contains("one: 2 jobs, 0 new")
    );
    assert!(folder.ok("export mini").starts_with(HEADER));
    for (study, rows_of_it) in [("mini", 6), ("mini-draft", 6), ("one", 2)] {
        assert_eq!(rows(&folder.ok(&format!("export {study}"))).len(), rows_of_it, "{study}");
    }
    assert_eq!(rows(&folder.ok("export one"))[0]["preset"], "draft");
    // The key of a job that only the changed study has: its document is read back from the database.
    let key = rows(&folder.ok("export one"))[1]["job"].clone();
    let inspected = folder.command(&format!("inspect one {key} --node nowhere")).assert().code(2);
    assert!(stderr(&inspected).contains("nowhere"), "{}", stderr(&inspected));

    folder.ok("slurm mini.json --workers 2 --preset draft");
    assert!(log("submit mini-draft.slurm/study.json").contains("mini-draft: 6 jobs, 0 new"));
    let wrong = folder.command("run mini.json --set mu=high").assert().code(2);
    assert!(stderr(&wrong).contains("--set: mu = high: expected a number"), "{}", stderr(&wrong));
}

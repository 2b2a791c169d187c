//! The whole sweep in one command, and the files that it writes.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::report_files::REPORT;
use crate::support::{Folder, HEADER, rows, stderr, stdout};

/// Protects: one command runs the shipped quick study and prints the table of μ*, writes all files of the report and no
/// others, and the export has all four contact regimes.
#[test]
fn the_mini_study_in_one_command() {
    let folder = Folder::new();
    folder.write("mini.json", include_str!("../../studies/mini.json"));
    let run = folder.command("run mini.json").assert().code(0);

    let table = stdout(&run);
    let mut lines = table.lines();
    assert_eq!(lines.next().unwrap(), "| ω [rpm] | μ = 0.2 | μ = 0.4 |");
    let speeds: Vec<_> = lines.skip(1).take(3).map(|line| line.split('|').nth(1).unwrap().trim()).collect();
    assert_eq!(speeds, ["2", "7", "35"]);
    assert!(folder.read("reports/mini/mu_star.md").ends_with(&table));
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
        assert_eq!(line.unwrap().split('|').nth(column).unwrap().trim(), format!("{mu_star:.4}"));
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

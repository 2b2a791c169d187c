//! Studies whose points are no grid, from the command line.

use crate::cli::support::{Folder, rows, small, stderr, stdout};
use serde_json::json;

/// A small scene at ten points of three parameters, and one that fails.
fn points() -> serde_json::Value {
    let mut study = small(&json!({}));
    study.as_object_mut().unwrap().remove("grid");
    study["samples"] = json!({ "design": "sobol", "count": 40, "seed": 3, "of": {
        "mu": { "uniform": [0.1, 0.6] },
        "omega_rpm": { "log_uniform": [1, 100] },
        "clamp_side": { "discrete": ["inner_side", "outer_side"] },
    } });
    study
}

/// Protects: points are validated, run, reported over each parameter, exported, and extended without running the first ones again.
#[test]
fn points_are_run_reported_and_extended() {
    let mut study = points();
    let folder = Folder::with("mine", &study);
    let printed = folder.ok("validate mine.json");
    assert!(printed.contains("valid, 40 jobs (samples 40)"), "{printed}");
    folder.ok("run mine.json");
    assert_eq!(rows(&folder.ok("export mine")).len(), 40);
    for file in ["mu_star.svg", "mu_star-over-mu.svg", "frequency-over-mu.svg", "report.html"] {
        assert!(folder.read(format!("reports/mine/{file}")).len() > 1000, "{file}");
    }
    study["samples"]["count"] = json!(48);
    folder.add("mine", &study);
    let run = folder.command("run mine.json").assert().code(0);
    assert!(stderr(&run).contains("48 jobs, 8 new, 40 already done"), "{}", stderr(&run));
}

/// Protects: `sensitivity` ranks the parameters, says how sure it is, writes its files, and refuses what it cannot do.
#[test]
fn sensitivities_are_printed_and_written() {
    let folder = Folder::with("mine", &points());
    folder.ok("submit mine.json");
    let refused = |arguments: &str| stderr(&folder.command(arguments).assert().code(2));
    assert!(refused("sensitivity mine").contains("no parameter varies between the jobs that are done"));
    folder.ok("work");
    let end = folder.command("sensitivity mine --of mu_star,stick_share").assert().code(0);
    let text = stdout(&end);
    for expected in [
        "## macroscopic friction coefficient μ\\*: 40 points",
        "## share of stick",
        "## regime: 40 points",
        "Only 40 points",
    ] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    let lines = rows(&folder.read("reports/mine/sensitivity.csv"));
    let of = |parameter: &str, index: &str| {
        let line = lines.iter().find(|line| {
            line["quantity"] == "mu_star" && line["parameter"] == parameter && line["index"] == index
        });
        line.map(|line| line["value"].parse::<f64>().unwrap())
    };
    // μ* is mostly μ itself.
    assert!(of("mu", "pawn").unwrap() > of("omega_rpm", "pawn").unwrap());
    assert!(of("mu", "first_order").unwrap() > 0.5);
    assert!(of("clamp_side", "first_order").is_some(), "the points of a name have a mean, too");
    assert!(of("clamp_side", "pawn").is_some());
    assert_eq!(stdout(&folder.command("sensitivity mine --of mu_star,stick_share").assert()), text);
    assert!(refused("sensitivity mine --of mu_stat").contains("--of mu_stat: no such quantity"));
}

/// Protects: on a full grid the indices are those of sums over the grid, and a quantity whose points leave gaps has none but a reason.
#[test]
fn a_grid_has_exact_indices() {
    let mut study = small(&json!({ "mu": [0.1, 0.2, 0.5], "omega_rpm": [2, 10, 50, 100] }));
    // Enough to tell the values apart; no limit cycle is needed.
    study["run"] = json!({ "limit_s": 0.002 });
    let folder = Folder::with("mine", &study);
    folder.ok("run mine.json");
    let text = folder.ok("sensitivity mine --of mu_star");
    assert!(
        text.contains(
            "On this grid of 4 × 3 points, each of which counts the same, the indices have no sampling error."
        ),
        "{text}"
    );
    assert!(!text.contains("without effect could") && !text.contains('…'), "{text}");
    let export = rows(&folder.ok("export mine"));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let variance =
        |values: &[f64]| mean(&values.iter().map(|v| (v - mean(values)).powi(2)).collect::<Vec<_>>());
    let of = |row: &crate::cli::support::ExportRow, name: &str| row[name].parse::<f64>().unwrap();
    let all: Vec<f64> = export.iter().map(|row| of(row, "mu_star")).collect();
    let lines = rows(&folder.read("reports/mine/sensitivity.csv"));
    for (own, other) in [("mu", "omega_rpm"), ("omega_rpm", "mu")] {
        // The means, and the variances within, over the points with one value of a parameter.
        let over = |name: &str, figure: &dyn Fn(&[f64]) -> f64| -> Vec<f64> {
            let values: std::collections::BTreeSet<&str> = export.iter().map(|row| &*row[name]).collect();
            let with = |value: &&str| {
                let of_value = export.iter().filter(|row| row[name] == **value);
                figure(&of_value.map(|row| of(row, "mu_star")).collect::<Vec<_>>())
            };
            values.iter().map(with).collect()
        };
        let expected = [
            ("first_order", variance(&over(own, &mean)) / variance(&all)),
            ("total", mean(&over(other, &variance)) / variance(&all)),
        ];
        for (index, expected) in expected {
            let is_wanted =
                |line: &&crate::cli::support::ExportRow| line["parameter"] == own && line["index"] == index;
            let line = lines.iter().find(is_wanted).unwrap();
            assert!((of(line, "value") - expected).abs() < 1e-9, "{own} {index}: {expected} {line:?}");
            assert_eq!((&*line["low"], &*line["by_chance"]), ("", ""));
        }
    }
    // A part of another grid is a grid with gaps.
    study["grid"] = json!({ "mu": [0.3], "omega_rpm": [2, 10] });
    folder.add("other", &study);
    folder.ok("run other.json");
    let text = folder.ok("sensitivity mine other --of mu_star");
    assert!(
        text.contains("No PAWN and no first-order index: the points are a grid with gaps: 14 of 4 × 4"),
        "{text}"
    );
}

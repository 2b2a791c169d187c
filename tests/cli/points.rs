//! Studies whose points are no grid, from the command line.

use crate::support::{Folder, rows, small, stderr, stdout};
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
        "# macroscopic friction coefficient μ*: 40 points",
        "# share of stick",
        "# regime: 40 points",
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
    assert_eq!(of("clamp_side", "first_order"), None, "a name has no order");
    assert!(of("clamp_side", "pawn").is_some());
    assert_eq!(stdout(&folder.command("sensitivity mine --of mu_star,stick_share").assert()), text);
    assert!(refused("sensitivity mine --of mu_stat").contains("--of mu_stat: no such quantity"));
}

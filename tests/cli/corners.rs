//! The whole path: a study file, the queue, the database, the export.

use crate::cli::support::Folder;
use serde_json::{Value, json};

/// A study with corners along every axis. All combinations are jobs.
fn study() -> Value {
    json!({
        "name": "corners",
        "scene": { "pin": { "elements": [1, 1, 1] }, "clamp": { "side": "whole_top" } },
        "run": { "limit_s": 1.0e-3 },
        "grid": {
            "mu": [0, 2],
            "poisson_ratio": [-0.9, 0.499],
            "load_n": [1.0e-12, 1.0e5],
            "ramp_s": [0, 5.0e-4],
            "omega_rpm": [0.01, 1000],
            "beta2": [0.5, 1],
            // The damping is zero, strong, or so strong that the run has too many steps.
            "beta_r_s": [0, 1.0e-5, 1.0],
            "top": ["tied_in_z", "free_in_z"],
        },
    })
}

/// Protects: a study with jobs of too many steps is refused before any job runs. The other hostile jobs end with figures in
/// the database: none is lost or left unfinished, and no figure is null because it is not a number.
#[test]
fn hostile_jobs_come_out_of_the_database() {
    let folder = Folder::with("corners", &study());
    let run = |arguments: &str| folder.command(arguments).output().unwrap();
    let refused = run("run corners.json");
    let message = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{message}");
    assert!(message.contains("run.limit_s") && message.contains("beta_r_s"), "{message}");
    assert!(!folder.path("tribosweep.db").exists());

    let status = run("run corners.json --set beta_r_s=[0,1e-5]").status;
    assert_eq!(status.code(), Some(0));
    let exported = run("export corners --format json");
    let text = String::from_utf8(exported.stdout).unwrap();
    let rows: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(rows.len(), 2_usize.pow(8));
    for row in &rows {
        assert!(["periodic", "decayed", "not_periodic"].contains(&row["status"].as_str().unwrap()), "{row}");
        for figure in ["mu_star", "mu_star_contact", "n_over_f_max", "energy_residual", "slip_speed_max_m_s"]
        {
            assert!(row[figure].is_f64(), "{figure}: {row}");
        }
    }
}

//! The files of a report.

/// The hidden file that lists the files of a report.
pub const LIST: &str = ".tribosweep-report";

/// Every file of the report of a study over ω and μ, sorted.
pub const REPORT: [&str; 27] = [
    LIST,
    "bifurcation.csv",
    "bifurcation.svg",
    "explore.html",
    "frequency.csv",
    "frequency.svg",
    "frequency_map.csv",
    "frequency_map.svg",
    "growth_rate.csv",
    "growth_rate.svg",
    "jobs.csv",
    "mu_star.csv",
    "mu_star.svg",
    "mu_star_points.csv",
    "regime.csv",
    "regime_map.csv",
    "regime_map.svg",
    "regime_plane.svg",
    "report.html",
    "report.md",
    "residuals.csv",
    "residuals.svg",
    "run_times.csv",
    "scene.svg",
    "shares.csv",
    "shares.svg",
    "track.svg",
];

/// The files that a report has besides, if it has points of the linear stability; sorted.
#[allow(dead_code, reason = "not every test crate has such points")]
pub const STABILITY: [&str; 5] =
    ["lock_in.svg", "modes.csv", "stability_map.svg", "thresholds.csv", "thresholds.svg"];

//! The files of a report.

/// Every file of the report of a study over ω and μ, sorted.
pub const REPORT: [&str; 21] = [
    "figure7.csv",
    "figure7.svg",
    "frequency.csv",
    "frequency.md",
    "frequency.svg",
    "frequency_map.csv",
    "frequency_map.svg",
    "jobs.csv",
    "mu_star.csv",
    "mu_star.md",
    "regime.csv",
    "regime.md",
    "regime_map.csv",
    "regime_map.svg",
    "report.html",
    "report.md",
    "residuals.csv",
    "residuals.svg",
    "run_times.csv",
    "shares.csv",
    "shares.svg",
];

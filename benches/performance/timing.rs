//! Medians from Criterion, and the best of several rounds.
//!
//! On a shared machine the speed changes for seconds at a time. Therefore all cases are measured in turn, in
//! several rounds, and the fastest round counts. So the compared values come from similar conditions.

use criterion::Criterion;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The folder in which Criterion stores its measurements.
fn home() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("target/criterion")
}

/// Number of rounds of all cases.
pub const ROUNDS: usize = 4;

/// Median time [s] of one call.
pub fn seconds<R>(name: &str, mut call: impl FnMut() -> R) -> f64 {
    let mut criterion = Criterion::default()
        .output_directory(&home())
        .without_plots()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(50))
        .measurement_time(Duration::from_millis(250));
    criterion.bench_function(name, |bencher| bencher.iter(&mut call));
    let path = home().join(name).join("new/estimates.json");
    let text = std::fs::read_to_string(&path).expect("Criterion wrote its estimates");
    let estimates: serde_json::Value = serde_json::from_str(&text).expect("estimates are JSON");
    estimates["median"]["point_estimate"].as_f64().expect("a median in nanoseconds") * 1.0e-9
}

/// [`seconds`] of the fastest of all rounds.
pub fn fastest<R>(name: &str, mut call: impl FnMut() -> R) -> f64 {
    (0..ROUNDS).map(|_| seconds(name, &mut call)).fold(f64::INFINITY, f64::min)
}

//! Medians from Criterion.

use criterion::Criterion;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Where Criterion keeps what it measures.
fn home() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("target/criterion")
}

/// Median time [s] of one call.
pub fn seconds(name: &str, mut call: impl FnMut()) -> f64 {
    let mut criterion = Criterion::default()
        .output_directory(&home())
        .without_plots()
        .sample_size(15)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(600));
    criterion.bench_function(name, |bencher| bencher.iter(&mut call));
    let path = home().join(name).join("new/estimates.json");
    let text = std::fs::read_to_string(&path).expect("Criterion wrote its estimates");
    let estimates: serde_json::Value = serde_json::from_str(&text).expect("estimates are JSON");
    estimates["median"]["point_estimate"].as_f64().expect("a median in nanoseconds") * 1.0e-9
}

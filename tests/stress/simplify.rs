//! Simplifies a failing case as long as it still fails, so that its cause is easier to find.

use serde_json::{Value, json};
use tribosweep_mechanics::spec::JobSpec;

/// Plain values. They are tried one after the other until none of them simplifies the case any more.
fn plain() -> Vec<(&'static str, Value)> {
    vec![
        ("/scene/pin/elements", json!([1, 1, 1])),
        ("/scene/pin/size_m", json!([0.01, 0.01, 0.01])),
        ("/scene/pin/young_modulus_pa", json!(1.0e9)),
        ("/scene/pin/poisson_ratio", json!(0.3)),
        ("/scene/pin/density_kg_m3", json!(2500.0)),
        ("/scene/disk/omega_rpm", json!(7.0)),
        ("/scene/disk/track_radius_m", json!(0.0914)),
        ("/scene/contact/mu", json!(0.4)),
        ("/scene/clamp", json!({ "side": "whole_top", "width_m": 0.001 })),
        ("/scene/top", json!("tied_in_z")),
        ("/scene/load/force_n", json!(30.0)),
        ("/scene/load/ramp_s", json!(0.0)),
        ("/numerics/beta2", json!(0.5)),
        ("/numerics/beta_r_s", json!(0.0)),
        ("/numerics/safety_factor", json!(0.7)),
        ("/run/stop_early", json!(true)),
        ("/run/average_last_fraction", json!(0.4)),
        ("/run/limit_s", json!(1.0e-3)),
        ("/detection/cycles", json!(20)),
        ("/detection/tolerance", json!(0.01)),
        ("/detection/drift_tolerance", json!(0.001)),
        ("/detection/regime_threshold", json!(0.03)),
        ("/detection/decay_observation_s", json!(0.008)),
    ]
}

/// A job with as many plain values as possible for which `fails` still holds.
pub fn simplest(spec: &JobSpec, fails: impl Fn(&JobSpec) -> bool) -> JobSpec {
    let mut best = spec.clone();
    loop {
        let before = best.clone();
        for (pointer, value) in plain() {
            let mut job = serde_json::to_value(&best).expect("a job is plain data");
            match job.pointer_mut(pointer) {
                Some(field) if *field != value => *field = value,
                _ => continue,
            }
            let candidate = serde_json::from_value(job).expect("a plain value fits");
            if fails(&candidate) {
                best = candidate;
            }
        }
        if best == before {
            return best;
        }
    }
}

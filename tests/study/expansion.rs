//! Protects: which jobs a grid gives, in which order, with which values.

use super::parse;
use serde_json::{Value, json};
use tribosweep::spec::{ClampSide, JobSpec};
use tribosweep::study::{Job, Study};

fn jobs(text: &str) -> Vec<Job> {
    parse(text).expand("test").unwrap()
}

/// The values of the only axis of a grid.
fn axis(text: &str) -> Vec<f64> {
    let study = parse(&format!(r#"{{ "grid": {{ {text} }} }}"#));
    let (_, values) = study.axes().next().unwrap();
    values.iter().map(|value| value.as_f64().unwrap()).collect()
}

#[test]
fn without_a_grid_a_study_is_its_base_job() {
    let jobs = jobs(r#"{ "scene": { "contact": { "mu": 0.25 } } }"#);
    let mut expected = JobSpec::default();
    expected.scene.contact.mu = 0.25;
    assert_eq!(jobs.len(), 1);
    assert_eq!(jobs[0].spec, expected);
    assert!(jobs[0].parameters.is_empty());
}

#[test]
fn the_first_axis_of_the_file_is_slowest() {
    // Neither alphabetical nor the order of the registry.
    let jobs = jobs(
        r#"{ "grid": { "omega_rpm": [7, 2], "clamp_side": ["both_ends", "inner_side"], "mu": [0.4, 0.1, 0.2] } }"#,
    );
    let found: Vec<_> = jobs
        .iter()
        .map(|j| (j.spec.scene.disk.omega_rpm, j.spec.scene.clamp.side, j.spec.scene.contact.mu))
        .collect();
    let mut expected = Vec::new();
    for omega in [7.0, 2.0] {
        for side in [ClampSide::BothEnds, ClampSide::InnerSide] {
            for mu in [0.4, 0.1, 0.2] {
                expected.push((omega, side, mu));
            }
        }
    }
    assert_eq!(found, expected);
    let parameters = json!([["omega_rpm", 7.0], ["clamp_side", "both_ends"], ["mu", 0.1]]);
    assert_eq!(serde_json::to_value(&jobs[1].parameters).unwrap(), parameters);
}

#[test]
fn jobs_differ_from_the_base_only_in_their_parameters() {
    let text = r#"{ "scene": { "load": { "force_n": 12 } }, "numerics": { "beta2": 0.6 },
        "grid": { "nx": [4, 5], "time_step_s": [1e-8] } }"#;
    let mut expected = parse(text).base().clone();
    expected.scene.pin.elements[0] = 5;
    expected.numerics.time_step_s = Some(1.0e-8);
    assert_eq!(jobs(text)[1].spec, expected);
    assert_eq!((expected.scene.load.force_n, expected.numerics.beta2), (12.0, 0.6));
}

#[test]
fn ranges_have_exact_ends_and_the_stated_spacing() {
    let linear = axis(r#""mu": { "from": 0.1, "to": 0.6, "count": 6 }"#);
    assert_eq!(linear, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6], "the same numbers as a list would have");
    let log = axis(r#""omega_rpm": { "from": 0.3, "to": 70.1, "count": 7, "spacing": "log" }"#);
    assert_eq!((log.len(), log[0], log[6]), (7, 0.3, 70.1));
    let ratio = (70.1_f64 / 0.3).powf(1.0 / 6.0);
    for pair in log.windows(2) {
        assert!((pair[1] / pair[0] / ratio - 1.0).abs() < 1.0e-10, "{log:?}");
    }
    assert_eq!(
        axis(r#""omega_rpm": { "from": 1, "to": 100, "count": 3, "spacing": "log" }"#),
        [1.0, 10.0, 100.0]
    );
    assert_eq!(axis(r#""omega_rpm": { "from": 5, "to": 1, "count": 3 }"#), [5.0, 3.0, 1.0], "downwards");
    assert_eq!(axis(r#""mu": { "from": 0.3, "to": 0.3, "count": 1 }"#), [0.3], "a single value");
    // 17 digits: the ends are not rounded as the values between them are.
    for spacing in ["linear", "log"] {
        let range =
            r#""mu": { "from": 0.12345678901234568, "to": 0.98765432109876546, "count": 3, "spacing": "#;
        let values = axis(&format!("{range} \"{spacing}\" }}"));
        // Read by the same reader: what is protected here is that the range keeps them.
        let ends = ["0.12345678901234568", "0.98765432109876546"];
        let ends: [f64; 2] = ends.map(|end| serde_json::from_str(end).unwrap());
        assert_eq!([values[0], values[2]], ends);
    }
}

/// Protects: a step leads from the first value on, and the last value is hit exactly if a whole number of steps leads
/// there, however decimal numbers are rounded; otherwise the range ends before it.
#[test]
fn ranges_with_a_step_end_at_or_before_the_last_value() {
    let steps = |from: &str, to: &str, step: &str| {
        axis(&format!(r#""mu": {{ "from": {from}, "to": {to}, "step": {step} }}"#))
    };
    assert_eq!(
        steps("0.1", "0.6", "0.1"),
        [0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
        "the same numbers as a list would have"
    );
    assert_eq!(steps("1", "10", "4"), [1.0, 5.0, 9.0], "10 is not hit");
    assert_eq!(steps("5", "1", "-2"), [5.0, 3.0, 1.0], "downwards");
    assert_eq!(steps("1", "2", "1"), [1.0, 2.0]);
    assert_eq!(
        steps("0", "1", "0.3333333333"),
        [0.0, 0.333_333_333_3, 0.666_666_666_6, 1.0],
        "within a millionth of a step"
    );
    assert_eq!(steps("0", "1", "0.3334"), [0.0, 0.3334, 0.6668]);
    let many = steps("0.001", "10", "0.001");
    assert_eq!((many.len(), many[0], many[2], many[9_999]), (10_000, 0.001, 0.003, 10.0));
    let counts = jobs(r#"{ "grid": { "nx": { "from": 4, "to": 9, "step": 2 } } }"#);
    assert_eq!(counts.iter().map(|job| job.spec.scene.pin.elements[0]).collect::<Vec<_>>(), [4, 6, 8]);
}

/// Protects: computed values are rounded to the wanted digits, and the ends are not.
#[test]
fn ranges_have_nice_numbers_on_request() {
    let log = |digits: usize| {
        let range = r#""omega_rpm": { "from": 1, "to": 100, "count": 9, "spacing": "log", "digits": "#;
        axis(&format!("{range} {digits} }}"))
    };
    assert_eq!(log(2), [1.0, 1.8, 3.2, 5.6, 10.0, 18.0, 32.0, 56.0, 100.0]);
    assert_eq!(log(3), [1.0, 1.78, 3.16, 5.62, 10.0, 17.8, 31.6, 56.2, 100.0]);
    assert_eq!(
        axis(r#""mu": { "from": 0.1234, "to": 0.9876, "count": 3, "digits": 2 }"#),
        [0.1234, 0.56, 0.9876]
    );
}

#[test]
fn ranges_of_counts_are_whole() {
    let jobs = jobs(r#"{ "grid": { "nx": { "from": 4, "to": 8, "count": 3 } } }"#);
    let counts: Vec<_> = jobs.iter().map(|job| job.spec.scene.pin.elements[0]).collect();
    assert_eq!(counts, [4, 6, 8]);
    assert_eq!(jobs[0].parameters[0].1, Value::from(4_u64));
}

/// A `whole_top` clamp has no width, so its jobs over widths are one job.
#[test]
fn grid_points_that_are_the_same_job_appear_once() {
    let text =
        r#"{ "grid": { "clamp_side": ["whole_top", "inner_side"], "clamp_width_m": [0.001, 0.002] } }"#;
    let jobs = jobs(text);
    assert_eq!(parse(text).grid_size(), 4);
    let found: Vec<_> = jobs.iter().map(|j| (j.spec.scene.clamp.side, j.spec.scene.clamp.width_m)).collect();
    let expected =
        [(ClampSide::WholeTop, 0.001), (ClampSide::InnerSide, 0.001), (ClampSide::InnerSide, 0.002)];
    assert_eq!(found, expected);
}

#[test]
fn expansion_is_stable_and_keys_are_unique() {
    let study = Study::load("studies/figure7.json".as_ref()).unwrap();
    let first = study.expand("test").unwrap();
    assert_eq!(first, study.expand("test").unwrap());
    let mut keys: Vec<_> = first.iter().map(|job| &job.key).collect();
    keys.sort();
    keys.dedup();
    assert_eq!(keys.len(), first.len());
}

//! Protects: a preset stands for its documented settings, in a study and on the command line, and its measured errors
//! belong to these settings.

use super::{assert_contains, parse, refusal};
use serde_json::{Value, json};
use tribosweep::analysis::{Unobserved, solve};
use tribosweep::spec::{ClampSide, JobSpec};
use tribosweep::study::{CaseEvidence, Evidence, Preset, Study, job_key};

fn base(preset: &str, more: &str) -> JobSpec {
    parse(&format!(r#"{{ "preset": "{preset}"{more} }}"#)).base().clone()
}

/// The values are repeated here, because the measured errors belong to them.
#[test]
fn presets_set_mesh_step_and_detection() {
    for (name, elements, safety_factor, tolerance, drift_tolerance) in [
        ("draft", [12, 15, 10], 0.9, 0.03, 0.003),
        ("standard", [24, 30, 20], 0.7, 0.01, 0.001),
        ("reference", [36, 45, 30], 0.5, 0.003, 0.0003),
    ] {
        let mut expected = JobSpec::default();
        expected.scene.pin.elements = elements;
        expected.numerics.safety_factor = safety_factor;
        expected.detection.tolerance = tolerance;
        expected.detection.drift_tolerance = drift_tolerance;
        assert_eq!(base(name, ""), expected, "{name}");
    }
}

/// Protects: the same settings are the same job, whether a preset or the file names them.
#[test]
fn a_preset_has_the_key_of_its_settings() {
    let explicit = r#"{ "scene": { "pin": { "elements": [12, 15, 10] } }, "numerics": { "safety_factor": 0.9 },
        "detection": { "tolerance": 0.03, "drift_tolerance": 0.003 } }"#;
    assert_eq!(job_key(&base("draft", ""), "1"), job_key(parse(explicit).base(), "1"));
}

#[test]
fn values_of_the_file_take_precedence_over_the_preset() {
    let spec = base(
        "draft",
        r#", "numerics": { "safety_factor": 0.3 }, "scene": { "pin": { "elements": [6, 6, 6] } }"#,
    );
    assert_eq!((spec.numerics.safety_factor, spec.scene.pin.elements), (0.3, [6, 6, 6]));
    assert_eq!(spec.detection.tolerance, 0.03);
    // Even if the value is the default.
    assert_eq!(base("draft", r#", "detection": { "tolerance": 0.01 }"#).detection.tolerance, 0.01);
    let study = parse(r#"{ "preset": "draft", "grid": { "elements": [[3, 3, 3]], "mu": [0.1] } }"#);
    assert_eq!(study.expand("1").unwrap()[0].spec.scene.pin.elements, [3, 3, 3]);
}

/// Protects: the mesh fits pin and clamp: elements of about equal size, and a node row at the clamp's edge.
#[test]
fn the_mesh_follows_pin_and_clamp() {
    let elements = |scene: &str| base("draft", &format!(r#", "scene": {{ {scene} }}"#)).scene.pin.elements;
    let clamp = |side: &str, width: f64| format!(r#""clamp": {{ "side": "{side}", "width_m": {width} }}"#);
    assert_eq!(elements(&clamp("inner_side", 0.002)), [12, 15, 10]);
    assert_eq!(elements(&clamp("inner_side", 0.0)), [12, 15, 10]);
    assert_eq!(elements(&clamp("whole_top", 0.001)), [12, 15, 10]);
    assert_eq!(elements(&clamp("both_sides", 0.0015)), [16, 15, 10]);
    assert_eq!(elements(&clamp("leading_end", 0.0006)), [12, 25, 10]);
    // Twice the pin under twice the clamp is the same mesh.
    let large = r#""pin": { "size_m": [0.024, 0.03, 0.02] }, "clamp": { "width_m": 0.004 }"#;
    assert_eq!(elements(large), [12, 15, 10]);
    // No count has a row there: the desired mesh, which the solver refuses with the reason.
    assert_eq!(elements(&clamp("inner_side", 0.000_123_4)), [12, 15, 10]);
    for side in [ClampSide::InnerSide, ClampSide::TrailingEnd] {
        for preset in Preset::ALL {
            let spec = base(preset.name(), &format!(r#", "scene": {{ {} }}"#, clamp(side.name(), 0.001)));
            tribosweep::solver::Model::from_scene(&spec.scene, &spec.numerics).unwrap();
        }
    }
}

#[test]
fn unknown_presets_are_refused() {
    let text = refusal(r#"{ "preset": "drafty" }"#);
    assert_contains(&text, &["preset = \"drafty\": expected", "did you mean `draft`?"]);
    for wrong in ["null", "3", r#"["draft"]"#, r#"{ "draft": null }"#] {
        let text = refusal(&format!(r#"{{ "preset": {wrong} }}"#));
        assert_contains(&text, &["preset", "expected a name, as a string"]);
    }
    refusal(r#"{ "grid": { "preset": ["draft"] } }"#);
}

/// Protects: on the command line a preset takes precedence over the study and its grid, and `--set` over the preset.
#[test]
fn a_preset_for_one_job() {
    let study = parse(
        r#"{ "scene": { "pin": { "elements": [24, 30, 20] } }, "numerics": { "time_step_s": 1e-8 },
            "grid": { "mu": [0.2, 0.4], "tolerance": [0.1, 0.2] } }"#,
    );
    let single = |settings: &[(&str, &str)]| {
        let settings: Vec<_> = settings.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
        study.single_with_preset(Some(Preset::Draft), &settings)
    };
    let spec = single(&[("mu", "0.2")]).unwrap();
    assert_eq!((spec.scene.pin.elements, spec.detection.tolerance), ([12, 15, 10], 0.03));
    assert_eq!(spec.numerics.time_step_s, None, "the preset's step is a fraction of the limit");
    let spec =
        single(&[("mu", "0.2"), ("nx", "6"), ("clamp_width_m", "0.002"), ("time_step_s", "2e-8")]).unwrap();
    assert_eq!((spec.scene.pin.elements, spec.numerics.time_step_s), ([6, 30, 20], Some(2.0e-8)));
    // The mesh is made for the clamp that the override sets.
    let spec = single(&[("mu", "0.2"), ("clamp_width_m", "0.002")]).unwrap();
    assert_eq!(spec.scene.pin.elements, [12, 15, 10]);
    assert_contains(&single(&[]).unwrap_err().to_string(), &["grid.mu = [0.2, 0.4]: expected one value"]);
}

/// Protects: the measured errors shipped with the program are those of the presets as they are now. If this fails,
/// run scripts/accuracy.py.
#[test]
fn the_evidence_is_of_these_presets() {
    let evidence = Evidence::measured();
    let names: Vec<&str> = evidence.presets.iter().map(|entry| entry.name.as_str()).collect();
    assert_eq!(names, Preset::ALL.map(Preset::name));
    for (preset, entry) in Preset::ALL.into_iter().zip(&evidence.presets) {
        let spec = base(preset.name(), "");
        assert_eq!(entry.elements, spec.scene.pin.elements, "{}", entry.name);
        assert_eq!(entry.safety_factor, spec.numerics.safety_factor, "{}", entry.name);
        assert_eq!(entry.tolerance, spec.detection.tolerance, "{}", entry.name);
        assert_eq!(entry.drift_tolerance, spec.detection.drift_tolerance, "{}", entry.name);
    }
}

/// Protects: the stated errors and costs are those of the stated results.
#[test]
fn the_stated_errors_are_those_of_the_results() {
    let evidence = Evidence::measured();
    let reference = &evidence.reference.cases;
    assert!(reference.len() >= 3);
    for entry in &evidence.presets {
        assert_eq!(entry.cases.len(), reference.len(), "{}", entry.name);
        let largest = |error: fn(&CaseEvidence, &CaseEvidence) -> f64| {
            entry.cases.iter().zip(reference).map(|(a, b)| error(a, b)).fold(0.0, f64::max)
        };
        let close = |a: f64, b: f64| assert!((a - b).abs() <= 1.0e-12, "{}: {a} {b}", entry.name);
        close(largest(|a, b| (a.mu_star / b.mu_star - 1.0).abs()), entry.mu_star_error);
        close(largest(|a, b| (a.frequency_hz / b.frequency_hz - 1.0).abs()), entry.frequency_error);
        let shares = |a: &CaseEvidence, b: &CaseEvidence| {
            (0..3).map(|i| (a.shares[i] - b.shares[i]).abs()).fold(0.0, f64::max)
        };
        close(largest(shares), entry.shares_error);
    }
    let uncertain = reference.iter().map(|case| case.mu_star_uncertainty.expect("every case has one"));
    assert_eq!(uncertain.fold(0.0, f64::max), evidence.reference.mu_star_uncertainty);
    let costs: Vec<f64> = evidence.presets.iter().map(|entry| entry.relative_cost).collect();
    assert!(costs[0] < costs[1] && costs[1] == 1.0 && costs[1] < costs[2], "{costs:?}");
}

/// Protects: what the program computes with the draft preset today is within the error stated for it.
#[test]
fn the_draft_keeps_its_stated_error() {
    let evidence = Evidence::measured();
    let stated = evidence.of(Preset::Draft).unwrap();
    let truth = evidence.reference.cases.last().unwrap();
    let mut spec = base("draft", "");
    spec.scene.contact.mu = evidence.mu;
    spec.scene.disk.omega_rpm = truth.omega_rpm;
    let record = solve(&spec, &mut Unobserved).unwrap();
    // To rounding of the stored figures: between machines the last bits may differ.
    let error = (record.mu_star / truth.mu_star - 1.0).abs();
    assert!(error <= stated.mu_star_error * (1.0 + 1.0e-6), "{error} > {}", stated.mu_star_error);
    let error = (record.frequency_hz.unwrap() / truth.frequency_hz - 1.0).abs();
    assert!(error <= stated.frequency_error * (1.0 + 1.0e-6), "{error} > {}", stated.frequency_error);
}

/// Protects: figure7 has the settings of the standard preset.
#[test]
fn figure7_has_the_standard_accuracy() {
    let figure7 = Study::load("studies/figure7.json".as_ref()).unwrap();
    let standard = base("standard", "");
    assert_eq!(figure7.base().scene.pin.elements, standard.scene.pin.elements);
    assert_eq!(figure7.base().numerics, standard.numerics);
    assert_eq!(figure7.base().detection, standard.detection);
}

/// Protects: an editor that uses the schema offers exactly the presets.
#[test]
fn the_schema_knows_the_presets() {
    let schema = tribosweep::study::schema();
    let problem = |study: &Value| super::mini_schema::violation(&schema, &schema, study, "");
    for preset in Preset::ALL {
        assert_eq!(problem(&json!({ "preset": preset.name() })), None);
        assert_eq!(Preset::find(preset.name()), Some(preset));
    }
    assert!(problem(&json!({ "preset": "exact" })).is_some());
    assert!(problem(&json!({ "preset": null })).is_some());
}

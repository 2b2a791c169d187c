//! Protects: a preset stands for its documented settings, in a study and on the command line, and its measured errors
//! belong to these settings.

use super::{assert_contains, parse, refusal};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use tribosweep::analysis::{Unobserved, solve};
use tribosweep::spec::{ClampSide, JobSpec, Precision, StabilityMethod, Start};
use tribosweep::study::{Evidence, Parameter, Preset, Study, job_key};

fn base(preset: &str, more: &str) -> JobSpec {
    parse(&format!(r#"{{ "preset": "{preset}"{more} }}"#)).base().clone()
}

/// The values are repeated here, because the measured errors belong to them.
#[test]
fn presets_set_mesh_step_and_detection() {
    for (name, elements, safety_factor, tolerance, drift_tolerance) in [
        ("draft", [12, 15, 10], 0.9, 0.03, 0.003),
        ("standard", [24, 30, 20], 0.7, 0.01, 0.001),
        ("reference", [36, 45, 30], 0.7, 0.01, 0.001),
    ] {
        let mut expected = JobSpec::default();
        expected.scene.pin.elements = elements;
        expected.numerics.safety_factor = safety_factor;
        expected.detection.tolerance = tolerance;
        expected.detection.drift_tolerance = drift_tolerance;
        expected.numerics.precision = Precision::Single;
        if name != "draft" {
            expected.run.start = Start::Nested;
            expected.stability = StabilityMethod::Eigenvalues;
        }
        assert_eq!(base(name, ""), expected, "{name}");
    }
}

/// Protects: a preset chooses a fast way only where it works: not on an elastic disk, and in single precision not without
/// damping. What the study gives stays, even if `--preset` takes precedence over its mesh.
#[test]
fn presets_choose_a_way_that_works() {
    let way = |spec: &JobSpec| (spec.numerics.precision, spec.run.start, spec.stability);
    let slow = (Precision::Double, Start::Rest, StabilityMethod::Simulate);
    let fast = (Precision::Single, Start::Nested, StabilityMethod::Eigenvalues);
    assert_eq!(way(parse("{}").base()), slow);
    assert_eq!(way(&base("standard", "")), fast);
    assert_eq!(way(&base("standard", r#", "scene": { "disk": { "kind": "elastic" } }"#)), slow);
    for undamped in [r#""numerics": { "beta_r_s": 0 }"#, r#""damping": { "ratio": 0, "frequency_hz": 1e4 }"#]
    {
        assert_eq!(way(&base("standard", &format!(", {undamped}"))), (Precision::Double, fast.1, fast.2));
    }
    let given =
        r#""numerics": { "precision": "double" }, "run": { "start": "rest" }, "stability": "simulate""#;
    assert_eq!(way(&base("reference", &format!(", {given}"))), slow);
    let study = parse(&format!("{{ {given} }}"));
    let spec = study.single_with_preset(Some(Preset::Standard), &[]).unwrap();
    assert_eq!((spec.scene.pin.elements, way(&spec)), ([24, 30, 20], slow));
    let study = parse(r#"{ "preset": "standard", "grid": { "precision": ["double", "single"] } }"#);
    let precisions: Vec<_> =
        study.expand("1").unwrap().iter().map(|job| job.spec.numerics.precision).collect();
    assert_eq!(precisions, [Precision::Double, Precision::Single]);
}

/// Protects: the same settings are the same job, whether a preset or the file names them.
#[test]
fn a_preset_has_the_key_of_its_settings() {
    let explicit = r#"{ "scene": { "pin": { "elements": [12, 15, 10] } },
        "numerics": { "safety_factor": 0.9, "precision": "single" },
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
    assert_contains(
        &refusal(r#"{ "grid": { "preset": ["draft", "drafty"] } }"#),
        &["studies/x.json:1:33: grid.preset[1] = \"drafty\": expected", "did you mean `draft`?"],
    );
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
    // The preset gives what the override leaves open of the mesh.
    assert_eq!((spec.scene.pin.elements, spec.numerics.time_step_s), ([6, 15, 10], Some(2.0e-8)));
    // The mesh is made for the clamp that the override sets.
    let spec = single(&[("mu", "0.2"), ("clamp_width_m", "0.002")]).unwrap();
    assert_eq!(spec.scene.pin.elements, [12, 15, 10]);
    assert_contains(&single(&[]).unwrap_err().to_string(), &["grid.mu = [0.2, 0.4]: expected one value"]);
}

/// Protects: as a parameter of the grid each preset gives the jobs that it gives as the study's preset, and the name of the
/// preset is a parameter of the job like any other.
#[test]
fn a_preset_can_be_varied() {
    let study = parse(r#"{ "grid": { "preset": ["draft", "standard"], "mu": [0.2, 0.4] } }"#);
    let jobs = study.expand("1").unwrap();
    let names: Vec<&str> = jobs.iter().map(|job| job.parameters[0].1.as_str().unwrap()).collect();
    assert_eq!(names, ["draft", "draft", "standard", "standard"]);
    assert!(jobs.iter().all(|job| job.parameters[0].0 == "preset"));
    let alone =
        |preset: &str| parse(&format!(r#"{{ "preset": "{preset}", "grid": {{ "mu": [0.2, 0.4] }} }}"#));
    let expected = ["draft", "standard"].map(|preset| alone(preset).expand("1").unwrap()).concat();
    assert!(jobs.iter().map(|job| &job.key).eq(expected.iter().map(|job| &job.key)));
    // What is given takes precedence over each of the presets: these are one job.
    let given = r#"{ "scene": { "pin": { "elements": [6, 8, 5] } }, "numerics": { "safety_factor": 0.5 },
        "run": { "start": "rest" }, "stability": "simulate",
        "grid": { "preset": ["draft", "standard"], "tolerance": [0.1], "drift_tolerance": [0.01] } }"#;
    assert_eq!(parse(given).expand("1").unwrap().len(), 1);
}

/// Protects: the mesh of a preset fits the pin and the clamp of each job, not those of the study's scene, and the parts of
/// the mesh that the grid does not vary are the preset's.
#[test]
fn the_mesh_fits_every_job() {
    let meshes = |grid: &str| {
        let jobs = parse(&format!(r#"{{ "preset": "draft", "grid": {{ {grid} }} }}"#)).expand("1").unwrap();
        jobs.iter().map(|job| job.spec.scene.pin.elements).collect::<Vec<_>>()
    };
    assert_eq!(meshes(r#""size_z_m": [0.005, 0.01, 0.02]"#), [[24, 30, 10], [12, 15, 10], [12, 12, 17]]);
    assert_eq!(
        meshes(r#""clamp_side": ["both_sides"], "clamp_width_m": [0.001, 0.0015]"#),
        [[12, 15, 10], [16, 15, 10]]
    );
    assert_eq!(meshes(r#""nx": [6, 24]"#), [[6, 15, 10], [24, 15, 10]]);
}

/// The rows of docs/evidence/mesh_errors.csv, which `scripts/mesh_errors.py` makes the measured errors from.
fn measured_rows() -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path("docs/evidence/mesh_errors.csv").unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

/// Protects: the measured errors shipped with the program are those of the presets as they are now, and of this program: it computes the
/// same numbers. If this fails, run scripts/mesh_errors.py.
#[test]
fn the_evidence_is_of_these_presets() {
    let evidence = Evidence::measured();
    let names: Vec<&str> = evidence.presets.iter().map(|entry| entry.name.as_str()).collect();
    let of_one_mesh: Vec<_> = Preset::ALL.into_iter().filter(|preset| preset.accuracy().is_none()).collect();
    assert_eq!(names, of_one_mesh.iter().map(|preset| preset.name()).collect::<Vec<_>>());
    let costs: Vec<f64> = evidence.presets.iter().map(|entry| entry.relative_cost).collect();
    assert!(costs[0] < costs[1] && costs[1] == 1.0 && costs[1] < costs[2], "{costs:?}");
    for pair in evidence.presets.windows(2) {
        assert!(pair[0].mu_star_95 > pair[1].mu_star_95, "a finer mesh has smaller errors");
    }

    let rows = measured_rows();
    for (level, preset) in [("draft", "draft"), ("1", "standard")] {
        let is_this = |row: &&BTreeMap<String, String>| {
            row["scene"] == "reference" && row["level"] == level && row["status"] == "periodic"
        };
        let row = rows.iter().rev().find(is_this).unwrap();
        let number = |name: &str| row[name].parse::<f64>().unwrap();
        let mut spec = base(preset, "");
        spec.scene.pin.elements =
            ["x", "y", "z"].map(|axis| row[&format!("elements_{axis}")].parse().unwrap());
        spec.scene.contact.mu = number("mu");
        spec.scene.disk.omega_rpm = number("omega_rpm");
        let record = solve(&spec, &mut Unobserved).unwrap();
        // To rounding of the stored figures: between machines the last bits may differ.
        let same = |a: f64, b: f64| assert!((a / b - 1.0).abs() <= 1.0e-6, "{level}: {a} and {b}");
        same(record.mu_star, number("mu_star"));
        same(record.frequency_hz.unwrap(), number("frequency_hz"));
        same(record.time_step_s, number("time_step_s"));
    }
}

/// Protects: a preset can ask for an accuracy. It goes from mesh to mesh like a study that asks for it, and another preset that takes
/// precedence sets that aside.
#[test]
fn a_preset_can_ask_for_an_accuracy() {
    let asked = base("one_percent", "");
    assert_eq!(asked, base("standard", r#", "accuracy": { "mu_star": 0.01 }"#));
    assert_eq!(asked.scene.pin.elements, [48, 60, 40]);
    assert_eq!(base("two_percent", r#", "accuracy": { "mu_star": 0.05 }"#).accuracy.unwrap().mu_star, 0.05);
    let study = parse(r#"{ "accuracy": { "mu_star": 0.03 } }"#);
    let single = |preset| study.single_with_preset(Some(preset), &[]).unwrap();
    assert_eq!(single(Preset::Standard), base("standard", ""));
    assert_eq!(single(Preset::OnePercent), asked);
}

/// Protects: figure7 has the settings of the standard preset.
#[test]
fn figure7_has_the_standard_accuracy() {
    let figure7 = Study::load("studies/figure7.json".as_ref()).unwrap();
    let standard = base("standard", "");
    assert_eq!(figure7.base().scene.pin.elements, standard.scene.pin.elements);
    assert_eq!(figure7.base().numerics, standard.numerics);
    assert_eq!(figure7.base().detection, standard.detection);
    assert_eq!((&figure7.base().run, figure7.base().stability), (&standard.run, standard.stability));
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

/// Protects: an input is said to come from where it was given.
#[test]
fn inputs_know_who_gave_them() {
    let study = parse(
        r#"{ "preset": "draft", "scene": { "pin": { "size_m": [0.012, 0.015, 0.01] }, "load": { "force_n": 30 } },
             "detection": { "tolerance": 0.02 }, "grid": { "mu": [0.2, 0.4] } }"#,
    );
    let origin = |name: &str| study.origin(Parameter::find(name).unwrap()).name();
    for (name, expected) in [
        ("mu", "grid"),
        ("load_n", "study"),
        ("size_y_m", "study"),
        ("tolerance", "study"),
        ("nx", "preset"),
        ("safety_factor", "preset"),
        ("density_kg_m3", "default"),
        ("omega_rpm", "default"),
    ] {
        assert_eq!(origin(name), expected, "{name}");
    }
    let meshes = parse(r#"{ "grid": { "elements": [[6, 8, 5], [12, 15, 10]] } }"#);
    assert_eq!(meshes.origin(Parameter::find("ny").unwrap()).name(), "grid");
}

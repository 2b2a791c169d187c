//! Protects: an editor that uses the schema and the program agree on names and types.

use super::mini_schema::violation;
use super::{refusal, shipped};
use serde_json::{Value, json};
use tribosweep::spec::JobSpec;
use tribosweep::study::{PARAMETERS, Study, schema};

fn problem(study: &Value) -> Option<String> {
    let schema = schema();
    violation(&schema, &schema, study, "")
}

#[test]
fn the_shipped_studies_fit() {
    for file in shipped::files() {
        let study: Value = serde_json::from_str(&std::fs::read_to_string(&file).unwrap()).unwrap();
        assert_eq!(problem(&study), None, "{}", file.display());
    }
}

#[test]
fn a_complete_job_fits() {
    let mut spec = JobSpec::default();
    spec.numerics.time_step_s = Some(1.0e-8);
    assert_eq!(problem(&serde_json::to_value(spec).unwrap()), None);
}

/// Each is refused by the schema and by the program.
#[test]
fn wrong_names_and_types_are_rejected() {
    for study in [
        json!({ "grid": { "muu": [0.1] } }),
        json!({ "grid": {} }),
        json!({ "grid": null }),
        json!({ "grid": { "mu": [] } }),
        json!({ "grid": { "mu": [0.1, 0.1] } }),
        json!({ "grid": { "mu": 0.1 } }),
        json!({ "grid": { "mu": ["a"] } }),
        json!({ "grid": { "mu": { "from": 0.1, "to": 0.2 } } }),
        json!({ "grid": { "mu": { "from": 0.1, "to": 0.2, "count": 2, "step": 1 } } }),
        json!({ "grid": { "mu": { "from": 0.1, "to": 0.2, "count": 2, "spacing": "cubic" } } }),
        json!({ "grid": { "nx": [2.5] } }),
        json!({ "grid": { "nx": [0] } }),
        json!({ "grid": { "elements": [[1, 2]] } }),
        json!({ "grid": { "clamp_side": ["top"] } }),
        json!({ "grid": { "clamp_side": { "from": 1, "to": 2, "count": 2 } } }),
        json!({ "grid": { "stop_early": ["yes"] } }),
        json!({ "scene": { "contact": { "nu": 0.1 } } }),
        json!({ "scene": { "contact": [0.1] } }),
        json!({ "scene": { "pin": { "elements": [1, 2, 3, 4] } } }),
        json!({ "name": "a b" }),
        json!({ "mu": [0.1] }),
        json!([]),
    ] {
        assert!(problem(&study).is_some(), "the schema takes {study}");
        refusal(&study.to_string());
    }
}

/// Each is accepted by both.
#[test]
fn every_form_of_axis_is_accepted() {
    for study in [
        json!({}),
        json!({ "name": "a-B_1", "description": "x" }),
        json!({ "grid": { "mu": [0.1, 1], "nx": [2, 4], "stop_early": [true, false], "top": ["free_in_z"] } }),
        json!({ "grid": { "elements": [[1, 2, 3], [4, 5, 6]], "disk_kind": ["rigid"] } }),
        json!({ "grid": { "mu": { "from": 0.1, "to": 1, "count": 3, "spacing": "log" } } }),
        json!({ "grid": { "cycles": { "from": 10, "to": 20, "count": 2, "spacing": "linear" } } }),
    ] {
        assert_eq!(problem(&study), None, "{study}");
        assert!(Study::parse(&study.to_string(), "x").is_ok(), "{study}");
    }
}

#[test]
fn the_grid_has_exactly_the_parameters_of_the_registry() {
    let schema = schema();
    let grid = &schema["properties"]["grid"];
    let mut names: Vec<_> = PARAMETERS.iter().map(|parameter| parameter.name).collect();
    names.sort_unstable();
    let mut found: Vec<_> = grid["properties"].as_object().unwrap().keys().collect();
    found.sort_unstable();
    assert_eq!(found, names);
    assert_eq!(grid["additionalProperties"], Value::Bool(false));
    for parameter in PARAMETERS {
        assert_eq!(grid["properties"][parameter.name]["description"], parameter.doc);
    }
}

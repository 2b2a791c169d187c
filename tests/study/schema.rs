//! Protects: an editor that uses the schema and the program agree on names and types.

use super::keys::full;
use super::mini_schema::{KNOWN, for_each, violation};
use super::{refusal, shipped};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::sync::LazyLock;
use tribosweep::spec::{End, LIMITS, Limit, Program, Table};
use tribosweep::study::{PARAMETERS, Study, schema};

fn problem(study: &Value) -> Option<String> {
    static SCHEMA: LazyLock<Value> = LazyLock::new(schema);
    violation(&SCHEMA, &SCHEMA, study, "")
}

#[test]
fn the_shipped_studies_fit() {
    for file in shipped::files() {
        let study: Value = serde_json::from_str(&std::fs::read_to_string(&file).unwrap()).unwrap();
        assert_eq!(problem(&study), None, "{}", file.display());
    }
}

/// Asserts that the schema of an object has the fields of a value and no others, at any depth.
fn assert_same_fields(root: &Value, schema: &Value, value: &Value, at: &str) {
    let target = schema["$ref"].as_str().map(|target| root.pointer(target.trim_start_matches('#')).unwrap());
    let Some(fields) = target.unwrap_or(schema)["properties"].as_object() else { return };
    let values = value.as_object().unwrap_or_else(|| panic!("{at} is no object"));
    let names = [fields, values].map(|object| object.keys().collect::<BTreeSet<_>>());
    assert_eq!(names[0], names[1], "{at}");
    for (name, field) in fields {
        assert_same_fields(root, field, &values[name], &format!("{at}/{name}"));
    }
}

/// Protects: the schema has every field of a job, and besides these only what makes a study of a job.
#[test]
fn a_complete_job_fits() {
    let mut full = full();
    let table = || Some(Table(vec![[0.0, 7.0], [0.01, 7.0]]));
    full.scene.program = Program { omega_rpm: table(), force_n: table() };
    // The other value that this field can have; a spring in z is refused.
    full.scene.holder.stiffness_z_n_m = Some(0.0);
    let job = serde_json::to_value(full).unwrap();
    assert_eq!(problem(&job), None);
    let schema = schema();
    let mut parts = schema["properties"].as_object().unwrap().clone();
    for part in [
        "$schema",
        "name",
        "description",
        "preset",
        "damping",
        "sliding_speed_m_s",
        "grid",
        "samples",
        "include",
        "exclude",
        "refine",
        "continue",
        "calibrate",
        "derive",
        "report",
    ] {
        assert!(parts.remove(part).is_some(), "{part}");
    }
    assert_same_fields(&schema, &json!({ "properties": parts }), &job, "");
}

/// Protects: an editor can explain every field, knows that there is no other one, and offers defaults that are allowed.
#[test]
fn every_field_is_described() {
    let schema = schema();
    let mut described = 0;
    for_each(&schema, "", &mut |part: &Value, at: &str| {
        for keyword in part.as_object().unwrap().keys() {
            assert!(KNOWN.contains(&keyword.as_str()), "{at}: keyword {keyword} is not understood");
        }
        if part["type"] == "object" {
            assert_eq!(part["additionalProperties"], Value::Bool(false), "{at}");
        }
        for (name, field) in part["properties"].as_object().into_iter().flatten() {
            let text = field["description"].as_str().unwrap_or_default();
            assert!(text.split_whitespace().count() >= 2, "{at}/{name}: {text:?}");
            described += 1;
        }
        if let Some(default) = part.get("default") {
            assert_eq!(violation(&schema, part, default, at), None);
        }
    });
    // The grid alone has a field for each parameter.
    assert!(described > PARAMETERS.len(), "{described}");
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
        json!({ "grid": { "mu": ["1 m"] } }),
        json!({ "grid": { "load_n": ["much"] } }),
        json!({ "scene": { "load": { "force_n": "20" } } }),
        json!({ "scene": { "pin": { "poisson_ratio": "0.3 m" } } }),
        json!({ "grid": { "mu": { "from": 0.1, "to": 0.2 } } }),
        json!({ "grid": { "mu": { "from": 0.1, "to": 0.2, "count": 2, "step": 1 } } }),
        json!({ "grid": { "mu": { "from": 0.1, "to": 0.2, "count": 2, "spacing": "cubic" } } }),
        json!({ "grid": { "mu": { "from": 0.1, "to": 0.2, "count": 2, "digits": 0 } } }),
        json!({ "grid": { "mu": { "from": 0.1, "to": 0.2, "count": 2, "digits": 13 } } }),
        json!({ "$schema": 3 }),
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

/// Each is accepted by both and has so many grid points.
#[test]
fn every_form_of_axis_is_accepted() {
    for (study, points) in [
        (json!({}), 1),
        (json!({ "$schema": "https://example.org/study.schema.json" }), 1),
        (json!({ "grid": { "mu": { "from": 0.1, "to": 0.5, "step": 0.2, "digits": 3 } } }), 3),
        (json!({ "name": "a-B_1", "description": "x" }), 1),
        (json!({ "grid": { "load_n": ["20 N", "0.03 kN"] } }), 2),
        (json!({ "grid": { "omega_rpm": { "from": "20 rpm", "to": "1 Hz", "count": 3 } } }), 3),
        (json!({ "samples": { "points": [{ "load_n": "20 N", "mu": 0.3 }] } }), 1),
        (
            json!({ "scene": { "pin": { "size_m": ["8 mm", "1 cm", 0.012] }, "load": { "force_n": "30 N" } } }),
            1,
        ),
        (
            json!({ "grid": { "mu": [0.1, 1], "nx": [2, 4], "stop_early": [true, false], "top": ["free_in_z"] } }),
            8,
        ),
        (json!({ "grid": { "elements": [[1, 2, 3], [4, 5, 6]], "disk_kind": ["rigid"] } }), 2),
        (json!({ "grid": { "mu": { "from": 0.1, "to": 1, "count": 3, "spacing": "log" } } }), 3),
        (json!({ "grid": { "cycles": { "from": 10, "to": 20, "count": 2, "spacing": "linear" } } }), 2),
    ] {
        assert_eq!(problem(&study), None, "{study}");
        assert_eq!(Study::parse(&study.to_string(), "x").unwrap().grid_size(), points, "{study}");
    }
}

/// Protects: an editor offers no fixed default for a time that depends on the pin.
#[test]
fn times_that_depend_on_the_pin_have_no_default() {
    let schema = schema();
    let mut found = 0;
    for_each(&schema, "", &mut |part: &Value, at: &str| {
        for name in ["limit_s", "decay_observation_s", "ramp_s"] {
            assert_eq!(part.pointer(&format!("/default/{name}")), None, "{at}/{name}");
            if let Some(field) = part.pointer(&format!("/properties/{name}"))
                && !["grid", "Samples", "samples", "include", "exclude", "scale", "MeasuredPoint", "derive"]
                    .iter()
                    .any(|part| at.contains(part))
            {
                assert_eq!(field.get("default"), None, "{at}/{name}");
                let text: Vec<_> = field["description"].as_str().unwrap().split_whitespace().collect();
                assert!(text.join(" ").contains("Absent in a study: 0.0"), "{at}/{name}");
                found += 1;
            }
        }
    });
    assert_eq!(found, 3);
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
        assert_eq!(grid["properties"][parameter.name]["description"], parameter.doc());
    }
}

/// Values just outside of a limit, and those at its ends that are allowed.
fn around(limit: &Limit) -> (Vec<f64>, Vec<f64>) {
    let is_whole = ["elements[]", "count", "seed", "cycles"].iter().any(|name| limit.field.ends_with(name));
    let step = |value: f64| if is_whole { 1.0 } else { 1.0e-9 * value.abs().max(1.0e-12) };
    let (mut outside, mut inside) = (Vec::new(), Vec::new());
    for (end, sign) in [(limit.low, -1.0), (limit.high, 1.0)] {
        match end {
            End::Open => {}
            End::At(value) => {
                outside.push(value + sign * step(value));
                inside.push(value);
            }
            End::Beyond(value) => {
                outside.push(value);
                inside.push(value - sign * step(value));
            }
        }
    }
    (outside, inside)
}

/// A study in which nothing but the field has a value of its own, besides what makes the program look at the field.
fn study_with(limit: &Limit, value: f64) -> Value {
    let number =
        if value.fract() == 0.0 && value.abs() < 1.0e15 { json!(value as i64) } else { json!(value) };
    let mut study = match limit.field {
        field if field.contains(".ring.") => json!({ "scene": { "disk": { "kind": "elastic" } } }),
        field if field.contains(".mesh.") => json!({ "scene": { "pin": { "shape": "mesh" } } }),
        field if field.contains(".diameter_m") => {
            json!({ "scene": { "pin": { "shape": "cylinder", "elements": [12, 12, 10] } } })
        }
        field if field.contains(".height_map.") => {
            json!({ "scene": { "pin": { "base": { "height_map": { "heights_m": [[0, 1e-7], [0, 0]] } } } } })
        }
        field if field.contains(".regions[]") => {
            let region = json!({ "above_m": 0.005, "young_modulus_pa": 2e9, "poisson_ratio": 0.3, "density_kg_m3": 2000 });
            json!({ "scene": { "pin": { "regions": [region] } } })
        }
        field if field.contains(".roughness.") => {
            json!({ "scene": { "pin": { "base": { "roughness": { "longest_m": 0.008, "shortest_m": 0.004 } } } } })
        }
        "scene.disk.waviness_count" => json!({ "scene": { "disk": { "waviness_height_m": 1e-6 } } }),
        "scene.pin.size_m[]" => json!({ "scene": { "pin": { "size_m": [0.012, 0.015, 0.010] } } }),
        "scene.pin.elements[]" => json!({ "scene": { "pin": { "elements": [12, 15, 10] } } }),
        "scene.program.omega_rpm[][]" => {
            json!({ "scene": { "program": { "omega_rpm": [[0, 7], [0.01, 7]] } } })
        }
        "scene.program.force_n[][]" => json!({ "scene": { "program": { "force_n": [[0, 7], [0.01, 7]] } } }),
        "scene.contact.mu_of_speed[][]" => {
            json!({ "scene": { "contact": { "mu_of_speed": [[0, 0.5], [1, 0.4]] } } })
        }
        "damping.holder_ratio" => json!({ "scene": { "holder": { "stiffness_y_n_m": 2e6 } } }),
        "damping.frequency_hz" => json!({ "damping": { "ratio": 0.1 } }),
        field if field.starts_with("damping.") => json!({ "damping": { "frequency_hz": 15000 } }),
        _ => json!({}),
    };
    let mut place = &mut study;
    for step in limit.field.replace("[]", ".1").replace("regions.1", "regions.0").split('.') {
        place = match step.parse::<usize>() {
            Ok(index) => &mut place[index],
            Err(_) => &mut place[step],
        };
    }
    *place = number;
    study
}

/// Protects: what the program refuses because of the value of a single field, an editor with the schema marks, at both ends of every
/// limit, in the fields and in the grid; and the schema takes what the limit allows.
#[test]
fn the_schema_has_the_limits_of_the_program() {
    for limit in LIMITS {
        let name = limit.field.trim_end_matches("[]").rsplit('.').next().unwrap();
        let (outside, inside) = around(limit);
        assert!(!outside.is_empty(), "{} has no limit", limit.field);
        for value in outside {
            assert!(!limit.holds(value), "{} = {value}", limit.field);
            let study = study_with(limit, value);
            assert!(problem(&study).is_some(), "the schema takes {study}");
            let message = refusal(&study.to_string());
            assert!(message.contains(name), "{study}: {message}");
        }
        for value in inside {
            let study = study_with(limit, value);
            assert_eq!(problem(&study), None, "{study}");
        }
    }
    let mut of_grid = 0;
    for parameter in PARAMETERS {
        let Some(limit) = Limit::of(&parameter.field()) else { continue };
        for value in around(limit).0 {
            let value =
                if value.fract() == 0.0 && value.abs() < 1.0e15 { json!(value as i64) } else { json!(value) };
            for axis in [json!([value]), json!({ "from": value, "to": value, "count": 1 })] {
                let study = json!({ "grid": { parameter.name: axis } });
                assert!(problem(&study).is_some(), "the schema takes {study}");
                // Some fields are looked at only beside others, as above.
                let is_used = !limit.field.contains(".ring.") && !limit.field.contains(".diameter_m");
                assert!(
                    !is_used || Study::parse(&study.to_string(), "x").is_err(),
                    "the program takes {study}"
                );
            }
            of_grid += 1;
        }
    }
    assert!(of_grid > 80, "{of_grid}");
}

/// Words of units at the ends of names.
#[cfg(feature = "report")]
const UNIT_WORDS: [&str; 15] =
    ["rpm", "deg", "rad", "kg", "m", "m2", "m3", "s", "s2", "n", "nm", "pa", "hz", "j", "per"];

/// Protects: the unit at the end of a name is the whole unit, and a name with a unit that nobody knows is noticed: no word of a unit is left
/// in front of it. All parameters and columns have their units from their names.
#[cfg(feature = "report")]
#[test]
fn names_end_with_their_units() {
    let parameters = PARAMETERS.iter().map(|parameter| (parameter.name, parameter.unit));
    let columns =
        tribosweep::report::columns::fixed().map(|own| (&*own.column.head.name, &*own.column.head.unit));
    let mut with_unit = 0;
    for (name, unit) in parameters.chain(columns) {
        let (stem, of_name) = tribosweep::units::name_and_unit(name);
        assert_eq!(of_name, unit, "{name}");
        let last = stem.rsplit('_').next().unwrap();
        assert!(!UNIT_WORDS.contains(&last), "{name}: {stem} [{unit}]");
        with_unit += usize::from(!unit.is_empty());
    }
    assert!(with_unit > 90, "{with_unit}");
}

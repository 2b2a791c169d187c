//! Protects: nothing unusable is accepted, and each message names file, position, field, value and
//! what is expected.

use super::{assert_contains, parse, refusal};
use tribosweep::study::{MAX_JOBS, Study, StudyError};

#[test]
fn a_missing_file_is_named() {
    let error = Study::load("studies/no_such_study.json".as_ref()).unwrap_err();
    assert!(matches!(error, StudyError::Read { .. }));
    assert_contains(&error.to_string(), &["studies/no_such_study.json: cannot be read: "]);
}

#[test]
fn broken_json_is_reported_with_line_and_column() {
    assert_contains(&refusal("{\n  \"scene\": {,\n"), &["studies/x.json:2:13: not valid JSON: "]);
    assert_contains(
        &refusal("{ \"run\": { \"limit_s\": 1e999 } }"),
        &["the number is too large for a double"],
    );
    // A position that an editor can go to, although serde_json reports column 0.
    assert_contains(&refusal(""), &["studies/x.json:1:1: not valid JSON: "]);
}

#[test]
fn positions_count_characters_and_lines_past_strings_that_look_like_json() {
    let text = "{\n  \"description\": \"μ \\\" } ] , {\", \"scene\": { \"contact\": { \"mu\": -1 } } }";
    let column = text.lines().nth(1).unwrap().chars().position(|c| c == '-').unwrap() + 1;
    assert_contains(&refusal(text), &[&format!("studies/x.json:2:{column}: scene.contact.mu = -1: ")]);
}

#[test]
fn repeated_keys_are_refused_at_any_depth_and_spelling() {
    let axes = "{ \"grid\": { \"mu\": [0.1],\n \"m\\u0075\": [0.2] } }";
    assert_contains(&refusal(axes), &["studies/x.json:2:2: grid.mu = [0.2]: ", "twice", "first at 1:13"]);
    let scenes = r#"{ "scene": {}, "scene": { "contact": { "mu": 0.1 } } }"#;
    assert_contains(&refusal(scenes), &["studies/x.json:1:16: scene = ", "twice"]);
    let deep = r#"{ "scene": { "contact": { "mu": 0.1, "mu": 0.2 } } }"#;
    assert_contains(&refusal(deep), &["scene.contact.mu = 0.2", "twice"]);
    // The same key in two objects is no repetition.
    parse(
        r#"{ "grid": { "mu": { "from": 0.1, "to": 0.2, "count": 2 }, "load_n": { "from": 1, "to": 2, "count": 2 } } }"#,
    );
}

#[test]
fn unknown_fields_are_refused_with_a_suggestion() {
    let typo = r#"{ "scene": { "pin": { "poison_ratio": 0.3 } } }"#;
    let expected =
        ["studies/x.json:1:23: scene.pin.poison_ratio = 0.3: no such field", "did you mean `poisson_ratio`?"];
    assert_contains(&refusal(typo), &expected);
    assert_contains(&refusal(r#"{ "mu": 3 }"#), &["studies/x.json:1:3: mu = 3: no such field", "`grid`"]);
    // The name of a parameter where its field belongs. Elsewhere it is no field of any kind.
    let load = refusal(r#"{ "scene": { "load": { "load_n": 3 } } }"#);
    assert_contains(&load, &["scene.load.load_n = 3: no such field", "did you mean `force_n`?"]);
    let elsewhere = refusal(r#"{ "scene": { "disk": { "load_n": 3 } } }"#);
    assert!(!elsewhere.contains("did you mean"), "{elsewhere}");
}

#[test]
fn wrong_types_are_refused() {
    for (text, expected) in [
        (
            r#"{ "scene": { "contact": { "mu": "high" } } }"#,
            r#"1:33: scene.contact.mu = "high": expected a number"#,
        ),
        (
            r#"{ "scene": { "pin": { "elements": [1, 2.5, 3] } } }"#,
            "scene.pin.elements[1] = 2.5: expected a whole number",
        ),
        (
            r#"{ "scene": { "pin": { "elements": [1, 2] } } }"#,
            "scene.pin.elements = [1, 2]: expected a list of 3",
        ),
        (
            r#"{ "scene": { "pin": { "elements": [1, 2, 3, 4] } } }"#,
            "scene.pin.elements = [1, 2, 3, 4]: expected fewer",
        ),
        (r#"{ "scene": { "pin": 4 } }"#, "scene.pin = 4: expected an object"),
        (r#"{ "scene": { "clamp": { "side": 3 } } }"#, "scene.clamp.side = 3: expected a name"),
        (r#"{ "scene": { "clamp": { "side": "inner" } } }"#, "did you mean `inner_side`?"),
        (r#"{ "run": { "stop_early": 1 } }"#, "run.stop_early = 1: expected true or false"),
        (r#"{ "description": 3 }"#, "description = 3: expected a string"),
        (r#"{ "grid": null }"#, "grid = null: expected an object"),
        (r#"{ "grid": [1] }"#, "grid = [1]: expected an object"),
        ("[]", "the study = []: expected an object"),
    ] {
        assert_contains(&refusal(text), &["studies/x.json:1:", expected]);
    }
}

/// Protects: unknown fields, wrong types and wrong axes of a file come at once, in the order of the file, each once and
/// without problems that follow from another one.
#[test]
fn all_problems_of_a_file_come_at_once() {
    let text = r#"{
        "name": 7,
        "scene": {
            "contact": { "mu": "high", "nu": 1 },
            "pin": { "poison_ratio": 0.3, "size_m": ["a", 0.01, "c"], "elements": [1, 2] },
            "clamp": []
        },
        "numerics": { "time_step_s": "small" },
        "grid": { "mu": ["x"], "omga": [1], "load_n": { "from": "a", "to": 2, "cout": 3 } },
        "more.dots": 1
    }"#;
    let StudyError::Invalid(problems) = Study::parse(text, "studies/my study.json").unwrap_err() else {
        panic!("{text}");
    };
    let fields: Vec<_> = problems.iter().map(|problem| problem.field.as_str()).collect();
    assert_eq!(
        fields,
        [
            "name",
            "scene.contact.mu",
            "scene.contact.nu",
            "scene.pin.poison_ratio",
            "scene.pin.size_m[0]",
            "scene.pin.size_m[2]",
            "scene.pin.elements",
            "scene.clamp",
            "numerics.time_step_s",
            "grid.mu[0]",
            "grid.omga",
            "grid.load_n.from",
            "grid.load_n.cout",
            "more.dots",
        ]
    );
    assert!(problems.windows(2).all(|pair| pair[0].position < pair[1].position), "{problems:?}");
    // A missing field is a problem only where no other field of the object is wrong.
    assert_contains(
        &refusal(r#"{ "grid": { "mu": { "from": 0.1, "to": 0.2 } } }"#),
        &["expected `count` or `step`"],
    );
    assert!(!refusal(r#"{ "grid": { "mu": { "from": 0.1, "to": 0.2, "cout": 2 } } }"#).contains("missing"));
    let many: Vec<String> = (0..3000).map(|number| format!("\"x{number}\": 1")).collect();
    assert_contains(
        &refusal(&format!("{{ {} }}", many.join(", "))),
        &["x0 = 1: no such field", "more problems"],
    );
}

/// serde would read a list as the fields of a structure in their order of declaration.
#[test]
fn lists_in_place_of_objects_are_refused() {
    let text = r#"{ "scene": { "contact": [0.3] } }"#;
    assert_contains(&refusal(text), &["1:25: scene.contact = [0.3]: expected an object"]);
    let text = r#"{ "scene": { "clamp": { "side": { "both_ends": null } } } }"#;
    assert_contains(&refusal(text), &["scene.clamp.side = ", "expected a name"]);
}

#[test]
fn names_that_no_file_or_table_could_carry_are_refused() {
    assert_contains(&refusal(r#"{ "name": "a b" }"#), &[r#"1:11: name = "a b": expected a name of letters"#]);
    assert_contains(&refusal(r#"{ "name": "" }"#), &["name = \"\": expected"]);
    let from_file = Study::parse("{}", "studies/my study.json").unwrap_err().to_string();
    assert_contains(&from_file, &["my study", "from the file's name", "add \"name\""]);
    assert_eq!(Study::parse("{}", "studies/my-study_2.json").unwrap().name(), "my-study_2");
    assert_eq!(parse(r#"{ "name": "other" }"#).name(), "other");
}

#[test]
fn empty_grids_and_axes_are_refused_with_advice() {
    assert_contains(
        &refusal(r#"{ "grid": {} }"#),
        &["1:11: grid = {}: expected at least one parameter", "leave"],
    );
    assert_contains(
        &refusal(r#"{ "grid": { "mu": [] } }"#),
        &["1:19: grid.mu = []: expected at least one value", "leave"],
    );
}

#[test]
fn unknown_parameters_are_refused_with_a_suggestion_and_the_list() {
    for (wrong, meant) in [
        ("omega", "omega_rpm"),
        ("Mu", "mu"),
        ("clampside", "clamp_side"),
        // By the name of the field in the rest of the file.
        ("force_n", "load_n"),
        ("scene.disk.track_radius_m", "track_radius_m"),
    ] {
        let text = refusal(&format!(r#"{{ "grid": {{ "{wrong}": [1] }} }}"#));
        let suggestion = format!("did you mean `{meant}`?");
        assert_contains(
            &text,
            &["1:13: grid.", wrong, "no such parameter", &suggestion, "`tribosweep parameters` lists all"],
        );
    }
    let far = refusal(r#"{ "grid": { "zzz": [1] } }"#);
    assert!(!far.contains("did you mean"), "{far}");
}

#[test]
fn overlapping_parameters_are_refused_in_either_order() {
    for (first, second) in [("elements", "nx"), ("ny", "elements")] {
        let axis = |name| if name == "elements" { "[[6, 8, 5]]" } else { "[6]" };
        let (a, b) = (axis(first), axis(second));
        let text = refusal(&format!(r#"{{ "grid": {{ "{first}": {a}, "{second}": {b} }} }}"#));
        assert_contains(&text, &[&format!("grid.{second} = {b}: sets the same field as grid.{first}")]);
    }
    parse(r#"{ "grid": { "nx": [6], "ny": [8], "size_x_m": [0.01] } }"#);
}

#[test]
fn axis_values_of_the_wrong_type_are_refused_one_by_one() {
    let text = refusal(
        r#"{ "grid": { "mu": [0.1, "a", null], "clamp_side": ["inner"], "nz": [2.5], "elements": [[1, 2]],
        "omega_rpm": 3, "top": { "from": 1, "to": 2, "count": 3 }, "load_n": [[1]] } }"#,
    );
    let expected = [
        r#"1:25: grid.mu[1] = "a": expected a number"#,
        "grid.mu[2] = null: expected a value",
        r#"grid.clamp_side[0] = "inner": expected one of `inner_side`"#,
        "did you mean `inner_side`?",
        "grid.nz[0] = 2.5: expected a whole number",
        "grid.elements[0] = [1, 2]: expected a list of 3",
        "2:22: grid.omega_rpm = 3: expected a list of values or a range",
        "grid.top = { \"from\": 1, \"to\": 2, \"count\": 3 }: expected a list of values",
        "grid.load_n[0] = [1]: expected a number",
    ];
    assert_contains(&text, &expected);
}

#[test]
fn equal_values_in_a_list_are_refused_however_they_are_written() {
    for list in ["[0.1, 0.2, 1e-1]", "[7, 7.0]", "[0, -0.0]"] {
        let text = refusal(&format!(r#"{{ "grid": {{ "mu": {list} }} }}"#));
        assert_contains(&text, &["the same value as grid.mu[0]"]);
    }
    let meshes = refusal(r#"{ "grid": { "elements": [[6, 8, 5], [6.0, 8, 5]] } }"#);
    assert_contains(&meshes, &["grid.elements[1] = [6.0, 8, 5]: the same value as grid.elements[0]"]);
}

#[test]
fn unusable_ranges_are_refused() {
    for (range, expected) in [
        (
            r#"{ "from": 0, "to": 2, "count": 3, "spacing": "log" }"#,
            "grid.mu.from = 0: expected a number > 0",
        ),
        (
            r#"{ "from": 1, "to": -2, "count": 3, "spacing": "log" }"#,
            "grid.mu.to = -2: expected a number > 0",
        ),
        (r#"{ "from": 1, "to": 2, "count": 1 }"#, "grid.mu.count = 1: expected at least 2"),
        (r#"{ "from": 1, "to": 2, "count": 0 }"#, "grid.mu.count = 0: expected at least 2"),
        (r#"{ "from": 1, "to": 1, "count": 2 }"#, "grid.mu.count = 2: expected 1"),
        (r#"{ "from": 1, "to": 2, "count": 1000001 }"#, "grid.mu.count = 1000001: expected at most 1000000"),
        (r#"{ "from": 1, "to": 2, "count": 2.5 }"#, "grid.mu.count = 2.5: expected a whole number"),
        (r#"{ "from": 1, "to": 2 }"#, "expected `count` or `step`"),
        (r#"{ "from": 1, "to": 2, "count": null }"#, "grid.mu.count = null: expected a whole number"),
        (
            r#"{ "from": 1, "to": 2, "count": 2, "step": 1 }"#,
            "grid.mu.step = 1: expected either count or step",
        ),
        (r#"{ "from": 1, "to": 2, "step": 0 }"#, "grid.mu.step = 0: expected a step > 0 and at most 1,"),
        (
            r#"{ "from": 1, "to": 2, "step": -0.5 }"#,
            "grid.mu.step = -0.5: expected a step > 0 and at most 1,",
        ),
        (
            r#"{ "from": 2, "to": 1, "step": 0.5 }"#,
            "grid.mu.step = 0.5: expected a step < 0 and at least -1,",
        ),
        (r#"{ "from": 1, "to": 2, "step": 1.5 }"#, "grid.mu.step = 1.5: expected a step > 0 and at most 1,"),
        (r#"{ "from": 1, "to": 1, "step": 1 }"#, "grid.mu.step = 1: expected count = 1 instead"),
        (
            r#"{ "from": 0, "to": 1, "step": 1e-7 }"#,
            "grid.mu.step = 1e-7: expected a larger step, for at most 1000000",
        ),
        (
            r#"{ "from": 1, "to": 2, "step": 1, "spacing": "log" }"#,
            "grid.mu.step = 1: expected count instead",
        ),
        (
            r#"{ "from": 1, "to": 2, "count": 9, "digits": 1 }"#,
            "grid.mu.digits = 1: after 1 comes 1; expected more digits",
        ),
        (
            r#"{ "from": 1, "to": 2, "count": 3, "digits": 13 }"#,
            "grid.mu.digits = 13: expected a number of digits from 1",
        ),
        (
            r#"{ "from": 1.04, "to": 1.06, "count": 3, "digits": 2 }"#,
            "grid.mu.digits = 2: after 1.1 comes 1.06",
        ),
        (r#"{ "from": 1, "to": 2, "cuont": 3 }"#, "grid.mu.cuont = 3: no such field"),
        (r#"{ "from": 1, "to": 2, "count": 3, "spacing": "lin" }"#, "did you mean `linear`?"),
        (r#"{ "from": 1, "to": 1.0000000000000002, "count": 5 }"#, "the same value as grid.mu, value 1 of 5"),
    ] {
        assert_contains(
            &refusal(&format!(r#"{{ "grid": {{ "mu": {range} }} }}"#)),
            &["studies/x.json:1:", expected],
        );
    }
    let counts = refusal(r#"{ "grid": { "nx": { "from": 4, "to": 5, "count": 3 } } }"#);
    assert_contains(&counts, &["grid.nx = ", "4.5", "whole numbers only"]);
}

#[test]
fn grids_that_explode_are_refused_with_their_size() {
    let grid = |count| {
        format!(
            r#"{{ "grid": {{ "mu": {{ "from": 0, "to": 1, "count": 2000 }},
                "omega_rpm": {{ "from": 1, "to": 5, "count": {count} }} }} }}"#
        )
    };
    let error = Study::parse(&grid(501), "studies/x.json").unwrap_err();
    assert!(matches!(error, StudyError::TooManyJobs { points: 1_002_000, .. }));
    assert_contains(
        &error.to_string(),
        &["studies/x.json: grid: 1002000 jobs", "mu 2000 × omega_rpm 501", "1000000"],
    );
    assert_eq!(parse(&grid(500)).grid_size(), MAX_JOBS);
}

#[test]
fn non_physical_values_of_the_base_job_are_all_reported_with_their_position() {
    let text = refusal(
        "{ \"scene\": { \"pin\": { \"poisson_ratio\": 0.5 },\n  \"contact\": { \"mu\": -0.1 } },\n  \"numerics\": { \"beta2\": 2 } }",
    );
    let expected = [
        "studies/x.json:1:40: scene.pin.poisson_ratio = 0.5: expected a Poisson's ratio with -1 < ν < 0.5",
        "studies/x.json:2:22: scene.contact.mu = -0.1: expected a friction coefficient >= 0",
        "studies/x.json:3:26: numerics.beta2 = 2: expected 0.5 <= β₂ <= 1",
    ];
    assert_contains(&text, &expected);
    assert_eq!(text.lines().count(), 3, "{text}");
}

/// Protects: a magnitude that would overflow before the first step is refused with the range, not as non-positive.
#[test]
fn magnitudes_out_of_range_are_refused() {
    for (field, value, expected) in [
        (r#""pin": { "young_modulus_pa": 1e300 }"#, "young_modulus_pa = 1e300", "from 1e-20 to 1e20"),
        (r#""pin": { "density_kg_m3": 1e-210 }"#, "density_kg_m3 = 1e-210", "from 1e-20 to 1e20"),
        (r#""disk": { "omega_rpm": 3e166 }"#, "omega_rpm = 3e166", "from 1e-20 to 1e20"),
        (r#""pin": { "size_m": [0.01, 1e-30, 0.01] }"#, "size_m[1] = 1e-30", "from 1e-20 to 1e20"),
        (r#""contact": { "mu": 1e21 }"#, "mu = 1e21", "at most 1e20"),
        (r#""clamp": { "width_m": 1e21 }"#, "width_m = 1e21", "at most 1e20"),
    ] {
        assert_contains(&refusal(&format!("{{ \"scene\": {{ {field} }} }}")), &[value, expected]);
    }
}

#[test]
fn non_physical_grid_values_are_reported_once_each_and_named() {
    let text = refusal(
        r#"{ "scene": { "disk": { "omega_rpm": -7 } }, "grid": { "mu": [0.2, -1, 0.4, -3],
        "omega_rpm": { "from": -1, "to": 98, "count": 100 }, "elements": [[6, 8, 5], [6, 0, 5]] } }"#,
    );
    let expected = [
        "studies/x.json:1:67: scene.contact.mu = -1: expected a friction coefficient >= 0\n  help: set by grid.mu[1]",
        "scene.contact.mu = -3: ",
        "studies/x.json:2:22: scene.disk.omega_rpm = -1: ",
        "set by grid.omega_rpm, value 1 of 100",
        "scene.pin.elements[1] = 0: expected a number of elements",
        "set by grid.elements[1]",
    ];
    assert_contains(&text, &expected);
    for once in ["scene.contact.mu = -1", "scene.disk.omega_rpm = -1", "scene.pin.elements[1] = 0"] {
        assert_eq!(text.matches(once).count(), 1, "{text}");
    }
    // No job has the base job's own speed.
    assert!(!text.contains("-7"), "{text}");
}

#[test]
fn incompatible_values_are_reported_with_a_job_that_has_them() {
    let ramp = r#""scene": { "load": { "ramp_s": 0.0005 } }"#;
    let text =
        refusal(&format!(r#"{{ {ramp}, "grid": {{ "mu": [0.2, 0.4, 0.6], "limit_s": [0.1, 0.0001] }} }}"#));
    let expected = [
        "studies/x.json:1:34: scene.load.ramp_s = 0.0005: expected less than the run's time limit (run.limit_s = 0.0001)",
        "in 3 of 6 jobs, first in the one with mu = 0.2, limit_s = 0.0001",
    ];
    assert_contains(&text, &expected);
}

#[test]
fn long_listings_are_cut_and_counted() {
    let text = refusal(r#"{ "grid": { "mu": { "from": -50, "to": -1, "count": 50 } } }"#);
    assert_contains(&text, &["scene.contact.mu = -31", "… and 30 more problems"]);
    assert!(!text.contains("scene.contact.mu = -30:"), "{text}");
    let error = Study::parse(r#"{ "grid": { "mu": [-1, -2] } }"#, "x").unwrap_err();
    assert_eq!(error.problems().len(), 2);
    assert_eq!(error.problems()[1].field, "scene.contact.mu");
    assert_eq!(error.problems()[1].value.as_deref(), Some("-2"));
}

/// Protects: an elastic disk that is too small for the pin, or that the pin would leave, is refused with the value it
/// needs; the ring of a rigid disk is not checked.
#[test]
fn disks_that_do_not_fit_are_refused() {
    let ring = |kind: &str, ring: &str, rest: &str| {
        format!(r#"{{ "scene": {{ "disk": {{ "kind": "{kind}", "ring": {{ {ring} }} }} }}{rest} }}"#)
    };
    for (values, rest, expected) in [
        (r#""inner_radius_m": 0.09"#, "", vec!["ring.inner_radius_m = 0.09", "at most 0.0829", "inner side"]),
        (
            r#""outer_radius_m": 0.095"#,
            "",
            vec!["ring.outer_radius_m = 0.095", "at least 0.100", "outer corners"],
        ),
        (r#""thickness_m": 0"#, "", vec!["ring.thickness_m = 0", "a length > 0 m"]),
        (r#""young_modulus_pa": -1"#, "", vec!["ring.young_modulus_pa = -1", "a modulus > 0 Pa"]),
        (r#""poisson_ratio": 0.5"#, "", vec!["ring.poisson_ratio = 0.5", "ν < 0.5"]),
        (
            r#""element_size_m": 0.02"#,
            "",
            vec!["coarse_element_size_m = 0.012", "at least element_size_m = 0.02"],
        ),
        (
            r#""element_size_m": 1e-5"#,
            "",
            vec!["ring.element_size_m = 0.00001", "no more than 2000 elements"],
        ),
        (
            r#""element_size_m": 3e-4, "coarse_element_size_m": 3e-4"#,
            "",
            vec!["larger elements", "nodes, at most 2e6"],
        ),
        (r#""track_arc_deg": 400"#, "", vec!["ring.track_arc_deg = 400", "track_arc_deg <= 360"]),
        (
            r#""track_arc_deg": 10"#,
            r#", "grid": { "omega_rpm": [7, 100] }"#,
            vec!["ring.track_arc_deg = 10", "at least 24.0000", "100 rpm", "limit_s = 0.04"],
        ),
        ("", r#", "numerics": { "beta2": 0.6 }"#, vec!["numerics.beta2 = 0.6", "0.5 with an elastic disk"]),
        ("", r#", "run": { "start": "nested" }"#, vec!["run.start = nested", "rest with an elastic disk"]),
        (
            "",
            r#", "numerics": { "precision": "single" }"#,
            vec!["numerics.precision = single: expected double with an elastic disk"],
        ),
        (r#""elements": [1, 2, 3]"#, "", vec!["scene.disk.ring.elements", "no such field"]),
    ] {
        assert_contains(&refusal(&ring("elastic", values, rest)), &expected);
    }
    // One element beyond the pin on either side is enough, and so is an arc exactly as long as the swept one.
    parse(&ring("elastic", r#""inner_radius_m": 0.0829, "outer_radius_m": 0.100189"#, ""));
    parse(&ring("elastic", r#""track_arc_deg": 24"#, r#", "grid": { "omega_rpm": [100] }"#));
    parse(&ring(
        "rigid",
        r#""inner_radius_m": 0.09"#,
        r#", "numerics": { "beta2": 0.6, "precision": "single" }, "run": { "start": "nested" }"#,
    ));
}

/// Protects: a report's axes are parameters, and a misspelt one is refused at its place with a suggestion.
#[test]
fn axes_of_the_report_are_parameters() {
    let study = parse(
        r#"{ "report": { "x": "mu", "by": "clamp_side", "y": ["n_over_f_max"] }, "grid": { "mu": [0.1, 0.2] } }"#,
    );
    let report = study.report();
    assert_eq!((report.x.as_deref(), report.by.as_deref()), (Some("mu"), Some("clamp_side")));
    assert_eq!(report.y, ["n_over_f_max"]);
    assert_contains(
        &refusal(r#"{ "report": { "x": "omega_rpn" } }"#),
        &[r#"studies/x.json:1:20: report.x = "omega_rpn": no such parameter"#, "did you mean `omega_rpm`?"],
    );
    assert_contains(
        &refusal(r#"{ "report": { "x": "mu", "by": "mu" } }"#),
        &["report.by", "expected another parameter"],
    );
    assert_contains(&refusal(r#"{ "report": { "z": "mu" } }"#), &["report.z", "no such field", "`x`"]);
    assert_contains(&refusal(r#"{ "report": { "x": 3 } }"#), &["report.x = 3: expected a name"]);
}

/// Protects: a program that is no table over the time of the run is refused with the point and its value.
#[test]
fn programs_that_are_no_tables_are_refused() {
    for (program, expected) in [
        (r#""omega_rpm": [[0, 1]]"#, "scene.program.omega_rpm = 1 points: expected at least two points"),
        (r#""omega_rpm": []"#, "scene.program.omega_rpm = 0 points: expected at least two points"),
        (
            r#""omega_rpm": [[0, 1], [0.02, 5], [0.01, 7]]"#,
            "scene.program.omega_rpm[2] = 0.01: expected times that ascend",
        ),
        (
            r#""omega_rpm": [[-0.01, 1], [0.02, 5]]"#,
            "scene.program.omega_rpm[0] = -0.01: expected a time >= 0",
        ),
        (
            r#""omega_rpm": [[0.01, 1], [0.01, 2], [0.01, 3]]"#,
            "scene.program.omega_rpm[2] = 0.01: expected at most two points at the same time",
        ),
        (
            r#""omega_rpm": [[0, 1], [0.05, 5]]"#,
            "scene.program.omega_rpm[1] = 0.05: expected a time within the run",
        ),
        (
            r#""omega_rpm": [[0, -1], [0.02, 5]]"#,
            "scene.program.omega_rpm[0] = -1: expected a speed >= 0 rpm",
        ),
        (r#""force_n": [[0, 30], [0.02, 0]]"#, "scene.program.force_n[1] = 0: expected a load > 0 N"),
        (r#""omega_rpm": [[0, 1, 2], [0.02, 5]]"#, "scene.program.omega_rpm[0] = [0, 1, 2]: expected fewer"),
        (r#""omega_rpm": 7"#, "scene.program.omega_rpm = 7: expected"),
        (r#""speed": []"#, "scene.program.speed = []: no such field"),
    ] {
        let text =
            format!(r#"{{ "scene": {{ "program": {{ {program} }} }}, "run": {{ "limit_s": 0.04 }} }}"#);
        assert_contains(&refusal(&text), &["studies/x.json:1:", expected]);
    }
    let of = |scene: &str, rest: &str| {
        refusal(&format!(
            r#"{{ "scene": {{ {scene} "program": {{ "omega_rpm": [[0, 1], [0.02, 5]] }} }} {rest} }}"#
        ))
    };
    let twice = of(r#""disk": { "omega_rpm": 7 },"#, "");
    assert_contains(&twice, &["scene.disk.omega_rpm = 7: expected absent, or 5, the largest value"]);
    let swept = of("", r#", "grid": { "omega_rpm": [5, 7] }"#);
    assert_contains(&swept, &["7: expected absent, or 5"]);
    let elastic = of(r#""disk": { "kind": "elastic" },"#, "");
    assert_contains(&elastic, &["scene.program.omega_rpm = ", "expected absent with an elastic disk"]);
    let still = refusal(r#"{ "scene": { "program": { "omega_rpm": [[0, 0], [0.02, 0]] } } }"#);
    assert_contains(&still, &["scene.program.omega_rpm = all values 0: expected at least one value > 0"]);
    let windows = refusal(r#"{ "run": { "window_s": 0.001 } }"#);
    assert_contains(&windows, &["run.window_s = ", "expected absent without scene.program"]);
    assert_contains(&of("", r#", "run": { "window_s": 1 }"#), &["run.window_s = 1: expected a length"]);
}

/// Protects: what holds for small strains alone is refused with large ones.
#[test]
fn large_strains_refuse_what_is_linear() {
    for (pin, other, field) in [
        ("", r#""scene": { "disk": { "kind": "elastic" } }"#, "scene.disk.kind = elastic"),
        ("", r#""numerics": { "precision": "single" }"#, "numerics.precision = single"),
        ("", r#""numerics": { "beta2": 0.6 }"#, "numerics.beta2 = 0.6"),
        (r#", "element": "incompatible""#, r#""name": "a""#, "scene.pin.element = incompatible"),
    ] {
        let pin = format!(r#""pin": {{ "strains": "finite"{pin} }}"#);
        let text = match other.strip_prefix(r#""scene": {"#) {
            Some(rest) => format!(r#"{{ "scene": {{ {pin}, {rest} }}"#),
            None => format!(r#"{{ "scene": {{ {pin} }}, {other} }}"#),
        };
        assert_contains(&refusal(&text), &[field, "with scene.pin.strains = finite"]);
    }
}

/// Protects: what yields says when, and a yield stress that nothing uses is refused. A curve of hardening begins at the yield stress and does not fall.
#[test]
fn what_yields_says_when() {
    let pin = |fields: &str| refusal(&format!(r#"{{ "scene": {{ "pin": {{ {fields} }} }} }}"#));
    let j2 = |plasticity: &str| {
        pin(&format!(r#""strains": "finite", "material": "j2", "plasticity": {{ {plasticity} }}"#))
    };
    let stress = r#""yield_stress_pa": 3e8"#;
    for (text, expected) in [
        (
            pin(r#""strains": "finite", "material": "j2""#),
            "scene.pin.plasticity = absent: expected an object with yield_stress_pa",
        ),
        (
            pin(&format!(r#""material": "j2", "plasticity": {{ {stress} }}"#)),
            "scene.pin.strains = small: expected finite",
        ),
        (
            pin(&format!(r#""strains": "finite", "plasticity": {{ {stress} }}"#)),
            "expected absent, or scene.pin.material = j2",
        ),
        (j2(""), "scene.pin.plasticity.yield_stress_pa = absent: expected a stress > 0 Pa"),
        (j2(r#""yield_stress_pa": 0"#), "scene.pin.plasticity.yield_stress_pa = 0: expected a stress > 0 Pa"),
        (
            j2(&format!(r#"{stress}, "hardening_modulus_pa": -1"#)),
            "hardening_modulus_pa = -1: expected a modulus >= 0 Pa",
        ),
        (
            j2(&format!(r#"{stress}, "saturation_stress_pa": 1e8"#)),
            "saturation_strain = absent: expected a number",
        ),
        (j2(&format!(r#"{stress}, "rate_exponent": 4"#)), "rate_reference_per_s = absent: expected a number"),
        (
            j2(&format!(r#"{stress}, "hardening_curve": [[0, 2e8], [0.1, 4e8]]"#)),
            "hardening_curve[0] = [0, 200000000]: expected [0, 300000000]",
        ),
        (
            j2(&format!(r#"{stress}, "hardening_curve": [[0, 3e8], [0.1, 2e8]]"#)),
            "hardening_curve[1] = [0.1, 200000000]: expected a larger plastic strain",
        ),
        (
            j2(&format!(r#"{stress}, "hardening_modulus_pa": 1, "hardening_curve": [[0, 3e8]]"#)),
            "hardening_modulus_pa = 1: expected absent",
        ),
    ] {
        assert_contains(&text, &[expected]);
    }
    // A parameter may be the first thing that a job says of its plasticity.
    let only = r#"{ "scene": { "pin": { "strains": "finite", "material": "j2" } }, "grid": { "kinematic_modulus_pa": [1e8] } }"#;
    assert_contains(&refusal(only), &["scene.pin.plasticity.yield_stress_pa = absent"]);
}

/// Protects: an accuracy is a share of μ*, and is asked for only where there are meshes to go through and a steady state.
#[test]
fn an_accuracy_needs_meshes_and_a_steady_state() {
    for wrong in ["0", "-0.01", "1.5"] {
        let text = refusal(&format!(r#"{{ "accuracy": {{ "mu_star": {wrong} }} }}"#));
        assert_contains(&text, &[&format!("accuracy.mu_star = {wrong}")]);
    }
    assert_contains(&refusal(r#"{ "accuracy": 0.01 }"#), &["accuracy = 0.01: expected"]);
    assert_contains(&refusal(r#"{ "accuracy": {} }"#), &["accuracy", "mu_star"]);
    for (other, why) in [
        (r#""scene": { "disk": { "kind": "elastic" } }"#, "absent on an elastic disk"),
        (
            r#""scene": { "pin": { "element": "incompatible" } }"#,
            "absent with large strains or another element",
        ),
        (r#""scene": { "pin": { "strains": "finite" } }"#, "absent with large strains or another element"),
        (r#""numerics": { "time_step_s": 1e-8 }"#, "absent with numerics.time_step_s"),
        (
            r#""scene": { "program": { "omega_rpm": [[0, 1], [0.04, 9]] } }, "run": { "limit_s": 0.04, "window_s": 0.01 }"#,
            "absent with scene.program",
        ),
    ] {
        for asked in [r#""accuracy": { "mu_star": 0.02 }"#, r#""preset": "two_percent""#] {
            assert_contains(&refusal(&format!("{{ {asked}, {other} }}")), &["accuracy", why]);
        }
    }
}

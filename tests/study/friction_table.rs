//! Protects: a friction table is read with its study, is as it is without a μ and in proportion to a given one, and one that is no function is
//! refused at its place.

use serde_json::{Value, json};
use tribosweep::study::{Study, StudyError};

const PAIRS: [[f64; 2]; 4] = [[0.0, 0.5], [0.01, 0.4], [0.1, 0.25], [1.0, 0.3]];

fn with_table(table: &Value) -> Value {
    json!({ "name": "table", "scene": { "contact": { "law": "table", "mu_of_speed": table } }, "grid": { "omega_rpm": [7, 35] } })
}

fn parsed(study: &Value) -> Result<Study, StudyError> {
    Study::parse(&study.to_string(), "x.json")
}

fn refusal(study: &Value) -> String {
    parsed(study).unwrap_err().to_string()
}

fn mus(study: &Value) -> Vec<f64> {
    parsed(study).unwrap().expand("1").unwrap().iter().map(|job| job.spec.scene.contact.mu).collect()
}

/// Protects: nobody has to write the last coefficient twice, and a μ that is given in any way scales the table.
#[test]
fn mu_is_that_of_the_last_speed() {
    let mut study = with_table(&json!(PAIRS));
    assert_eq!(mus(&study), [0.3, 0.3]);
    study["grid"] = json!({ "mu": [0.2, 0.4] });
    assert_eq!(mus(&study), [0.2, 0.4]);
    study["grid"] = json!({ "friction_law": ["coulomb", "table"] });
    assert_eq!(mus(&study), [0.4, 0.3], "Coulomb's law has the default");
    study["scene"]["contact"]["mu"] = 0.35.into();
    assert_eq!(mus(&study), [0.35, 0.35]);
    let jobs = parsed(&study).unwrap().expand("1").unwrap();
    let at_rest = |mu: f64| mu / 0.3 * 0.5;
    let law = tribosweep::solver::interface::law::Law::of(&jobs[1].spec.scene.contact);
    assert!((law.steady(0.0).unwrap()[0] - at_rest(0.35)).abs() < 1e-15);
}

/// Protects: what is tied to μ does not take the default of μ for that of the table.
#[test]
fn a_tie_needs_a_mu_that_is_given() {
    let mut study = with_table(&json!(PAIRS));
    study["derive"] = json!({ "load_n": "100 * mu" });
    let message = refusal(&study);
    assert!(message.contains("expected a value of mu in the study or its grid"), "{message}");
    study["scene"]["contact"]["mu"] = 0.3.into();
    assert!((parsed(&study).unwrap().expand("1").unwrap()[0].spec.scene.load.force_n - 30.0).abs() < 1e-12);
}

/// Protects: the jobs of a file are those of its pairs, and need the file no more.
#[test]
fn a_file_stands_for_its_pairs() {
    let folder = tempfile::tempdir().unwrap();
    let keys = |study: &Study| study.expand("1").unwrap().into_iter().map(|job| job.key).collect::<Vec<_>>();
    let inline = parsed(&with_table(&json!(PAIRS))).unwrap();
    let path = folder.path().join("table.json");
    std::fs::write(&path, with_table(&json!("mu.csv")).to_string()).unwrap();
    for text in [
        "speed_m_s,mu\n0,0.5\n0.01,0.4\n0.1,0.25\n1,0.3\n",
        "# POM\n0; 0,5;\n1e-2; 0.4;\n0.1; 0.25;\n1; 0.3;",
    ] {
        std::fs::write(folder.path().join("mu.csv"), text).unwrap();
        let study = Study::load(&path).unwrap();
        assert_eq!(keys(&study), keys(&inline), "{text}");
        let stored = Study::parse_stored(&study.document(), "table", None).unwrap();
        assert_eq!(keys(&stored), keys(&inline));
        assert!(!study.document().contains("mu.csv"));
    }
    let long = (0..17).map(|row| format!("{row},0.3")).collect::<Vec<_>>().join("\n");
    for (text, expected) in [
        ("0,0.5\n0.1", "mu.csv:2: 1 numbers: expected 2"),
        ("0,0.5,1\n0.1,0.3,1", "3 columns: expected two, the slip speed in m/s and the friction coefficient"),
        ("0,0.5\n0.1,x", "mu.csv:2: `x` at place 2: expected a number"),
        (&long, "17 pairs: expected from 2 to 16 pairs"),
    ] {
        std::fs::write(folder.path().join("mu.csv"), text).unwrap();
        let message = Study::load(&path).unwrap_err().to_string();
        assert!(
            message.contains(expected) && message.contains("scene.contact.mu_of_speed"),
            "{text}: {message}"
        );
    }
    std::fs::remove_file(folder.path().join("mu.csv")).unwrap();
    assert!(Study::load(&path).unwrap_err().to_string().contains("mu.csv: cannot be read"));
}

/// Protects: pairs that are no function of the speed are refused, each at its place and with what would be right.
#[test]
fn a_table_that_is_no_function_is_refused() {
    for (table, expected) in [
        (
            json!([[0, 0.5], [0.1, 0.4], [0.1, 0.3]]),
            "scene.contact.mu_of_speed[2] = 0.1: expected one coefficient for each speed",
        ),
        (
            json!([[0, 0.5], [0.1, 0.4], [0.05, 0.3]]),
            "scene.contact.mu_of_speed[2] = 0.05: expected speeds that ascend",
        ),
        (
            json!([[0.01, 0.5], [0.1, 0.4]]),
            "scene.contact.mu_of_speed[0] = 0.01: expected the speed 0, with the coefficient at rest",
        ),
        (json!([[0, 0.5], [1e-300, 0.4], [1, 0.3]]), "a speed at least 1e-12 m/s above the one before"),
        (json!([[0, 0.5]]), "1 pairs: expected from 2 to 16 pairs"),
        (json!([[0, 0.5], [1, 0]]), "expected a coefficient > 0 at the last speed"),
        (
            json!([[0, -0.5], [1, 0.3]]),
            "scene.contact.mu_of_speed[0][1] = -0.5: expected pairs of a slip speed >= 0 m/s and a friction coefficient >= 0",
        ),
        (json!([[0, 0.5, 1], [1, 0.3, 1]]), "scene.contact.mu_of_speed[0]"),
        (json!(0.3), "scene.contact.mu_of_speed"),
    ] {
        let message = refusal(&with_table(&table));
        assert!(message.contains(expected), "{table}: {message}");
    }
    let mut absent = with_table(&json!([]));
    assert!(
        refusal(&absent).contains("scene.contact.mu_of_speed = absent: expected pairs"),
        "{}",
        refusal(&absent)
    );
    absent["scene"]["contact"] = json!({ "law": "table" });
    assert!(refusal(&absent).contains("for the friction law table"), "{}", refusal(&absent));
}

/// Protects: a table that the law does not use is named, and is no part of a job.
#[test]
fn another_law_does_not_use_it() {
    let mut study = with_table(&json!(PAIRS));
    study["scene"]["contact"]["law"] = "coulomb".into();
    let parsed = parsed(&study).unwrap();
    let warnings = parsed.warnings();
    assert!(
        warnings.iter().any(|warning| warning.to_string().contains("the laws table")
            || warning.to_string().contains("the law table")),
        "{warnings:?}"
    );
    assert!(parsed.expand("1").unwrap()[0].spec.scene.contact.in_use().mu_of_speed.is_empty());
}

/// Protects: studies that differ in their tables alone do not pass for the same, and the inputs of a job have its table.
#[test]
fn a_table_is_an_input() {
    let law = |table: &Value| {
        let study = parsed(&with_table(table)).unwrap();
        let inputs = tribosweep::study::inputs(&study.expand("1").unwrap()[0].spec);
        inputs.iter().find(|input| input.parameter.name == "friction_law").unwrap().value.clone()
    };
    assert_eq!(law(&json!([[0, 0.5], [1, 0.3]])), "table {0: 0.5, 1: 0.3}");
    assert_ne!(law(&json!([[0, 0.5], [1, 0.3]])), law(&json!([[0, 0.6], [1, 0.3]])));
}

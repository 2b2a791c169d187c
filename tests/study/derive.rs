//! Protects: tied parameters have the values of their expressions in every job, however its points are made, and expressions that cannot be
//! used are refused at their place.

use serde_json::{Value, json};
use tribosweep::study::{Changes, Parameter, Study};

fn parsed(study: &Value) -> Study {
    Study::parse(&study.to_string(), "x.json").unwrap_or_else(|error| panic!("{error}"))
}

fn mu_static(study: &Study) -> Vec<f64> {
    study.expand("1").unwrap().iter().map(|job| job.spec.scene.contact.mu_static.unwrap()).collect()
}

fn tied(text: &str) -> Value {
    json!({ "scene": { "contact": { "law": "static_kinetic" } }, "derive": { "mu_static": text }, "grid": { "mu": [0.3, 0.4] } })
}

/// Protects: a tie follows the points of grids, samples, and points that are added; the jobs are those that list the values.
#[test]
fn ties_follow_their_parameters() {
    let study = parsed(&tied("1.4 * mu"));
    assert_eq!(mu_static(&study), [0.42, 0.56]);
    // The study gave the value.
    assert_eq!(study.origin(Parameter::find("mu_static").unwrap()).name(), "study");
    let mut listed = tied("1");
    listed.as_object_mut().unwrap().remove("derive");
    listed["scene"]["contact"]["mu_static"] = 0.42.into();
    listed["grid"]["mu"] = json!([0.3]);
    assert_eq!(study.expand("1").unwrap()[0].key, parsed(&listed).expand("1").unwrap()[0].key);
    let added = study.job_at(&[("mu".to_owned(), 0.35.into())], "1").unwrap();
    assert_eq!(added.spec.scene.contact.mu_static, Some(0.49));
    let mut samples = tied("mu + 0.1");
    samples["samples"] = json!({ "points": [{ "mu": 0.2, "omega_rpm": 7 }, { "mu": 0.25, "omega_rpm": 9 }] });
    samples.as_object_mut().unwrap().remove("grid");
    assert_eq!(mu_static(&parsed(&samples)), [0.3, 0.35]);
    let stored = Study::parse_stored(&study.document(), "x", None).unwrap();
    assert_eq!(stored.expand("1").unwrap(), study.expand("1").unwrap());
}

/// Protects: ties of ties come in the right order, whatever the order of the file, and the usual rules of arithmetic hold.
#[test]
fn expressions_are_those_of_arithmetic() {
    let mut chain = tied("friction_speed_m_s + mu");
    chain["derive"]["friction_speed_m_s"] = "2e-1 * 2 ^ 2 - 0.3 / 3 * sqrt(4)".into();
    chain["scene"]["contact"]["law"] = "exponential".into();
    let study = parsed(&chain);
    let job = &study.expand("1").unwrap()[0];
    assert_eq!(job.spec.scene.contact.speed_m_s, Some(0.6));
    assert_eq!(job.spec.scene.contact.mu_static, Some(0.9));
}

/// Protects: `--set` of a tied parameter takes the place of its tie, in the document too.
#[test]
fn a_setting_replaces_a_tie() {
    let changes =
        Changes { settings: vec![("mu_static".to_owned(), "0.7".to_owned())], ..Changes::default() };
    let study = Study::parse_changed(&tied("2 * mu").to_string(), "x.json", &changes).unwrap();
    assert_eq!(mu_static(&study), [0.7, 0.7]);
    assert!(!study.document().contains("derive"), "{}", study.document());
}

/// Protects: each mistake is named with its place, and with what would be right.
#[test]
fn mistakes_are_named() {
    let refusal = |study: &Value, expected: &str| {
        let error = Study::parse(&study.to_string(), "x.json").unwrap_err().to_string();
        super::assert_contains(&error, &[expected]);
    };
    refusal(&tied("1.4 * muu"), "derive.mu_static = \"1.4 * muu\": muu: no such parameter");
    refusal(&tied("1.4 * muu"), "did you mean `mu`?");
    refusal(&tied("1.4 * * mu"), "derive.mu_static = \"1.4 * * mu\": not an expression");
    for unclear in ["-2^2", "-mu^2", "2^3^2", "exp(-mu^2)", "2 * -(1 + mu)^2", "-sqrt(mu)^2", "(-mu^2)"] {
        refusal(&tied(unclear), "unclear order of powers; expected brackets");
    }
    for clear in ["2 - mu^2", "2 * mu^2", "(1 - mu)^2 / mu^2", "2^(-1)", "1 - (-mu)^2"] {
        Study::parse(&tied(clear).to_string(), "x.json").unwrap();
    }
    refusal(&tied("friction_law"), "friction_law is no number");
    refusal(&tied("mu_static + 1"), "they depend on each other in a circle: mu_static");
    refusal(&tied("1 / (mu - mu)"), "expected an expression with a finite value");
    refusal(&tied("-1 * mu"), "mu_static");
    refusal(&tied("ramp_s"), "expected a value of ramp_s in the study or its grid");
    let mut circle = tied("friction_speed_m_s");
    circle["derive"]["friction_speed_m_s"] = "mu_static".into();
    refusal(&circle, "in a circle: friction_speed_m_s, mu_static");
    circle["derive"]["young_modulus_pa"] = "friction_speed_m_s * 1e9".into();
    refusal(&circle, "in a circle: friction_speed_m_s, mu_static");
    let mut both = tied("2 * mu");
    both["grid"]["mu_static"] = json!([0.5]);
    refusal(&both, "mu_static varies it, too; expected only one of the two");
    let mut given = tied("2 * mu");
    given["scene"]["contact"]["mu_static"] = json!(0.5);
    refusal(&given, "scene.contact.mu_static gives it, too");
    let mut unknown = tied("2 * mu");
    unknown["derive"] = json!({ "muu": "1" });
    refusal(&unknown, "no such parameter");
    unknown["derive"] = json!({ "mu_static": 1.4 });
    refusal(&unknown, "expected an expression as a text");
    unknown["derive"] = json!({ "nx": "12" });
    refusal(&unknown, "expected a parameter that is a number with decimals");
}

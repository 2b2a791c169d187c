//! Protects: `--preset`, `--set` and `--name` make a study that is written down as a study file, and messages name them.

use super::assert_contains;
use tribosweep::study::{Changes, Preset, Study};

const FILE: &str = r#"{
  "description": "what it is for",
  "scene": { "pin": { "elements": [24, 30, 20] }, "load": { "force_n": 12 } },
  "numerics": { "beta_r_s": 5e-8, "time_step_s": 1e-7 },
  "grid": { "omega_rpm": { "from": 1, "to": 3, "count": 3 }, "mu": [0.2, 0.4] }
}"#;

fn changes(preset: Option<Preset>, settings: &[(&str, &str)]) -> Changes {
    let settings = settings.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
    Changes { preset, settings, ..Changes::default() }
}

/// The changed study. Its document is parsed again and must say the same.
fn changed(text: &str, changes: &Changes) -> Study {
    let study = Study::parse_changed(text, "x.json", changes).unwrap_or_else(|error| panic!("{error}"));
    let again = Study::parse(&study.document(), study.name()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((again.name(), again.description()), (study.name(), study.description()));
    assert_eq!(again.expand("1").unwrap(), study.expand("1").unwrap(), "{}", study.document());
    assert_eq!(again.document(), study.document());
    study
}

fn refused(text: &str, changes: &Changes) -> String {
    Study::parse_changed(text, "x.json", changes).expect_err("it is refused").to_string()
}

fn axes(study: &Study) -> String {
    let axis = |(parameter, values): (&tribosweep::study::Parameter, &[serde_json::Value])| {
        format!("{} {}", parameter.name, serde_json::to_string(values).unwrap())
    };
    study.axes().map(axis).collect::<Vec<_>>().join(", ")
}

#[test]
fn without_changes_the_document_is_the_file() {
    assert_eq!(changed(FILE, &Changes::default()).document(), FILE);
}

/// Protects: a value fixes a parameter, a list becomes an axis or replaces one in its place, and what is set before is the
/// slowest as before.
#[test]
fn values_fix_parameters_and_lists_vary_them() {
    let study = changed(FILE, &changes(None, &[("mu", "0.3"), ("load_n", "[20, 10]")]));
    assert_eq!(axes(&study), "omega_rpm [1.0,2.0,3.0], load_n [20.0,10.0]");
    assert_eq!(study.base().scene.contact.mu, 0.3);
    let study = changed(FILE, &changes(None, &[("omega_rpm", "[7]"), ("elements", "[[6,8,5],[12,15,10]]")]));
    assert_eq!(axes(&study), "omega_rpm [7.0], mu [0.2,0.4], elements [[6,8,5],[12,15,10]]");
    let range = r#"{ "from": 0.1, "to": 0.3, "count": 3 }"#;
    assert_eq!(
        axes(&changed(FILE, &changes(None, &[("mu", range), ("omega_rpm", "7")]))),
        "mu [0.1,0.2,0.3]"
    );
    // A part of a list that the file gives, and of one that it does not give.
    let study = changed(FILE, &changes(None, &[("nx", "6"), ("size_z_m", "0.02")]));
    let pin = &study.expand("1").unwrap()[0].spec.scene.pin;
    assert_eq!((pin.elements, pin.size_m), ([6, 30, 20], [0.012, 0.015, 0.02]));
    // A study that needs the change to be valid.
    let missing = r#"{ "damping": { "ratio": 0.02 } }"#;
    changed(missing, &changes(None, &[("damping_frequency_hz", "15000")]));
}

/// Protects: `--preset` takes precedence over the file and its grid, `--set` over the preset, and the name tells the study
/// from the file's.
#[test]
fn a_preset_replaces_what_it_covers() {
    let file = FILE.replace("\"mu\"", "\"tolerance\": [0.1, 0.2], \"mu\"");
    let study = changed(&file, &changes(Some(Preset::Draft), &[("drift_tolerance", "0.5")]));
    assert_eq!((study.name(), axes(&study).as_str()), ("x-draft", "omega_rpm [1.0,2.0,3.0], mu [0.2,0.4]"));
    let job = study.base();
    assert_eq!((job.scene.pin.elements, job.numerics.time_step_s), ([12, 15, 10], None));
    assert_eq!((job.detection.tolerance, job.detection.drift_tolerance), (0.03, 0.5));
    let named = Changes { name: Some("other".to_owned()), ..changes(Some(Preset::Draft), &[]) };
    assert_eq!(changed(FILE, &named).name(), "other");
    // As a parameter it has the same precedence, and the name stays.
    let study = changed(&file, &changes(None, &[("preset", r#"["draft", "standard"]"#)]));
    let meshes: Vec<_> = study.expand("1").unwrap().iter().map(|job| job.spec.scene.pin.elements).collect();
    assert_eq!((study.name(), meshes.len()), ("x", 12));
    assert_eq!([meshes[0], meshes[1]], [[12, 15, 10], [24, 30, 20]]);
}

/// Protects: of several ways to say the same the one on the command line counts.
#[test]
fn a_setting_sets_other_ways_to_say_it_aside() {
    let study =
        changed(FILE, &changes(None, &[("damping_ratio", "0.02"), ("damping_frequency_hz", "15000")]));
    assert_eq!(study.base().numerics.beta_r_s, 0.02 / (std::f64::consts::PI * 15_000.0));
    let damped = r#"{ "damping": { "ratio": 0.02, "frequency_hz": 15000 }, "grid": { "mu": [0.2, 0.4] } }"#;
    assert_eq!(changed(damped, &changes(None, &[("beta_r_s", "0")])).base().numerics.beta_r_s, 0.0);
    let by_loss = changed(damped, &changes(None, &[("loss_factor", "0.04")]));
    assert_eq!(
        by_loss.expand("1").unwrap()[0].key,
        changed(damped, &changes(None, &[])).expand("1").unwrap()[0].key
    );
    let study = changed(FILE, &changes(None, &[("safety_factor", "0.5")]));
    assert_eq!((study.base().numerics.time_step_s, study.base().numerics.safety_factor), (None, 0.5));
}

#[test]
fn messages_name_the_place() {
    for (settings, expected) in [
        (vec![("muu", "1")], "--set: muu = 1: no such parameter"),
        (vec![("mu", "x")], "--set: mu = x: expected a number"),
        (vec![("mu", "[]")], "--set: grid.mu = []: expected at least one value"),
        (vec![("mu", "[0.1, \"x\"]")], "--set: grid.mu[1] = [0.1, \"x\"]: expected a number"),
        (vec![("mu", "-1")], "--set: scene.contact.mu = -1: expected a friction coefficient"),
        (vec![("mu", "[0.1, -1]")], "--set: scene.contact.mu = -1: expected a friction coefficient"),
        (vec![("loss_factor", "0.1")], "--set: damping.loss_factor = 0.1: expected the frequency too"),
        (vec![("damping_ratio", "0.1"), ("beta_r_s", "0")], "--set: numerics.beta_r_s = 0: expected either"),
        (vec![("preset", "drafty")], "--set: preset = drafty: expected"),
        (vec![("elements", "[[1,1,1]]"), ("nx", "2")], "--set: nx = 2: elements is already set"),
    ] {
        assert_contains(&refused(FILE, &changes(None, &settings)), &[expected]);
    }
    let error = refused(FILE, &changes(Some(Preset::Draft), &[("preset", "draft")]));
    assert_contains(&error, &["--set: preset = draft: preset is already set"]);
    for (text, list) in [
        ("[100 rpm, 300 rpm]", r#"a list is ["100 rpm", "300 rpm"]"#),
        ("[7,20", "a list is [7, 20]"),
        ("[.2, +3,]", "a list is [0.2, 3]"),
    ] {
        let error = refused(FILE, &changes(None, &[("omega_rpm", text)]));
        assert_contains(&error, &["expected a number", list]);
    }
    let meshes = r#"{ "grid": { "elements": [[4, 4, 4], [6, 6, 6]] } }"#;
    assert_contains(
        &refused(meshes, &changes(None, &[("nx", "5")])),
        &["--set: nx = 5: grid.elements varies the same"],
    );
    let named = Changes { name: Some("a b".to_owned()), ..Changes::default() };
    assert_contains(&refused(FILE, &named), &["--name: name = a b: expected a name of letters"]);
    // What the file gives is still found in the file.
    let wrong = FILE.replace("12", "-12");
    assert_contains(
        &refused(&wrong, &changes(None, &[("mu", "0.3")])),
        &["x.json:3:72: scene.load.force_n = -12"],
    );
}

//! Protects: `--set` selects exactly one job, and messages say what is missing or wrong.

use super::{assert_contains, message, parse};
use tribosweep::spec::{ClampSide, JobSpec, TopFace};
use tribosweep::study::{PARAMETERS, Study, StudyError};

const GRID: &str = r#"{ "scene": { "load": { "force_n": 12 } }, "grid": { "mu": [0.2, 0.4], "omega_rpm": [2, 7], "beta2": [0.6] } }"#;

fn single(study: &Study, overrides: &[(&str, &str)]) -> Result<JobSpec, StudyError> {
    let overrides: Vec<_> =
        overrides.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    study.single(&overrides)
}

fn refused(text: &str, overrides: &[(&str, &str)]) -> String {
    message(&single(&parse(text), overrides).unwrap_err())
}

#[test]
fn overrides_and_single_values_fix_the_grid() {
    let spec = single(&parse(GRID), &[("omega_rpm", "7"), ("mu", "0.35"), ("limit_s", "1e-2")]).unwrap();
    let mut expected = JobSpec::default();
    expected.scene.load.force_n = 12.0;
    expected.scene.disk.omega_rpm = 7.0;
    expected.scene.contact.mu = 0.35;
    expected.numerics.beta2 = 0.6;
    expected.run.limit_s = 0.01;
    assert_eq!(spec, expected);
    // An override takes precedence over the grid's single value.
    let spec = single(&parse(GRID), &[("omega_rpm", "7"), ("mu", "0.2"), ("beta2", "0.7")]).unwrap();
    assert_eq!(spec.numerics.beta2, 0.7);
}

#[test]
fn a_selected_job_is_the_job_of_the_grid() {
    let study = parse(GRID);
    let jobs = study.expand("1").unwrap();
    assert_eq!(single(&study, &[("mu", "0.4"), ("omega_rpm", "2")]).unwrap(), jobs[2].spec);
}

#[test]
fn values_are_json_or_names_or_meshes() {
    let overrides = [
        ("clamp_side", "both_ends"),
        ("top", "\"free_in_z\""),
        ("elements", "6x8x5"),
        ("stop_early", "false"),
        ("time_step_s", "1e-8"),
    ];
    let spec = single(&parse("{}"), &overrides).unwrap();
    assert_eq!(spec.scene.clamp.side, ClampSide::BothEnds);
    assert_eq!(spec.scene.top, TopFace::FreeInZ);
    assert_eq!(spec.scene.pin.elements, [6, 8, 5]);
    assert!(!spec.run.stop_early);
    assert_eq!(spec.numerics.time_step_s, Some(1.0e-8));
    assert_eq!(single(&parse("{}"), &[("elements", "[6, 8, 5]")]).unwrap().scene.pin.elements, [6, 8, 5]);
}

#[test]
fn open_parameters_are_listed_with_their_values() {
    let text = refused(GRID, &[("limit_s", "0.1")]);
    let expected = [
        "studies/x.json:1:59: grid.mu = [0.2, 0.4]: expected one value",
        "--set mu=0.2",
        "grid.omega_rpm = [2.0, 7.0]: expected one value",
    ];
    assert_contains(&text, &expected);
    assert!(!text.contains("beta2"), "{text}");
}

#[test]
fn a_mesh_override_fixes_its_directions_but_not_the_reverse() {
    let directions = r#"{ "grid": { "nx": [4, 6] } }"#;
    assert_eq!(single(&parse(directions), &[("elements", "5x5x5")]).unwrap().scene.pin.elements, [5, 5, 5]);
    let meshes = r#"{ "grid": { "elements": [[4, 4, 4], [6, 6, 6]] } }"#;
    assert_contains(
        &refused(meshes, &[("nx", "5")]),
        &["grid.elements = [[4,4,4], [6,6,6]]: expected one value"],
    );
}

#[test]
fn wrong_overrides_are_all_refused() {
    let overrides = [
        ("omega", "3"),
        ("mu", ".4."),
        ("elements", "3x4"),
        ("top", "free"),
        ("load_n", "null"),
        ("nx", "3"),
        ("ramp_s", "0"),
        ("ramp_s", "1e-4"),
    ];
    let expected = [
        "--set: omega = 3: no such parameter\n  help: did you mean `omega_rpm`?",
        "--set: mu = .4.: expected a number\n  help: `mu`: local friction coefficient",
        "--set: elements = 3x4: expected a list of 3",
        "--set: top = free: expected `tied_in_z` or `free_in_z` (did you mean `free_in_z`?)",
        "--set: load_n = null: expected a value",
        "--set: nx = 3: elements is already set",
        "--set: ramp_s = 1e-4: ramp_s is already set",
    ];
    let text = refused("{}", &overrides);
    assert_contains(&text, &expected);
    assert!(!text.contains("ramp_s = 0:"), "{text}");
}

#[test]
fn the_selected_job_is_checked() {
    assert_contains(&refused("{}", &[("mu", "-1")]), &["--set: scene.contact.mu = -1: expected a friction"]);
    // The limit is overridden, the ramp that no longer fits is the file's.
    let ramp = r#"{ "scene": { "load": { "ramp_s": 0.01 } } }"#;
    let expected =
        ["studies/x.json:1:34: scene.load.ramp_s = 0.01: expected less than", "run.limit_s = 0.005"];
    assert_contains(&refused(ramp, &[("limit_s", "0.005")]), &expected);
}

/// A pointer that misses its field would let any value pass and change nothing.
#[test]
fn every_parameter_of_the_registry_reaches_its_field() {
    let study = parse("{}");
    for parameter in PARAMETERS {
        let text = message(&single(&study, &[(parameter.name, "{\"no\": 1}")]).unwrap_err());
        assert_contains(&text, &[&format!("--set: {} = ", parameter.name), "expected", &parameter.doc()]);
        let same_name = PARAMETERS.iter().filter(|other| other.name == parameter.name).count();
        let same_field = PARAMETERS.iter().filter(|other| other.pointer == parameter.pointer).count();
        assert_eq!((same_name, same_field), (1, 1), "{}", parameter.name);
    }
}

/// The documented short names.
#[test]
fn the_registry_sets_these_fields() {
    let set = |name, value| single(&parse("{}"), &[(name, value)]).unwrap();
    assert_eq!(set("load_n", "31").scene.load.force_n, 31.0);
    assert_eq!(set("ramp_s", "1e-5").scene.load.ramp_s, 1.0e-5);
    assert_eq!(set("track_radius_m", "0.2").scene.disk.track_radius_m, 0.2);
    assert_eq!(set("young_modulus_pa", "2e9").scene.pin.young_modulus_pa, 2.0e9);
    assert_eq!(set("poisson_ratio", "0.2").scene.pin.poisson_ratio, 0.2);
    assert_eq!(set("density_kg_m3", "1000").scene.pin.density_kg_m3, 1000.0);
    assert_eq!(set("nx", "3").scene.pin.elements, [3, 15, 10]);
    assert_eq!(set("ny", "3").scene.pin.elements, [12, 3, 10]);
    assert_eq!(set("nz", "3").scene.pin.elements, [12, 15, 3]);
    assert_eq!(set("size_x_m", "0.02").scene.pin.size_m, [0.02, 0.015, 0.01]);
    assert_eq!(set("size_y_m", "0.02").scene.pin.size_m, [0.012, 0.02, 0.01]);
    assert_eq!(set("size_z_m", "0.02").scene.pin.size_m, [0.012, 0.015, 0.02]);
    assert_eq!(set("clamp_width_m", "0.002").scene.clamp.width_m, 0.002);
    assert_eq!(set("beta_r_s", "0").numerics.beta_r_s, 0.0);
    assert_eq!(set("safety_factor", "0.5").numerics.safety_factor, 0.5);
    assert_eq!(set("average_last_fraction", "0.5").run.average_last_fraction, 0.5);
    assert_eq!(set("cycles", "10").detection.cycles, 10);
    assert_eq!(set("tolerance", "0.1").detection.tolerance, 0.1);
    assert_eq!(set("regime_threshold", "0.1").detection.regime_threshold, 0.1);
    assert_eq!(set("decay_observation_s", "0.1").detection.decay_observation_s, 0.1);
}

/// Protects: a value that is refused is said once, and the parameter does not count as left open, too. Of a long list a message has the
/// first values and the last one.
#[test]
fn a_refused_value_is_no_open_parameter() {
    let study = parse(r#"{ "grid": { "mu": [0.2, 0.4], "omega_rpm": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10] } }"#);
    let refused = |overrides: &[(&str, &str)]| message(&single(&study, overrides).unwrap_err());
    let text = refused(&[("mu", "bad"), ("omega_rpm", "7")]);
    assert_eq!(text.matches("mu = ").count(), 1, "{text}");
    let text = refused(&[("mu", "0.2")]);
    let omega = text.lines().find(|line| line.contains("omega_rpm")).unwrap();
    assert!(
        omega.contains("= [1.0, 2.0, 3.0, …, 10.0]: expected one value for a single job, of 10"),
        "{text}"
    );
    let text = refused(&[("mu", "1e999"), ("omega_rpm", "7")]);
    assert!(text.contains("too large for a double") && !text.contains("quotes"), "{text}");
}

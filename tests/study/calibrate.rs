//! Protects: what a study says about measured points is stored with it, and what cannot be calibrated is refused at its place.

use serde_json::{Value, json};
use tribosweep::study::{Calibration, Changes, MeasuredPoint, Study};

fn assert_contains(message: &str, expected: &str) {
    super::assert_contains(message, &[expected]);
}

/// A study that is calibrated with two points.
fn calibrated() -> Value {
    json!({
        "samples": { "design": "sobol", "count": 4, "of": { "mu": { "uniform": [0.2, 0.6] } } },
        "grid": { "omega_rpm": [7, 20] },
        "calibrate": {
            "data": [
                { "at": { "omega_rpm": 7 }, "mu_star": 0.3, "mu_star_error": 0.01 },
                { "at": { "omega_rpm": 20 }, "frequency_hz": 2e4, "frequency_error_hz": 100 }
            ]
        }
    })
}

fn with(pointer: &str, value: Value) -> Value {
    let mut study = calibrated();
    *study.pointer_mut(pointer).unwrap() = value;
    study
}

fn refusal(study: &Value) -> String {
    Study::parse(&study.to_string(), "x.json").unwrap_err().to_string()
}

/// Protects: each mistake is named with its field, and with what would be right.
#[test]
fn mistakes_are_named() {
    Study::parse(&calibrated().to_string(), "x.json").unwrap();
    for (pointer, value, expected) in [
        ("/calibrate/data", json!([]), "calibrate.data = []: expected at least one measured point"),
        ("/calibrate/data/0/mu_star_error", Value::Null, "calibrate.data[0].mu_star_error = null"),
        (
            "/calibrate/data/0/mu_star_error",
            json!(0),
            "calibrate.data[0].mu_star_error = 0: expected a number > 0",
        ),
        ("/calibrate/data/0/mu_star", json!(-0.3), "calibrate.data[0].mu_star = -0.3: expected a number > 0"),
        (
            "/calibrate/data/0/at/omega_rpm",
            json!(8),
            "calibrate.data[0].at.omega_rpm = 8: expected a value of grid.omega_rpm",
        ),
        (
            "/calibrate/data/0/at",
            json!({}),
            "expected a value of each parameter that `grid` varies: omega_rpm",
        ),
        (
            "/calibrate/data/0/at/omega_rpm",
            json!(20),
            "calibrate.data[1].at = {\"omega_rpm\":20}: an earlier point has the same parameters",
        ),
        ("/samples", json!({ "points": [{ "mu": 0.3 }] }), "expected `samples` with a `design`"),
        ("/calibrate/data/0/at/omega_rpm", json!(20.0), "an earlier point has the same parameters"),
        (
            "/samples/of",
            json!({ "mu": { "discrete": [0.3, 0.4] } }),
            "samples.of.mu = {\"discrete\":[0.3,0.4]}: expected a distribution of numbers",
        ),
        (
            "/samples/of",
            json!({ "nx": { "uniform": [4, 8] } }),
            "nx: expected free parameters that are numbers",
        ),
    ] {
        assert_contains(&refusal(&with(pointer, value)), expected);
    }
    let set = |name: &str, value: Value| {
        let mut study = calibrated();
        study["calibrate"][name] = value;
        refusal(&study)
    };
    assert_contains(
        &set("most_points", json!(3)),
        "expected a number of points from 4, those of `samples`, to 1000; it is 3",
    );
    assert_contains(
        &set("wave_points", json!(0)),
        "calibrate.wave_points = 0: expected a number of points from 1",
    );
    assert_contains(
        &set("discrepancy", json!({ "mu_star": 2 })),
        "calibrate.discrepancy.mu_star = 2: expected a share",
    );
    let mut both = calibrated();
    both["refine"] = json!({ "boundaries": { "over": "omega_rpm", "within": 1 } });
    assert_contains(&refusal(&both), "expected only one of `refine` and `calibrate`");
    let mut silent = calibrated();
    silent["calibrate"]["data"][1]["squeals"] = false.into();
    assert_contains(&refusal(&silent), "what does not squeal has no frequency");
}

/// Protects: the study that the command makes has the distributions of its free parameters, and is the same when it is read from a
/// database.
#[test]
fn the_command_makes_a_study() {
    let mut study = calibrated();
    study["samples"]["of"]["young_modulus_pa"] = json!({ "log_uniform": ["1 GPa", "4 GPa"] });
    study.as_object_mut().unwrap().remove("calibrate");
    let point = |omega: f64| MeasuredPoint {
        at: [("omega_rpm".to_owned(), omega.into())].into_iter().collect(),
        mu_star: Some(0.3),
        mu_star_error: Some(0.01),
        ..MeasuredPoint::default()
    };
    let asked = |free: &[&str]| Changes {
        calibration: Some(Calibration {
            free: free.iter().map(|name| (*name).to_owned()).collect(),
            data: Some(vec![point(7.0), point(20.0)]),
            ..Calibration::default()
        }),
        ..Changes::default()
    };
    let parse = |free: &[&str]| Study::parse_changed(&study.to_string(), "x.json", &asked(free));
    for (free, parameters) in [(&[][..], 2), (&["young_modulus_pa"][..], 1)] {
        let own = parse(free).unwrap();
        assert_eq!((own.name(), own.free_parameters().len()), ("x-calibration", parameters));
        // Ten points for each free parameter at both speeds, and 30 at most.
        assert_eq!((own.grid_size(), own.most_jobs()), (20 * parameters, Some(60 * parameters)));
        let stored = Study::parse_stored(&own.document(), "x-calibration", None).unwrap();
        assert_eq!(stored.expand("1").unwrap(), own.expand("1").unwrap());
        assert_eq!(stored.growth(), own.growth());
    }
    let error = parse(&["youngs_modulus_pa"]).unwrap_err().to_string();
    assert_contains(
        &error,
        "--free: free = youngs_modulus_pa: expected a parameter with a distribution in samples.of",
    );
    assert_contains(&error, "did you mean `young_modulus_pa`?");
}

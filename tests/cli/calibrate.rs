//! Calibrations: the same answer whoever plans and runs the jobs, and files of measured points that cannot be used.

use serde_json::{Value, json};

use crate::cli::growing::{assert_same, storm, timed, undisturbed};
use crate::cli::support::{Folder, rows, small, stderr};

const TRUTH: [f64; 2] = [0.45, 2.5e9];

/// Three points of a run whose parameters are known, as data of a calibration of these parameters.
fn calibrating() -> Value {
    let mut truth = small(&json!({ "omega_rpm": [3, 10, 40] }));
    truth["scene"]["contact"]["mu"] = TRUTH[0].into();
    truth["scene"]["pin"]["young_modulus_pa"] = TRUTH[1].into();
    let folder = Folder::with("truth", &truth);
    folder.ok("run truth.json");
    let data: Vec<Value> = rows(&folder.ok("export truth"))
        .iter()
        .map(|row| {
            let number = |name: &str| row[name].parse::<f64>().unwrap();
            let (mu_star, hz) = (number("mu_star"), number("frequency_hz"));
            json!({
                "at": { "omega_rpm": number("omega_rpm") },
                "mu_star": mu_star,
                "mu_star_error": 0.02 * mu_star,
                "frequency_hz": hz,
                "frequency_error_hz": 0.02 * hz,
            })
        })
        .collect();
    let mut study = small(&json!({ "omega_rpm": [3, 10, 40] }));
    let of = json!({ "mu": { "uniform": [0.3, 0.6] }, "young_modulus_pa": { "log_uniform": [1e9, 6e9] } });
    study["samples"] = json!({ "design": "sobol", "count": 10, "of": of });
    study["calibrate"] = json!({ "data": data, "most_points": 22, "wave_points": 3 });
    study
}

/// Protects: a calibration has the same points, the same region and the same report with one thread and with two, and when its workers
/// are killed at any time; and the truth is not ruled out.
#[test]
fn a_calibration_survives_a_storm_of_kills() {
    let study = calibrating();
    let (expected, whole) = timed(&study, "--threads 1");
    assert_same(&undisturbed(&study, "--threads 2"), &expected);
    let waves = rows(&expected["report/waves.csv"]);
    assert!(waves.len() >= 2 && waves.iter().all(|row| row["why"].starts_with("calibration: ")), "{waves:?}");
    let free = rows(&expected["report/calibration.csv"]);
    for (row, truth) in free.iter().zip(TRUTH) {
        let [from, to] = ["region_from", "region_to"].map(|name| row[name].parse::<f64>().unwrap());
        assert!(from <= truth && truth <= to, "{row:?}");
        assert!(row["left"].parse::<f64>().unwrap() < 0.7, "{row:?}");
    }
    assert_same(&storm(&study, "sweep.db", 4, whole), &expected);
}

/// Protects: the answer for programs has the best point, the region, what is ruled out, and the implausibility of a point. A point that
/// is far from the data is ruled out.
#[test]
fn the_answer_is_json() {
    let folder = Folder::with("study", &calibrating());
    // The order of names is not that of the study.
    let answer = |at: &str| -> Value {
        let text = folder.ok(&format!("calibrate study.json --json --at {at}"));
        serde_json::from_str(&text).unwrap()
    };
    let found = answer("young_modulus_pa=2.5e9,mu=0.45");
    assert_eq!(found["at"]["ruled_out"], false, "{found}");
    let of = |pointer: &str| found.pointer(pointer).and_then(Value::as_f64).unwrap();
    assert!((0.5..1.0).contains(&of("/ruled_out")), "{found}");
    assert!(of("/region/mu/0") < of("/region/mu/1"), "{found}");
    assert!((of("/best/young_modulus_pa") / TRUTH[1] - 1.0).abs() < 0.3, "{found}");
    assert_eq!(of("/jobs"), 3.0 * of("/points"), "{found}");
    let far = answer("mu=0.45,young_modulus_pa=5.9e9");
    assert_eq!(far["at"]["ruled_out"], true);
    assert!(far["at"]["most_against"]["at"]["omega_rpm"].is_number(), "{far}");
    assert_eq!(answer("mu=0.45,young_modulus_pa=5.9GPa"), far);
}

/// Protects: a file of measured points that cannot be used is refused with its line and with what would be right, and nothing is stored.
#[test]
fn unusable_data_are_refused() {
    let mut study = small(&json!({ "omega_rpm": [3, 10, 40] }));
    let of = json!({ "mu": { "uniform": [0.3, 0.6] } });
    study["samples"] = json!({ "design": "sobol", "count": 10, "of": of });
    let folder = Folder::with("study", &study);
    for (data, expected) in [
        ("omega_rpm,mu_star\n5,0.3\n", "line 2: mu_star_error is missing"),
        ("omega_rpm,frequency_hz\n5,2e4\n", "line 2: frequency_error_hz is missing"),
        (
            "omega_rpm,mu_star,mu_star_error\n5,0.3,0.01\n5,0.31,0.01\n",
            "line 3: omega_rpm = 5.0, the same point as on line 2",
        ),
        (
            "omega_rpm,load_n,mu_star,mu_star_error\n5,30,0.3,0.01\n7,40,0.3,0.01\n",
            "omega_rpm and load_n both vary",
        ),
        ("omega_rpm,mu_star,mu_star_error\n5,0.3,0.01\n,0.31,0.01\n", "line 3: omega_rpm is empty"),
        (
            "omega_rpm,frequency_hz,frequency_error_hz,squeals\n5,2e4,90,no\n",
            "line 2: it has a frequency, and squeals is no",
        ),
        (
            "omega_rpm,mu,mu_star,mu_star_error\n5,0.4,0.3,0.01\n",
            "mu is free, and the measured points have a value of it",
        ),
        ("omega_rpm,mu_star,mu_star\n5,0.3,0.3\n", "the file has this column twice"),
        ("omega_rpm,mu_star,mu_star_error\n5,0.3,0\n", "line 2: mu_star_error = 0: expected a number > 0"),
        ("omega_rpm,mu_star,mu_star_error\n5,-0.3,0.1\n", "line 2: mu_star = -0.3: expected a number > 0"),
    ] {
        folder.write("data.csv", data);
        let message = stderr(&folder.command("calibrate study.json --data data.csv").assert().code(2));
        assert!(message.contains(expected), "{expected}\n---\n{message}");
    }
    for (options, expected) in [
        ("", "expected measured points"),
        ("--data data.csv --discrepancy mu=2%", "expected mu_star=SHARE or frequency=SHARE"),
        ("--data absent.csv", "absent.csv: cannot be read"),
    ] {
        let message = stderr(&folder.command(&format!("calibrate study.json {options}")).assert().code(2));
        assert!(message.contains(expected), "{expected}\n---\n{message}");
    }
    folder.write("data.csv", "omega_rpm,mu_star,mu_star_error\n5,0.3,0.01\n");
    for (options, expected) in [
        ("--free nu", "did you mean `poisson_ratio`?"),
        ("--at mu=0.3,poisson_ratio=0.2", "--at: expected one value for each of mu"),
        ("--at mu=0.3,nu=0.2", "nu: no such parameter; did you mean `poisson_ratio`?"),
        ("--set omega_rpm=7", "--set omega_rpm: the measured points have this parameter"),
        ("--at mu=0.7", "--at mu=0.7: expected a value from 0.3 to 0.6, the range of the study"),
        ("--set mu=0.4", "--set mu: it is free"),
        ("--most-points 0", "0 is not in 1..=1000"),
    ] {
        let command = format!("calibrate study.json --data data.csv {options}");
        let message = stderr(&folder.command(&command).assert().code(2));
        assert!(message.contains(expected), "{expected}\n---\n{message}");
    }
    assert!(!folder.files().iter().any(|file| file.contains(".db")), "{:?}", folder.files());
}

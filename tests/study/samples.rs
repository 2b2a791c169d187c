//! Protects: the points of a study that are no grid are those that the file describes, on every machine and whatever else the file
//! says, and what is wrong with them is said with its place.

use super::assert_contains;
use serde_json::{Value, json};
use tribosweep::study::{Changes, Job, Study};

fn parsed(study: &Value) -> Study {
    Study::parse(&study.to_string(), "studies/x.json").unwrap_or_else(|error| panic!("{error}"))
}

fn jobs(study: &Value) -> Vec<Job> {
    parsed(study).expand("1").unwrap()
}

fn refusal(study: &Value) -> String {
    Study::parse(&study.to_string(), "studies/x.json").unwrap_err().to_string()
}

/// The values of a parameter in all jobs.
fn values(jobs: &[Job], name: &str) -> Vec<f64> {
    let value = |job: &Job| job.parameters.iter().find(|(own, _)| own == name).unwrap().1.as_f64().unwrap();
    jobs.iter().map(value).collect()
}

/// Protects: points, lists walked together and a file of the same points are the same jobs, which have the values of their parameters.
#[test]
fn points_lists_and_files_are_the_same_jobs() {
    let points = json!([{ "omega_rpm": 7, "mu": 0.3 }, { "omega_rpm": 20, "mu": 0.3 }, { "omega_rpm": 7.5, "mu": 0.45 }]);
    let listed = jobs(&json!({ "samples": { "points": points } }));
    assert_eq!(values(&listed, "omega_rpm"), [7.0, 20.0, 7.5]);
    assert_eq!(listed[2].spec.scene.disk.omega_rpm, 7.5);
    assert_eq!(listed[2].spec.scene.contact.mu, 0.45);
    let zip = json!({ "omega_rpm": [7, 20, 7.5], "mu": [0.3, 0.3, 0.45] });
    assert_eq!(jobs(&json!({ "samples": { "zip": zip } })), listed);

    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("points.csv"), "# measured\nomega_rpm, mu\n7,0.3\n20,0.3\n7.5,0.45\n")
        .unwrap();
    let file = json!({ "samples": { "file": "points.csv" } }).to_string();
    let study = Study::parse(&file, &folder.path().join("x.json").display().to_string()).unwrap();
    drop(folder);
    assert_eq!(study.expand("1").unwrap(), listed);
    assert_eq!(Study::parse_stored(&study.document(), "x", None).unwrap().expand("1").unwrap(), listed);
}

/// Protects: samples are combined with all values of the grid, the samples slowest, and a range in a list has as many values as the
/// other lists.
#[test]
fn samples_are_combined_with_a_grid() {
    let found = jobs(&json!({
        "samples": { "zip": { "load_n": { "from": 10, "to": 30, "count": 3 }, "omega_rpm": [1, 2, 3] } },
        "grid": { "mu": [0.2, 0.4] }
    }));
    assert_eq!(values(&found, "load_n"), [10.0, 10.0, 20.0, 20.0, 30.0, 30.0]);
    assert_eq!(values(&found, "mu"), [0.2, 0.4, 0.2, 0.4, 0.2, 0.4]);
}

fn drawn(design: &str, count: usize, seed: u64) -> Vec<Job> {
    let of = json!({
        "mu": { "uniform": [0.1, 0.6] },
        "omega_rpm": { "log_uniform": [1, 100] },
        "young_modulus_pa": { "truncated_normal": [1e9, 1e8, 7e8, 1.3e9] },
        "clamp_side": { "discrete": ["inner_side", "outer_side"] },
    });
    jobs(&json!({ "samples": { "design": design, "count": count, "seed": seed, "of": of } }))
}

/// Protects: designs stay within their distributions and follow them, depend on the seed alone, and Sobol's sequence keeps its first
/// points when it is extended.
#[test]
fn designs_follow_their_distributions() {
    for design in ["random", "latin_hypercube", "sobol", "morris"] {
        let found = drawn(design, 128, 5);
        // A design of Morris has at most 4³·2 different points of four parameters, of which one has two values.
        assert_eq!(found.len(), 128, "{design}");
        let mu = values(&found, "mu");
        assert!(mu.iter().all(|mu| (0.1..=0.6).contains(mu)), "{design}");
        // The mean of n points has the error (0.5/√12)/√n at most.
        let mean = mu.iter().sum::<f64>() / mu.len() as f64;
        assert!((mean - 0.35).abs() < 5.0 * 0.5 / 12.0_f64.sqrt() / 128.0_f64.sqrt(), "{design}: {mean}");
        let slow = values(&found, "omega_rpm").iter().filter(|omega| **omega < 10.0).count();
        assert!((slow as f64 / found.len() as f64 - 0.5).abs() < 0.2, "{design}: {slow}");
        assert_eq!(drawn(design, 128, 5), found);
        assert_ne!(drawn(design, 128, 6), found);
    }
    assert_eq!(drawn("sobol", 192, 5)[..128], drawn("sobol", 128, 5)[..]);
}

/// Protects: the points of a design are these numbers on every machine and in every later version. Studies are resumed by them.
#[test]
fn points_never_change() {
    let first = |design| {
        let found = jobs(&json!({ "samples": {
            "design": design, "count": 2, "seed": 1, "of": { "mu": { "uniform": [0, 1] }, "omega_rpm": { "normal": [50, 10] } }
        } }));
        [values(&found, "mu"), values(&found, "omega_rpm")].concat()
    };
    assert_eq!(first("random"), [0.935_170_209, 0.307_193_852, 40.251_463_5, 66.353_667_7]);
    assert_eq!(first("latin_hypercube"), [0.467_585_104, 0.653_596_926, 36.109_463_3, 69.515_968_1]);
    assert_eq!(first("sobol"), [0.429_805_547, 0.978_770_763, 56.723_991_9, 35.982_680_5]);
}

/// Protects: the order of the parameters in a design does not matter, so a study that the command line changes elsewhere, and that is
/// written down again, keeps its points.
#[test]
fn the_order_of_parameters_does_not_matter() {
    let text = r#"{ "samples": { "design": "sobol", "count": 8, "of": {
        "omega_rpm": { "log_uniform": [1, 100] }, "mu": { "uniform": [0.1, 0.6] } } } }"#;
    let changes = Changes { settings: vec![("load_n".to_owned(), "20".to_owned())], ..Changes::default() };
    let changed = Study::parse_changed(text, "x.json", &changes).unwrap();
    let again = Study::parse_stored(&changed.document(), "x", None).unwrap();
    let keys = |study: &Study| study.expand("1").unwrap().into_iter().map(|job| job.key).collect::<Vec<_>>();
    assert_eq!(keys(&changed), keys(&again));
    let original = Study::parse(text, "x.json").unwrap().expand("1").unwrap();
    assert_eq!(values(&changed.expand("1").unwrap(), "mu"), values(&original, "mu"));
}

/// Protects: conditions keep the points that fulfil an entry of `include` and no entry of `exclude`; the places of the others in the
/// order of the points stay.
#[test]
fn conditions_keep_points() {
    let grid = json!({ "mu": [0.1, 0.2, 0.3], "omega_rpm": [1, 10, 100] });
    let kept = |study: Value| {
        let found = jobs(&study);
        let pairs: Vec<(f64, f64)> =
            values(&found, "mu").into_iter().zip(values(&found, "omega_rpm")).collect();
        pairs
    };
    let include =
        json!([{ "mu": { "from": 0.2 }, "omega_rpm": [1, 10] }, { "mu": 0.1, "omega_rpm": { "to": 1 } }]);
    let found = kept(json!({ "grid": grid, "include": include }));
    assert_eq!(found, [(0.1, 1.0), (0.2, 1.0), (0.2, 10.0), (0.3, 1.0), (0.3, 10.0)]);
    let exclude = json!([{ "mu": { "from": 0.3 } }]);
    let found = kept(json!({ "grid": grid, "include": include, "exclude": exclude }));
    assert_eq!(found, [(0.1, 1.0), (0.2, 1.0), (0.2, 10.0)]);
    // What does not vary has the value of the base job, in the changed study and in its document.
    let study = json!({ "grid": grid, "include": include, "exclude": exclude }).to_string();
    let changes = Changes { settings: vec![("mu".to_owned(), "0.2".to_owned())], ..Changes::default() };
    let changed = Study::parse_changed(&study, "x.json", &changes).unwrap();
    assert_eq!(values(&changed.expand("1").unwrap(), "omega_rpm"), [1.0, 10.0]);
    assert_eq!(
        Study::parse_stored(&changed.document(), "x", None).unwrap().expand("1").unwrap(),
        changed.expand("1").unwrap()
    );
}

/// Protects: a setting of the command line takes the place of a sampled parameter, and the document says the same as the changed study.
#[test]
fn settings_replace_sampled_parameters() {
    let study = json!({ "samples": { "design": "sobol", "count": 8, "of": {
        "mu": { "uniform": [0.1, 0.6] }, "omega_rpm": { "log_uniform": [1, 100] }
    } } });
    let set = |name: &str, value: &str| Changes {
        settings: vec![(name.to_owned(), value.to_owned())],
        ..Changes::default()
    };
    let changed = Study::parse_changed(&study.to_string(), "x.json", &set("mu", "0.3")).unwrap();
    let found = changed.expand("1").unwrap();
    assert_eq!(values(&found, "omega_rpm"), values(&jobs(&study), "omega_rpm"));
    assert!(found.iter().all(|job| job.spec.scene.contact.mu == 0.3));
    assert_eq!(Study::parse(&changed.document(), "x.json").unwrap().expand("1").unwrap(), found);
    // One job needs a value for each sampled parameter.
    let single = |settings: &[(&str, &str)]| {
        let settings: Vec<_> = settings.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect();
        parsed(&study).single(&settings).map_err(|error| error.to_string())
    };
    assert_contains(
        &single(&[("mu", "0.3")]).unwrap_err(),
        &["omega_rpm", "expected one value for a single job"],
    );
    assert_eq!(single(&[("mu", "0.3"), ("omega_rpm", "7")]).unwrap().scene.disk.omega_rpm, 7.0);
}

/// Protects: what is wrong, where, and what would be right.
#[test]
fn unusable_samples_are_refused() {
    let of = |samples: Value| refusal(&json!({ "samples": samples }));
    let uniform = json!({ "mu": { "uniform": [0.1, 0.6] } });
    let cases: [(Value, &[&str]); 16] = [
        (json!({}), &["samples", "exactly one of points, zip, file and design"]),
        (json!({ "points": [{ "mu": 0.3 }], "seed": 1 }), &["samples.seed", "beside `design` only"]),
        (json!({ "points": [] }), &["samples.points", "at least one point"]),
        (
            json!({ "points": [{ "mu": 0.3 }, { "omega_rpm": 3 }] }),
            &["samples.points[1]", "expected values of mu"],
        ),
        (
            json!({ "points": [{ "mu": 0.3 }, { "mu": "high" }] }),
            &["samples.points[1].mu", "expected a number"],
        ),
        (json!({ "points": [{ "mue": 0.3 }] }), &["samples.points[0].mue", "no such parameter", "mu"]),
        (json!({ "zip": { "mu": [0.1, 0.2], "omega_rpm": [1] } }), &["expected 2 values", "it has 1"]),
        (json!({ "design": "sobol", "of": uniform }), &["samples.count", "from 1 to 1000000"]),
        (json!({ "design": "sobol", "count": 70000, "of": uniform }), &["samples.count", "65536"]),
        (json!({ "design": "sobol", "count": 4 }), &["samples.of", "distributions"]),
        (json!({ "design": "grid", "count": 4, "of": uniform }), &["samples.design", "latin_hypercube"]),
        (
            json!({ "design": "sobol", "count": 4, "of": { "mu": { "uniform": [0.6, 0.1] } } }),
            &["samples.of.mu", "the smaller one first"],
        ),
        (
            json!({ "design": "sobol", "count": 4, "of": { "mu": { "triangular": [0, 1] } } }),
            &["samples.of.mu", "expected one distribution"],
        ),
        (
            json!({ "design": "sobol", "count": 4, "of": { "clamp_side": { "uniform": [0, 1] } } }),
            &["expected `discrete`"],
        ),
        (
            json!({ "design": "morris", "count": 4, "of": { "mu": { "normal": [0.3, 0.1] } } }),
            &["expected truncated_normal"],
        ),
        (
            json!({ "design": "random", "count": 4, "of": { "mu": { "normal": [-1.0, 0.1] } } }),
            &["set by samples, point 1 of 4", "mu"],
        ),
    ];
    for (samples, expected) in cases {
        assert_contains(&of(samples), expected);
    }
    let twice = json!({ "samples": { "zip": { "nx": [6, 8] } }, "grid": { "elements": [[6, 8, 5]] } });
    assert_contains(&refusal(&twice), &["grid.elements", "sets the same field as nx in samples"]);
    let grid = json!({ "mu": [0.1, 0.2] });
    let condition = |include: Value| refusal(&json!({ "grid": grid, "include": include }));
    assert_contains(&condition(json!([{ "load_n": 31 }])), &["include", "leave at least one point"]);
    assert_contains(&condition(json!([{ "lode_n": 31 }])), &["include[0].lode_n", "no such parameter"]);
    assert_contains(&condition(json!([{ "mu": {} }])), &["include[0].mu", "\"from\": a"]);
    assert_contains(&condition(json!([{}])), &["include[0]", "at least one parameter"]);
    assert_contains(&condition(json!([{ "mu": 0.3 }])), &["include", "leave at least one point"]);
    let large = json!({ "samples": { "design": "random", "count": 2000, "of": uniform }, "grid": { "omega_rpm": { "from": 1, "to": 100, "count": 1000 } } });
    assert_contains(&refusal(&large), &["2000000", "samples 2000 × omega_rpm 1000"]);
}

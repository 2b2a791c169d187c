//! Studies that grow: the same jobs and the same report, whoever plans them, in whatever order results come, and whatever dies.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::cli::support::{Folder, rows, small, stderr, without_wall_times};
use crate::random::Random;
use crate::server::ServerDatabase;

/// Curves with their minima, and boundaries of stability, on a small mesh. Waves are small, so that there are many.
fn refining() -> Value {
    let mut study = small(&json!({ "mu": [0.1, 0.3, 0.6], "omega_rpm": [3, 10, 40] }));
    study["stability"] = "eigenvalues".into();
    study["refine"] = json!({
        "curves": { "over": "omega_rpm", "within": 0.01, "minimum_within": 1.0 },
        "boundaries": { "over": "mu", "within": 0.02 },
        "most_jobs": 50,
        "wave_jobs": 5,
    });
    study
}

/// A way up and a way down. The jobs go to their limit, so that they take long enough to be killed.
fn continuing() -> Value {
    let mut study = small(&json!({ "mu": [0.4, 0.6], "omega_rpm": [3, 5, 10, 20] }));
    study["run"] = json!({ "limit_s": 0.2, "stop_early": false });
    study["continue"] = json!({ "along": "omega_rpm" });
    study
}

/// The files of a report that have no times, and the export without wall times.
fn findings(folder: &Folder, db: &str) -> BTreeMap<String, String> {
    folder.ok(&format!("report study --db {db} --out report"));
    let mut found = BTreeMap::new();
    for file in folder.files().into_iter().filter(|file| file.starts_with("report/")) {
        let has_times = ["report.md", "report.html", "explore.html", "run_times", "jobs.csv"]
            .iter()
            .any(|part| file.contains(part));
        // The hidden list names the files only.
        if !has_times {
            found.insert(file.clone(), folder.read(&file));
        }
    }
    assert!(found.len() > 10, "{:?}", found.keys());
    found.insert("export".to_owned(), without_wall_times(&folder.ok(&format!("export study --db {db}"))));
    found
}

pub fn undisturbed(study: &Value, options: &str) -> BTreeMap<String, String> {
    timed(study, options).0
}

/// The findings of an undisturbed run, and how long it took.
pub fn timed(study: &Value, options: &str) -> (BTreeMap<String, String>, Duration) {
    let folder = Folder::with("study", study);
    let start = Instant::now();
    folder.ok(&format!("run study.json --db sweep.db {options}"));
    let whole = start.elapsed();
    (findings(&folder, "sweep.db"), whole)
}

/// Starts pairs of workers and kills them after a random time, until the study needs no more jobs. An undisturbed run takes the time
/// `whole`. A pair lives for a third of it at most, so that several pairs are killed on a machine of any speed.
pub fn storm(study: &Value, db: &str, seed: u64, whole: Duration) -> BTreeMap<String, String> {
    let folder = Folder::with("study", study);
    let mut random = Random::new(seed);
    folder.ok(&format!("submit study.json --db {db}"));
    let state =
        || -> Value { serde_json::from_str(&folder.ok(&format!("status study --json --db {db}"))).unwrap() };
    let mut kills = 0;
    loop {
        let work = format!("work --db {db} --threads 1 --lease 10s --max-crashes 1000");
        let workers = [folder.start(&work), folder.start(&work)];
        // The first ones are killed early: `whole` may have been measured on a machine that was busier than it is now.
        let part = if kills < 6 { 2000 } else { 750 };
        std::thread::sleep(whole * (random.below(250) as u32) / part);
        for worker in workers {
            worker.signal("KILL");
            kills += usize::from(worker.end().0.is_none());
        }
        let state = state();
        match state["plan"].as_str() {
            Some("complete") => break,
            Some("open") => assert!(kills < 500, "{state}"),
            _ => panic!("{state}"),
        }
    }
    assert!(kills > 2, "the study must not be done before anything is killed");
    findings(&folder, db)
}

pub fn assert_same(found: &BTreeMap<String, String>, expected: &BTreeMap<String, String>) {
    assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>());
    for (file, text) in expected {
        assert!(found[file] == *text, "{file}:\n{}\n---\n{text}", found[file]);
    }
}

/// Protects: a study that refines has the same jobs and the same report with one thread and with two, and when its workers are killed
/// at any time.
#[test]
fn a_refinement_survives_a_storm_of_kills() {
    let study = refining();
    let (expected, whole) = timed(&study, "--threads 1");
    assert_same(&undisturbed(&study, "--threads 2"), &expected);
    assert!(expected["report/waves.csv"].lines().count() > 5, "{}", expected["report/waves.csv"]);
    assert!(
        expected["report/boundaries.csv"].contains(",stable,unstable,"),
        "{}",
        expected["report/boundaries.csv"]
    );
    assert_same(&storm(&study, "sweep.db", 1, whole), &expected);
}

/// Protects: the same on a server.
#[test]
fn a_refinement_survives_on_a_server() {
    let Some(database) = ServerDatabase::new() else { return };
    let study = refining();
    let (expected, whole) = timed(&study, "");
    assert_same(&storm(&study, &database.url(), 2, whole), &expected);
}

/// Protects: chains of jobs that continue their neighbours survive the same, and every job of them is there.
#[test]
fn chains_survive_a_storm_of_kills() {
    let study = continuing();
    let (expected, whole) = timed(&study, "--threads 2");
    assert_eq!(rows(&expected["export"]).len(), 16);
    assert_eq!(expected["report/branches.csv"].lines().count(), 9);
    assert_same(&storm(&study, "sweep.db", 3, whole), &expected);
}

/// Protects: what is found is as good as what is asked for, and no better by chance: every boundary is known within its width, every
/// minimum lies between near neighbours, and jobs beyond the budget are not asked for.
#[test]
fn what_is_asked_for_is_found() {
    let folder = Folder::with("study", &refining());
    folder.ok("run study.json");
    let table = |name: &str| rows(&folder.read(format!("reports/study/{name}.csv")));
    let boundaries = table("boundaries");
    assert!(!boundaries.is_empty());
    for row in &boundaries {
        let [from, to] = ["from", "to"].map(|name| row[name].parse::<f64>().unwrap());
        assert!(to - from <= 0.02 + 1e-9 && row["known"] == "yes", "{row:?}");
    }
    // A curve that varies by less than the error that is asked for has no minimum to be looked for.
    let jobs = rows(&folder.ok("export study"));
    for row in table("minima") {
        let own = jobs.iter().filter(|job| job["mu"] == row["mu"] && !job["mu_star"].is_empty());
        let values: Vec<f64> = own.map(|job| job["mu_star"].parse().unwrap()).collect();
        let spread = values.iter().fold(0.0_f64, |most, value| most.max(value - values[0]))
            - values.iter().fold(0.0_f64, |least, value| least.min(value - values[0]));
        let expected = if spread <= 0.01 { "flat" } else { "yes" };
        assert_eq!(row["known"], expected, "{row:?}: {values:?}");
    }
    assert!(table("minima").iter().any(|row| row["known"] == "yes"));
    let mut small = refining();
    small["refine"]["most_jobs"] = 15.into();
    let folder = Folder::with("study", &small);
    folder.ok("run study.json");
    assert_eq!(rows(&folder.ok("export study")).len(), 15);
    assert!(folder.ok("status study").contains("the budget of 15 jobs is used up"));
}

/// Protects: `--basins` makes the same jobs as `kicks` in the study, beside the study itself, and shares of all kicks.
#[test]
fn basins_can_be_asked_for_on_the_command_line() {
    let mut study = small(&json!({ "mu": [0.6], "omega_rpm": [10] }));
    let folder = Folder::with("study", &study);
    folder.ok("run study.json --basins 5 --kick 0.02");
    let asked = rows(&folder.ok("export study-basins"));
    assert_eq!(asked.len(), 6);
    study["continue"] = json!({ "kicks": 5, "kick_m_s": 0.02 });
    folder.add("same", &study);
    let message = stderr(&folder.command("submit same.json").assert().success());
    assert!(message.contains("1 job, 0 new, 1 already done"), "{message}");
    folder.ok("work");
    let same = rows(&folder.ok("export same"));
    assert_eq!(
        same.iter().map(|row| &row["job"]).collect::<Vec<_>>(),
        asked.iter().map(|row| &row["job"]).collect::<Vec<_>>()
    );
    let table = rows(&folder.read("reports/study-basins/basins.csv"));
    let jobs: u64 = table.iter().map(|row| row["jobs"].parse::<u64>().unwrap()).sum();
    assert_eq!(jobs, 5);
    let message = stderr(&folder.command("run study.json --basins 5").assert().failure());
    assert!(message.contains("--kick"), "{message}");
}

/// Protects: a chain that ended at a job that failed goes on when the job is tried again, and then has all its jobs.
#[test]
fn a_chain_goes_on_after_a_retry() {
    let study = continuing();
    let folder = Folder::with("study", &study);
    folder.ok("submit study.json");
    // A job fails if its process dies once more than it may.
    let work = folder.start("work --threads 1 --max-crashes 1");
    folder.wait_for("study", |counts| counts["running"] > 0);
    work.signal("KILL");
    work.end();
    folder.command("work --max-crashes 1").assert().code(1);
    let state = folder.ok("status study");
    assert!(state.contains("because jobs before them failed"), "{state}");
    folder.ok("retry study --failed");
    folder.ok("work");
    assert_eq!(without_wall_times(&folder.ok("export study")), undisturbed(&study, "")["export"]);
}

/// Protects: a chain whose study asks for it has a run on a coarser mesh for each of its jobs, roots or not, and its export says what the error
/// of the mesh is, or why it is not known.
#[test]
fn a_chain_can_be_compared_with_a_coarser_mesh() {
    let mut study = small(&json!({ "mu": [0.4], "omega_rpm": [5, 10] }));
    study["scene"]["pin"]["elements"] = json!([10, 10, 10]);
    study["run"] = json!({ "limit_s": 0.02, "start": "compared" });
    study["continue"] = json!({ "along": "omega_rpm", "directions": ["up"] });
    let folder = Folder::with("study", &study);
    folder.ok("run study.json");
    let found = rows(&folder.ok("export study --all"));
    assert_eq!(found.len(), 2);
    for row in found {
        let has_error = !row["mu_star_mesh_error"].is_empty();
        let why = &row["mesh_error_unknown"];
        assert_eq!(row["start"], "compared", "{row:?}");
        assert!(has_error || !why.is_empty() && why != "no run on a coarser mesh", "{row:?}");
    }
}

/// Protects: mistakes in `refine` and `continue` are refused with the field and what would be right, and no database is made.
#[test]
fn mistakes_are_refused() {
    let grid = json!({ "mu": [0.2, 0.4], "omega_rpm": [5, 20] });
    for (field, value, expected) in [
        ("refine", json!({}), "`curves`, `boundaries`, or both"),
        ("refine", json!({ "curves": { "over": "omega_rpm" } }), "`within`, `minimum_within`, or both"),
        (
            "refine",
            json!({ "curves": { "over": "load_n", "within": 0.1 } }),
            "expected a number with decimals that the study varies",
        ),
        (
            "refine",
            json!({ "curves": { "over": "mu", "of": "mustar", "within": 0.1 } }),
            "did you mean `mu_star`?",
        ),
        ("refine", json!({ "boundaries": { "over": "mu", "within": 0 } }), "expected a number > 0"),
        ("refine", json!({ "boundaries": { "over": "mu" } }), "either `within` or `within_share`"),
        (
            "refine",
            json!({ "boundaries": { "over": "mu", "within": 0.1, "within_share": 0.1 } }),
            "either `within` or `within_share`",
        ),
        (
            "refine",
            json!({ "boundaries": { "over": "mu", "within_share": 0.1, "largest_step": -1 } }),
            "expected a number > 0",
        ),
        (
            "refine",
            json!({ "boundaries": { "over": "mu", "within": 0.1 }, "wave_jobs": 0 }),
            "a number of jobs from 1",
        ),
        (
            "refine",
            json!({ "curves": { "over": "mu", "of": "wall_s", "within": 0.1 } }),
            "and not of the machine",
        ),
        (
            "refine",
            json!({ "boundaries": { "over": "mu", "within": 0.1 }, "most_jobs": 3 }),
            "from 4, those of the grid",
        ),
        ("continue", json!({ "kicks": 4_000_000, "kick_m_s": 0.1 }), "at most 249999"),
        ("continue", json!({}), "either `along` or `kicks`"),
        ("continue", json!({ "along": "mu", "kicks": 3 }), "either `along` or `kicks`"),
        ("continue", json!({ "along": "mu", "directions": [] }), "`up`, `down`, or both"),
        ("continue", json!({ "kicks": 4 }), "expected `kick_m_s`"),
        ("continue", json!({ "along": "clamp_width_m" }), "it varies mu, omega_rpm"),
    ] {
        let mut study = small(&grid);
        study[field] = value.clone();
        let folder = Folder::with("study", &study);
        let message = stderr(&folder.command("submit study.json").assert().failure());
        assert!(message.contains(expected), "{value}: {message}");
        assert_eq!(folder.files(), ["study.json"]);
    }
    // The mesh must not change along a chain, and half an element is none.
    for (field, value) in [
        ("continue", json!({ "along": "ny" })),
        ("refine", json!({ "curves": { "over": "ny", "within": 0.1 } })),
    ] {
        let mut study = small(&json!({ "mu": [0.2, 0.4], "ny": [4, 8] }));
        study[field] = value;
        let folder = Folder::with("study", &study);
        let message = stderr(&folder.command("submit study.json").assert().failure());
        assert!(message.contains("expected a number with decimals that the study varies"), "{message}");
    }
    let mut study = small(&grid);
    study["continue"] = json!({ "along": "mu" });
    study["scene"]["disk"] = json!({ "runout_m": 1.0e-6 });
    let folder = Folder::with("study", &study);
    let message = stderr(&folder.command("validate study.json").assert().failure());
    assert!(message.contains("continue"), "{message}");
    let folder = Folder::with("study", &refining());
    let message = stderr(&folder.command("submit study.json --shard 1/2").assert().failure());
    assert!(message.contains("cannot be divided into shards"), "{message}");
    let message = stderr(&folder.command("slurm study.json --workers 2").assert().failure());
    assert!(message.contains("needs one database for all workers"), "{message}");
}

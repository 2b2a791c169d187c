//! `inspect`: one job run again and shown in detail.

use serde_json::{Value, json};

use crate::cli::support::{ExportRow, Folder, handles_interrupts, long, rows, small, stderr, wait};

fn folder() -> Folder {
    Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4], "omega_rpm": [2, 7] })))
}

fn summary(folder: &Folder, out: &str) -> Value {
    serde_json::from_str(&folder.read(format!("{out}/inspection.json"))).unwrap()
}

/// Protects: a job that is given by its parameters, by its key or in the database is the job that `solve` runs, and all
/// files that the page names exist.
#[test]
fn parameters_and_keys_select_the_same_job() {
    let folder = folder();
    let page = folder.ok("inspect mine.json omega_rpm=7 mu=0.4");
    assert_eq!(page.trim(), "reports/mine/inspect/mu-0.4_omega_rpm-7/index.html");
    let found = summary(&folder, "reports/mine/inspect/mu-0.4_omega_rpm-7");
    let record: Value =
        serde_json::from_str(&folder.ok("solve mine.json --set mu=0.4 --set omega_rpm=7 --json")).unwrap();
    assert_eq!(found["record"], record);
    let names: Vec<_> = found["nodes"].as_array().unwrap().iter().map(|node| &node["name"]).collect();
    assert_eq!(names, ["front_centre", "rear_centre"]);
    for figure in ["2a", "2b", "3a", "3b", "4", "5"] {
        assert!(
            folder
                .read(format!("reports/mine/inspect/mu-0.4_omega_rpm-7/figure{figure}.svg"))
                .starts_with("<svg")
        );
    }
    let files = folder.files();
    let files: Vec<&str> = files
        .iter()
        .filter_map(|file| file.strip_prefix("reports/mine/inspect/mu-0.4_omega_rpm-7/"))
        .collect();
    let page = folder.read("reports/mine/inspect/mu-0.4_omega_rpm-7/index.html");
    let after = |mark: &str| -> Vec<&str> {
        page.split(mark).skip(1).filter_map(|rest| rest.split(['"', '<']).next()).collect()
    };
    let named = [after("download=\""), after("<code>")].concat();
    assert!(named.contains(&"face.csv") && named.contains(&"node_*.csv"), "{named:?}");
    // Other names in this font are those of parameters.
    for name in named.into_iter().filter(|name| name.contains('.')) {
        let is_meant = |file: &&str| match name.split_once('*') {
            Some((start, end)) => file.starts_with(start) && file.ends_with(end),
            None => *file == name,
        };
        assert!(files.iter().any(is_meant), "{name} is not among {files:?}");
    }
    let history = rows(&folder.read("reports/mine/inspect/mu-0.4_omega_rpm-7/node_rear_centre.csv"));
    assert!(history.len() > 100 && history.iter().any(|row| row["state"] == "slip"));

    for part in [
        "What was simulated",
        "Young's modulus of the pin",
        "1 GPa",
        "mesh unknown (no run on a coarser mesh)",
    ] {
        assert!(page.contains(part), "{part}");
    }

    folder.ok("submit mine.json");
    let key = rows(&folder.ok("export mine"))
        .into_iter()
        .find(|row| row["mu"] == "0.4" && row["omega_rpm"] == "7")
        .unwrap()["job"]
        .clone();
    assert_eq!(found["key"], key);
    for (study, out) in [("mine", "by_name"), ("mine.json", "by_file")] {
        folder.ok(&format!("inspect {study} {} --out {out}", &key[..10]));
        assert_eq!(summary(&folder, out), found, "{study}");
    }

    // The report of the study leads to the inspection in its folder, and says what the jobs were, defaults included.
    folder.ok("report mine");
    let page = folder.read("reports/mine/report.html");
    assert!(page.contains("href=\"inspect/mu-0.4_omega_rpm-7/index.html\""), "{page}");
    let markdown = folder.read("reports/mine/report.md");
    let line = |name: &str| markdown.lines().find(|line| line.contains(&format!("| {name} "))).unwrap();
    let cells = |name: &str| line(name).split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    assert_eq!(cells("`mu`")[3..6], ["0.2, 0.4", "`mu`", "grid"]);
    assert_eq!(cells("`density_kg_m3`")[3..6], ["2500 kg/m³", "`density_kg_m3`", "default"]);
    assert_eq!(cells("nodes of the pin")[3], "80");
}

/// Protects: inspections with different arguments have different folders, and none of them is the folder of the report.
#[test]
fn each_inspection_has_its_own_folder() {
    let folder = folder();
    let mut single = small(&Value::Null);
    single.as_object_mut().unwrap().remove("grid");
    folder.add("single", &single);
    let pages = [
        "single.json",
        "mine.json mu=0.4",
        "mine.json mu=0.4 --preset draft",
        "mine.json mu=0.4 limit_s=0.013",
    ]
    .map(|job| folder.ok(&format!("inspect {job}")));
    assert_eq!(pages[0].trim(), "reports/single/inspect/job/index.html");
    assert_eq!(pages.iter().collect::<std::collections::BTreeSet<_>>().len(), pages.len(), "{pages:?}");
    let overlays = ["mu=0.4", "mu=0.2"]
        .map(|job| folder.ok(&format!("inspect mine.json {job} --overlay omega_rpm=2,7")));
    assert_ne!(overlays[0], overlays[1]);
    // An inspection of other nodes removes the files of the previous one.
    folder.ok("inspect mine.json mu=0.4 --node centre --frames 16");
    let files: Vec<String> = std::fs::read_dir(folder.path("reports/mine/inspect/mu-0.4_omega_rpm-7"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.starts_with("node_"))
        .collect();
    assert_eq!(files, ["node_centre.csv"]);
    assert_eq!(
        std::fs::read_dir(folder.path("reports/mine/inspect/mu-0.4_omega_rpm-7/fields")).unwrap().count(),
        16
    );
}

/// Protects: parameters without a setting have the values of the study's scene, and the command says so, and
/// also if the study does not have the job. Nodes, cycles and frames are as requested.
#[test]
fn other_parameters_are_those_of_the_scene() {
    let folder = folder();
    let assert = folder
        .command("inspect mine.json mu=0.2 --node -2,3 --node centre --cycles 3 --frames 16 --out out")
        .assert()
        .code(0);
    let foreign = "note: this point is not in the grid of mine; it is computed all the same\n";
    assert!(stderr(&assert).contains("from the study's scene: ω = 7 rpm\n"), "{}", stderr(&assert));
    assert!(!stderr(&assert).contains(foreign), "{}", stderr(&assert));
    let other = folder.command("inspect mine.json mu=0.3 --out other").assert().code(0);
    assert!(stderr(&other).contains(foreign), "a point that the study does not have: {}", stderr(&other));
    let found = summary(&folder, "out");
    assert_eq!(
        (&found["job"]["scene"]["contact"]["mu"], &found["job"]["scene"]["disk"]["omega_rpm"]),
        (&json!(0.2), &json!(7.0))
    );
    assert_eq!(found["nodes"][1]["name"], "centre");
    assert_eq!(std::fs::read_dir(folder.path("out/fields")).unwrap().count(), 16);
}

/// Protects: an overlay has one and a half cycles of every job, from the beginning of a cycle, and a figure and a table for
/// every node.
#[test]
fn an_overlay_compares_jobs() {
    let folder = folder();
    let files =
        folder.ok("inspect mine.json mu=0.4 --overlay omega_rpm=2,7,20 --node front_centre --node centre");
    assert_eq!(files.lines().count(), 4, "{files}");
    let overlay =
        rows(&folder.read("reports/mine/inspect/overlay_omega_rpm_mu-0.4/figure8_front_centre.csv"));
    for speed in ["2", "7", "20"] {
        let of_job: Vec<_> = overlay.iter().filter(|row| row["job"] == format!("ω = {speed} rpm")).collect();
        folder.ok(&format!("inspect mine.json mu=0.4 omega_rpm={speed} --out out"));
        let until_s = 1.5 * summary(&folder, "out")["period_s"].as_f64().unwrap();
        let number = |row: &ExportRow, name: &str| -> f64 { row[name].parse().unwrap() };
        let (first, last) = (of_job[0], of_job[of_job.len() - 1]);
        let step_s = (number(last, "time_s") - number(first, "time_s")) / (of_job.len() - 1) as f64;
        let (from_s, to_s) = (number(first, "since_cycle_begin_s"), number(last, "since_cycle_begin_s"));
        assert!(from_s >= 0.0 && from_s < step_s, "{speed} rpm: {from_s} s");
        assert!(to_s <= until_s && to_s > until_s - step_s, "{speed} rpm: {to_s} of {until_s} s");
    }
    assert!(
        folder
            .read("reports/mine/inspect/overlay_omega_rpm_mu-0.4/figure8_centre.svg")
            .contains("ω = 20 rpm")
    );
}

/// Protects: the spectra of several jobs are stored where the report finds them: it draws those of its jobs. A job that has a
/// spectrum, also from a whole inspection, is not run again.
#[test]
fn spectra_of_several_jobs_make_a_waterfall() {
    let folder = folder();
    folder.ok("inspect mine.json omega_rpm=7 mu=0.4");
    let assert = folder.command("inspect mine.json mu=0.4 --all --only spectrum").assert().code(0);
    assert!(stderr(&assert).contains("1 of 2 spectra are stored already"), "{}", stderr(&assert));
    let out = String::from_utf8(assert.get_output().stdout.clone()).unwrap();
    assert_eq!(out.trim(), "reports/mine/inspect/mu-0.4_omega_rpm-2");
    let found = summary(&folder, "reports/mine/inspect/mu-0.4_omega_rpm-2");
    assert_eq!(found["job"]["scene"]["disk"]["omega_rpm"], json!(2.0));
    assert!(!folder.path("reports/mine/inspect/mu-0.4_omega_rpm-2/index.html").exists());

    folder.ok("run mine.json");
    let keys: Vec<String> = rows(&folder.ok("export mine"))
        .into_iter()
        .filter(|row| row["mu"] == "0.4")
        .map(|row| row["job"].clone())
        .collect();
    assert!(keys.contains(&found["key"].as_str().unwrap().to_owned()), "{keys:?}");
    let figure = folder.read("reports/mine/waterfall.svg");
    for key in &keys {
        assert_eq!(figure.matches(&format!("data-job=\"{key}\"")).count(), 1, "{key}");
    }
    assert_eq!(figure.matches("data-job=").count(), 2);
    let lines = rows(&folder.read("reports/mine/waterfall.csv"));
    assert!(lines.iter().all(|line| keys.contains(&line["job"])) && lines.len() > 100);
}

/// Protects: all jobs of a study can be inspected by one command, each in a folder of its own.
#[test]
fn all_jobs_are_inspected() {
    let folder = folder();
    let pages = folder.ok("inspect mine.json omega_rpm=7 --all --frames 16 --out out");
    assert_eq!(
        pages.lines().collect::<Vec<_>>(),
        ["out/mu-0.2_omega_rpm-7/index.html", "out/mu-0.4_omega_rpm-7/index.html"]
    );
    let found = ["0.2", "0.4"].map(|mu| summary(&folder, &format!("out/mu-{mu}_omega_rpm-7")));
    assert_ne!(found[0]["key"], found[1]["key"]);
}

/// Protects: messages about wrong arguments say what is expected, and no file is written.
#[test]
fn wrong_arguments_are_explained() {
    let folder = folder();
    for (arguments, expected) in [
        ("mine.json omega=7", "did you mean `omega_rpm`"),
        ("mine.json mu=nought", "mu"),
        ("mine.json 0000", "no job of mine has a key that begins with `0000`"),
        ("mine.json omega_rpm=7 0000", "expected NAME=VALUE"),
        ("mine.json --node front", "front_centre, rear_centre"),
        ("mine.json --node 90,0", "90,0 mm is not on the contact face; expected x from -6 to 6"),
        ("mine.json --cycles 2", "3..=100"),
        ("mine.json --overlay omega_rpm", "expected NAME=VALUE"),
        ("mine.json --overlay omega_rpm=,", "--overlay omega_rpm: expected values"),
        ("mine.json --overlay speed=1,2", "no such parameter"),
        ("mine.json 0000 --overlay mu=0.2,0.3", "expected NAME=VALUE, not the key `0000`"),
        ("mine.json 0000 --preset draft", "has its own mesh"),
        ("other.json", "other.json"),
        ("mine.json --overlay mu=0.2,0.4 --frames 20", "cannot be used with"),
        ("mine.json mu", "NAME=VALUE, for example mu=…"),
        ("mine.json 0000 --all", "with --all expected NAME=VALUE"),
        ("mine.json mu=0.3 --all", "no job of mine has mu=0.3"),
        ("mine.json omega=7 --all", "did you mean `omega_rpm`"),
        ("mine.json --all --preset draft", "cannot be used with"),
        ("mine.json --only spectrum --cycles 5", "cannot be used with"),
        ("mine.json --only everything", "[possible values: spectrum]"),
        ("mine.json omega=7", "NAME=VALUE: omega"),
        ("mine.json --node 9,0", "9,0 mm is not"),
        ("mine.json --out mine.json/out", "mine.json/out: "),
    ] {
        let assert = folder.command(&format!("inspect {arguments}")).assert().code(2);
        assert!(stderr(&assert).contains(expected), "{arguments}: {}", stderr(&assert));
    }
    assert_eq!(folder.files(), ["mine.json"]);
    folder.ok("submit mine.json");
    let assert = folder.command("inspect yours mu=0.2").assert().code(2);
    assert!(stderr(&assert).contains("mine"), "{}", stderr(&assert));
}

/// Protects: Ctrl-C ends an inspection with the code for jobs that are left, and no incomplete file remains.
#[cfg(target_os = "linux")]
#[test]
fn an_inspection_can_be_interrupted() {
    let folder = Folder::with("long", &long());
    let running = folder.start("inspect long.json mu=0.4 omega_rpm=7 limit_s=100 --out out");
    wait("the signal handler", || handles_interrupts(&running));
    running.signal("INT");
    let (code, out, error) = running.end();
    assert_eq!((code, out.as_str()), (Some(3), ""), "{error}");
    assert!(error.contains("interrupted"), "{error}");
    assert_eq!(folder.files(), ["long.json"]);
}

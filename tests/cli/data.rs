//! All data of a sweep: `show`, `export --all`, several studies in one table, and the list of the columns.

use serde_json::{Value, json};
use sqlx::sqlite::SqliteConnectOptions;
use sqlx::{ConnectOptions, SqliteConnection};

use crate::cli::support::{ExportRow, Folder, HEADER, rows, small, stderr, stdout};

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// The names of the columns.
fn columns(folder: &Folder, arguments: &str) -> Vec<Value> {
    parsed(&folder.ok(&format!("columns --json {arguments}"))).as_array().unwrap().clone()
}

/// A number in a cell.
fn number(row: &ExportRow, name: &str) -> Value {
    serde_json::from_str(&row[name]).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Runs a statement on the database of a folder.
fn change(folder: &Folder, statement: &'static str) {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    runtime.block_on(async {
        let options = SqliteConnectOptions::new().filename(folder.path("tribosweep.db"));
        let mut connection: SqliteConnection = options.connect().await.unwrap();
        sqlx::query(statement).execute(&mut connection).await.unwrap();
    });
}

/// Protects: the page of the columns has exactly the columns that the program prints, in their order, with their units and
/// meanings. The plain ones are the header of the export.
#[test]
fn the_columns_are_documented() {
    let folder = Folder::new();
    let text = |column: &Value, name: &str| column[name].as_str().unwrap_or_default().to_owned();
    let line = |column: &Value| {
        let [name, unit, meaning] = ["name", "unit", "meaning"].map(|field| text(column, field));
        format!("| `{name}` | {unit} | {meaning} |")
    };
    let expected: Vec<String> = columns(&folder, "--all").iter().map(line).collect();
    let page = include_str!("../../docs/reference.md");
    let chapter = page.split("\n## ").find(|chapter| chapter.starts_with("Columns\n")).expect("a chapter");
    let documented: Vec<&str> = chapter.lines().filter(|line| line.starts_with("| `")).collect();
    assert_eq!(documented, expected, "docs/reference.md should have\n{}", expected.join("\n"));

    let plain: Vec<String> = columns(&folder, "").iter().map(|column| text(column, "name")).collect();
    assert_eq!(plain.join(","), HEADER);
    let printed = folder.ok("columns");
    let names: Vec<_> = printed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(names, plain);
    assert_eq!(folder.files(), [""; 0]);
}

/// Protects: `export --all` has the documented columns: every input, also those that no study names, and the whole record,
/// with the values that `solve` prints. Without `--all` it has the same columns as ever.
#[test]
fn all_data_are_exported() {
    let folder = Folder::with("mine", &small(&json!({ "nx": [3, 4], "cycles": [10], "mu": [0.4] })));
    folder.ok("run mine.json");
    let export = folder.ok("export mine --all");
    let header: Vec<&str> = export.lines().next().unwrap().split(',').collect();
    let documented = columns(&folder, "--all");
    assert_eq!(header, documented.iter().map(|column| column["name"].as_str().unwrap()).collect::<Vec<_>>());
    let plain = folder.ok("export mine");
    assert_eq!(plain.lines().next().unwrap(), format!("{HEADER},parameter_cycles,nx"));

    let row = &rows(&export)[1];
    for (name, value) in [
        ("elements_x", json!(4)),
        ("elements_y", json!(4)),
        ("size_y_m", json!(0.015)),
        ("young_modulus_pa", json!(1e9)),
        ("load_n", json!(30)),
        ("beta_r_s", json!(2.75e-8)),
        ("limit_s", json!(0.012)),
        ("parameter_cycles", json!(10)),
        ("tolerance", json!(0.01)),
    ] {
        assert_eq!(number(row, name).as_f64(), value.as_f64(), "{name}");
    }
    assert_eq!((row["clamp_side"].as_str(), row["stop_early"].as_str()), ("inner_side", "true"));
    assert_eq!((row["disk_kind"].as_str(), row["disk_density_kg_m3"].as_str()), ("rigid", ""));

    let record = parsed(&folder.ok("solve mine.json --set nx=4 --set mu=0.4 --set cycles=10 --json"));
    for (name, pointer) in [
        ("lift_max_m", "/lift_max_m"),
        ("mu_reduction_slip", "/mu_reduction_slip"),
        ("clamp_width_on_mesh_m", "/clamp_width_m"),
        ("energy_friction_j", "/energy/friction_j"),
        ("front_centre_y_peak_to_peak_m", "/nodes/0/y_peak_to_peak_m"),
        ("rear_centre_sigma_n_max_pa", "/nodes/1/sigma_n_max_pa"),
    ] {
        assert_eq!(number(row, name).as_f64(), record.pointer(pointer).unwrap().as_f64(), "{name}");
    }
    let lines: Vec<Value> = folder.ok("export mine --all --format json").lines().map(parsed).collect();
    assert_eq!(lines[1]["energy_friction_j"], record["energy"]["friction_j"]);
    assert_eq!(lines[1].as_object().unwrap().len(), header.len());
}

/// Protects: several studies are one table with the parameters of all of them. Without a name it has every study, and a study
/// that is given twice is there once. An unknown study is an error before anything is written.
#[test]
fn studies_are_joined() {
    let folder = Folder::with("one", &small(&json!({ "mu": [0.2, 0.4] })));
    folder.add("two", &small(&json!({ "load_n": [10, 20], "clamp_side": ["outer_side"] })));
    folder.ok("submit one.json");
    folder.ok("submit two.json");
    let both = folder.ok("export one two");
    assert_eq!(both.lines().next().unwrap(), format!("{HEADER},clamp_side,load_n"));
    let found: Vec<_> = rows(&both)
        .into_iter()
        .map(|row| format!("{} {} {} {}", row["study"], row["mu"], row["load_n"], row["clamp_side"]))
        .collect();
    assert_eq!(found, ["one 0.2  ", "one 0.4  ", "two 0.4 10 outer_side", "two 0.4 20 outer_side"]);
    assert_eq!(folder.ok("export"), both);
    assert_eq!(folder.ok("export one two.json one"), both);
    let objects: Vec<Value> = folder.ok("export --format json").lines().map(parsed).collect();
    assert_eq!((&objects[0]["load_n"], &objects[3]["load_n"]), (&Value::Null, &json!(20.0)));
    assert_eq!(rows(&folder.ok("export --all")).len(), 4);

    let unknown = folder.command("export one three").assert().code(2);
    assert_eq!(stdout(&unknown), "");
    assert!(stderr(&unknown).contains("no study `three`"), "{}", stderr(&unknown));
}

/// Protects: `show` tells the inputs with units, every figure of the result and readable dates. As JSON it has the job as
/// submitted and the record as `solve` prints it.
#[test]
fn a_job_is_shown_with_all_that_is_known() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.4] })));
    folder.ok("submit mine.json");
    let key = rows(&folder.ok("export mine"))[0]["job"].clone();
    let pending = folder.ok(&format!("show {key}"));
    assert!(pending.contains("state  pending\n") && pending.contains("young_modulus_pa"), "{pending}");
    assert!(!pending.contains("mu_star") && pending.contains("started    –\n"), "{pending}");

    folder.ok("run mine.json");
    let text = folder.ok(&format!("show {key}"));
    let has = |words: &[&str]| {
        text.lines().any(|line| line.split_whitespace().collect::<Vec<_>>().starts_with(words))
    };
    for words in [
        ["study", "mine:", "μ", "=", "0.4"].as_slice(),
        &["size_x_m", "12", "mm"],
        &["elements_x", "3"],
        &["young_modulus_pa", "1", "GPa"],
        &["load_n", "30", "N"],
        &["stop_early", "true"],
        &["decay_observation_s", "8", "ms"],
    ] {
        assert!(has(words), "{words:?} in\n{text}");
    }
    let shown = parsed(&folder.ok(&format!("show {key} --json")));
    let record = parsed(&folder.ok("solve mine.json --set mu=0.4 --json"));
    assert_eq!(shown["record"], record);
    assert_eq!(shown["inputs"]["elements_y"], json!(4));
    assert_eq!(shown["inputs"]["mu"], shown["spec"]["scene"]["contact"]["mu"]);
    assert_eq!(shown["studies"][0]["parameters"], json!({ "mu": 0.4 }));
    let row = &rows(&folder.ok("export --all"))[0];
    let elsewhere = ["study", "job", "omega_rpm", "mu", "status", "wall_s"];
    for column in columns(&folder, "--all") {
        let name = column["name"].as_str().unwrap();
        let shown_as = name.strip_prefix("parameter_").unwrap_or(name);
        if !row[name].is_empty() && !elsewhere.contains(&name) {
            assert!(has(&[shown_as]), "{name} in\n{text}");
        }
    }
    let energies =
        text.lines().filter(|line| line.trim_start().starts_with("energy_") && line.contains(" %)"));
    assert_eq!(energies.count(), 7, "{text}");
    let finished = shown["finished"].as_str().unwrap();
    assert_eq!((finished.len(), &finished[10..11], &finished[23..]), (24, "T", "Z"));
    let date = format!("{} {} UTC", &finished[..10], &finished[11..19]);
    assert!(text.contains(&format!("finished      {date}\n")), "{text}");
    for fact in ["version", "commit", "host", "threads"] {
        assert!(has(&[fact]), "{fact} in\n{text}");
    }
}

/// Protects: a job of a study in the database is inspected as it was submitted, even if this version expands the stored
/// document into other jobs.
#[test]
fn a_stored_job_is_inspected_as_submitted() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4], "omega_rpm": [7] })));
    folder.ok("submit mine.json");
    let row = rows(&folder.ok("export mine")).remove(0);
    // As if another version had filled in another load.
    change(
        &folder,
        r#"UPDATE studies SET document = replace(document, '"scene":{', '"scene":{"load":{"force_n":20},')"#,
    );
    folder.command("inspect mine 0000").assert().code(2);
    let page = folder.ok(&format!("inspect mine {}", &row["job"][..10]));
    assert_eq!(page.trim(), "reports/mine/inspect/mu-0.2_omega_rpm-7/index.html");
    let found = parsed(&folder.read("reports/mine/inspect/mu-0.2_omega_rpm-7/inspection.json"));
    let scene = &found["job"]["scene"];
    assert_eq!((&scene["load"]["force_n"], &scene["contact"]["mu"]), (&json!(30.0), &json!(0.2)));
}

/// Protects: a study that was submitted without a damping, when the default was another one, keeps that of its jobs: in `inspect` by
/// parameters, in `diff`, and in the report. Submitted again it is told apart, and the damping is named.
#[test]
fn a_stored_study_keeps_the_default_of_its_time() {
    let mut study = small(&json!({ "mu": [0.4], "omega_rpm": [7] }));
    study["numerics"] = json!({ "beta_r_s": 5e-8 });
    let folder = Folder::with("mine", &study);
    folder.ok("run mine.json");
    // As a version wrote it whose default was 50 ns.
    change(&folder, r#"UPDATE studies SET document = replace(document, '"beta_r_s":5e-8', '')"#);
    let row = rows(&folder.ok("export mine")).remove(0);
    folder.ok("inspect mine mu=0.4 omega_rpm=7");
    let found = parsed(&folder.read("reports/mine/inspect/mu-0.4_omega_rpm-7/inspection.json"));
    assert_eq!(found["job"]["numerics"]["beta_r_s"], json!(5e-8));
    assert_eq!(found["record"]["mu_star"].to_string(), row["mu_star"]);
    let same = Folder::with("mine", &study);
    std::fs::copy(folder.path("tribosweep.db"), same.path("tribosweep.db")).unwrap();
    same.ok("diff mine mine.json");
    study["numerics"] = json!({});
    folder.add("mine", &study);
    let refused = folder.command("run mine.json").assert().code(2);
    assert!(stderr(&refused).contains("beta_r_s: 50 ns → 27.5 ns"), "{}", stderr(&refused));
}

/// Protects: the windows of a job whose speed changes are exported, with the study and the job, and a job without a program
/// has none. Its status is `completed`.
#[test]
fn windows_are_exported() {
    let mut study = small(&json!({ "mu": [0.3] }));
    study["run"] = json!({ "limit_s": 0.003, "window_s": 0.0005 });
    study["scene"]["program"] = json!({ "omega_rpm": [[0.001, 1], [0.002, 20], [0.003, 1]] });
    let folder = Folder::with("ramp", &study);
    folder.add("constant", &small(&json!({ "mu": [0.0] })));
    for name in ["ramp", "constant"] {
        folder.ok(&format!("run {name}.json --threads 1"));
    }
    assert_eq!(rows(&folder.ok("export ramp"))[0]["status"], "completed");
    let windows = folder.ok("export --windows");
    assert_eq!(windows.lines().count(), 1 + 6, "{windows}");
    assert!(windows.lines().skip(1).all(|line| line.starts_with("ramp,")), "{windows}");
    for (direction, count) in [("up", 2), ("down", 2)] {
        let is_own = |line: &&str| line.contains(&format!(",{direction},"));
        assert_eq!(windows.lines().filter(is_own).count(), count, "{windows}");
    }
}

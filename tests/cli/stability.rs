//! `stability`: complex modes over the grid of a study, thresholds, and the study in the database that holds them.

use serde_json::{Value, json};

use crate::cli::support::{ExportRow, Folder, rows, small, stderr, stdout, wall_times};

const COLUMNS: &str = "omega_rpm,mu,mode,frequency_hz,frequency_mesh_error_hz,growth_rate_per_s,\
growth_rate_mesh_error_per_s,damping_ratio,residual,converged,contact_nodes,lifted_nodes,band_hz,above_band";

fn number(row: &ExportRow, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

/// Protects: one command computes the modes at every point of the grid, prints them, and writes the tables. The points
/// between those of the grid are in the database but not in the table.
#[test]
fn modes_of_a_study_in_one_command() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.1, 0.4], "omega_rpm": [7, 20] })));
    let run = folder.command("stability study.json --modes 2 --csv own.csv --threads 2").assert().code(0);
    let table = folder.read("own.csv");
    assert_eq!(table.lines().next().unwrap(), COLUMNS);
    let lines = rows(&table);
    assert_eq!(lines.len(), 8, "two modes at each of four points: {table}");
    for point in lines.chunks(2) {
        assert_eq!((point[0]["mode"].as_str(), point[1]["mode"].as_str()), ("1", "2"));
        assert!(
            number(&point[0], "growth_rate_per_s") >= number(&point[1], "growth_rate_per_s"),
            "{point:?}"
        );
        assert_eq!(point[0]["converged"], "true");
        assert_eq!(number(&point[0], "contact_nodes") + number(&point[0], "lifted_nodes"), 20.0);
    }
    let text = stdout(&run);
    // What is the same in all lines stands once, below the table, and the rest in it.
    let head: Vec<&str> = text.lines().next().unwrap().split_whitespace().collect();
    let varies = |name: &&str| {
        let values: std::collections::BTreeSet<&str> = lines.iter().map(|row| row[*name].as_str()).collect();
        values.len() > 1
    };
    assert_eq!(head, COLUMNS.split(',').filter(varies).collect::<Vec<_>>(), "{text}");
    let below = text.lines().nth(9).unwrap();
    assert!(below.starts_with("In all lines: ") && below.contains("converged yes"), "{text}");
    assert!(!below.contains("mesh_error"), "an unknown error is said in words: {text}");
    assert!(text.contains("\nThresholds\n"), "{text}");

    // The report has all modes.
    let all = rows(&folder.read("reports/study-stability/modes.csv"));
    assert!(all.len() > lines.len());
    let thresholds = rows(&folder.read("reports/study-stability/thresholds.csv"));
    // A line for each mode that grows.
    let mut speeds: Vec<&str> = thresholds.iter().map(|row| row["omega_rpm"].as_str()).collect();
    speeds.dedup();
    assert_eq!(speeds, ["7", "20"]);
    // The lowest threshold of each speed comes first, and only that one is narrowed down.
    let lowest = speeds.iter().filter_map(|speed| thresholds.iter().find(|row| row["omega_rpm"] == *speed));
    for own in lowest.filter(|row| !row["mu_c"].is_empty()) {
        let [below, mu_c, above] = ["mu_below", "mu_c", "mu_above"].map(|column| number(own, column));
        assert!(below <= mu_c && mu_c <= above && above - below < 0.003 * mu_c, "{own:?}");
    }

    let export = rows(&folder.ok("export study-stability --all"));
    assert!(export.len() >= 12, "five steps between the μ of each speed: {}", export.len());
    for row in &export {
        assert!(["decayed", "unstable"].contains(&row["status"].as_str()), "{row:?}");
        assert_eq!((row["decided_by"].as_str(), row["steps"].as_str()), ("eigenvalues", "0"));
        assert_eq!(row["status"] == "decayed", number(row, "mode_growth_rate_per_s") < 0.0, "{row:?}");
    }
    let shown = folder.ok(&format!("show {}", export[0]["job"]));
    assert!(shown.contains("Modes of steady sliding below "), "{shown}");
    assert!(shown.contains("none, because the job has no run"), "{shown}");

    let lines_of_json = folder.ok("stability study.json --modes 2 --json");
    assert_eq!(lines_of_json.lines().count(), 8);
    for (line, row) in lines_of_json.lines().zip(&lines) {
        let object: Value = serde_json::from_str(line).unwrap();
        assert_eq!(object["growth_rate_per_s"].as_f64().unwrap(), number(row, "growth_rate_per_s"));
        assert_eq!(object["converged"], true);
    }

    // Modes that grow stay first, and the others come in the order of their distance.
    let near = folder.ok("stability study.json --modes 12 --near 20kHz --json");
    let near: Vec<Value> = near.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let of = |row: &Value, name: &str| row[name].as_f64().unwrap();
    let place = |row: &Value| {
        let distance =
            if of(row, "growth_rate_per_s") >= 0.0 { 0.0 } else { (of(row, "frequency_hz") - 2.0e4).abs() };
        (of(row, "mu"), of(row, "omega_rpm"), distance)
    };
    for pair in near
        .windows(2)
        .filter(|pair| pair[0]["mu"] == pair[1]["mu"] && pair[0]["omega_rpm"] == pair[1]["omega_rpm"])
    {
        assert!(place(&pair[0]).2 <= place(&pair[1]).2, "{pair:?}");
    }
    assert!(near.iter().any(|row| of(row, "growth_rate_per_s") > 0.0));
    assert_ne!(near[0]["mode"].as_u64(), Some(1), "the order by distance is that of growth: {near:?}");
    // One mode that decays stands beside all that grow, and what is not known is said.
    let run = folder.command("stability study.json --modes 1 --near 20kHz --json").assert().code(0);
    assert!(stderr(&run).contains("may be nearer to this frequency"), "{}", stderr(&run));
    let said = folder.ok("stability study.json --modes 1 --near 20kHz");
    let grows_near = |row: &&Value| {
        of(row, "growth_rate_per_s") >= 0.0 && (of(row, "frequency_hz") - 2.0e4).abs() <= 2.0e3
    };
    let places: Vec<_> = near.iter().filter(grows_near).map(|row| (place(row).0, place(row).1)).collect();
    let places = places.iter().enumerate().filter(|(at, own)| !places[..*at].contains(own)).count();
    let expected = match places {
        0 => "No known mode within 10 % of 20 kHz grows at any of 4 points of the grid.".to_owned(),
        some => format!("A mode within 10 % of 20 kHz grows at {some} of 4 points of the grid."),
    };
    assert!(said.contains(&expected), "{expected} {said}");
    let few = stdout(&run).lines().count();
    let growing = near.iter().filter(|row| of(row, "growth_rate_per_s") >= 0.0).count();
    assert_eq!(few, growing + 4, "{growing} modes grow at four points");
}

/// Protects: the same command again computes nothing, a wider grid computes only what is new, and nothing that was computed
/// goes out of view.
#[test]
fn nothing_is_computed_twice() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.1, 0.4], "omega_rpm": [7] })));
    let first = folder.ok("stability study.json");
    let before = wall_times(&folder.ok("export study-stability"));
    let again = folder.command("stability study.json").assert().code(0);
    assert_eq!(stdout(&again), first);
    assert!(stderr(&again).contains(" 0 new, "), "{}", stderr(&again));
    assert_eq!(wall_times(&folder.ok("export study-stability")), before);

    folder.ok("stability study.json --set mu=[0.1,0.22,0.4]");
    let after = wall_times(&folder.ok("export study-stability"));
    assert!(after.len() > before.len());
    assert!(before.iter().all(|(job, wall_s)| after[job] == *wall_s), "{before:?} {after:?}");

    // A study whose grid has one of these μ alone loses none of them, and looks for no thresholds.
    folder.ok("stability study.json --set mu=0.4");
    assert_eq!(wall_times(&folder.ok("export study-stability")), after);
}

/// Protects: a study that was not made to grow, as those of earlier versions, grows when thresholds are asked for. Its points are found
/// again, also those that the grid does not have any more.
#[test]
fn thresholds_begin_with_the_points_that_are_there() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.1, 0.4], "omega_rpm": [7] })));
    folder.ok("stability study.json --no-thresholds --set mu=[0.1,0.21,0.4]");
    let before = wall_times(&folder.ok("export study-stability"));
    let printed = folder.ok("stability study.json");
    assert!(printed.contains("mu_c"), "{printed}");
    let after = wall_times(&folder.ok("export study-stability"));
    assert!(after.len() > before.len());
    assert!(before.iter().all(|(job, wall_s)| after[job] == *wall_s), "{before:?} {after:?}");
    let status = folder.ok("status study-stability");
    assert!(status.contains("earlier: 1") && status.contains("boundary"), "{status}");
}

/// Protects: any worker plans the waves of the thresholds, and after Ctrl-C they go on to the same points.
#[cfg(unix)]
#[test]
fn other_workers_go_on_with_the_thresholds() {
    let study = small(&json!({ "mu": [0.05, 0.6], "omega_rpm": [3, 20] }));
    let undisturbed = Folder::with("study", &study);
    undisturbed.ok("stability study.json");
    let folder = Folder::with("study", &study);
    let sweep = folder.start("stability study.json --threads 1");
    folder.wait_for("study-stability", |counts| counts["done"] > 0);
    sweep.signal("INT");
    let (code, _, messages) = sweep.end();
    // A fast machine may have finished before the signal.
    assert!(matches!(code, Some(0 | 3)), "{code:?}: {messages}");
    folder.ok("work --threads 2");
    let status: Value = serde_json::from_str(&folder.ok("status study-stability --json")).unwrap();
    assert_eq!(status["plan"], "complete", "{status}");
    let again = folder.command("stability study.json").assert().code(0);
    assert!(stderr(&again).contains(" 0 new, "), "{}", stderr(&again));
    for file in ["modes.csv", "thresholds.csv"] {
        let path = format!("reports/study-stability/{file}");
        assert_eq!(folder.read(&path), undisturbed.read(&path), "{file}");
    }
}

/// Protects: without thresholds the study has the points of its grid alone, and a study that does not vary μ has none.
#[test]
fn thresholds_are_left_out_on_request() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.1, 0.4] })));
    let text = folder.ok("stability study.json --no-thresholds");
    assert!(!text.contains("Thresholds"), "{text}");
    assert_eq!(rows(&folder.ok("export study-stability")).len(), 2);
    folder.ok("stability study.json --set mu=0.1 --name one");
    assert_eq!(rows(&folder.ok("export one-stability")).len(), 1);
}

/// Protects: the study of modes is an ordinary study beside the study itself: it has a document, a state and a report, it can
/// be removed, and its file is refused where modes have no place.
#[test]
fn the_study_of_modes_is_an_ordinary_study() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.2], "omega_rpm": [7] })));
    folder.ok("stability study.json");
    folder.ok("run study.json");
    let counts = folder.counts("study-stability");
    assert_eq!((counts["done"], counts["total"]), (1, 1));
    let document = folder.ok("document study-stability");
    folder.write("copy.json", &document);
    let refused = folder.command("run copy.json").assert().code(2);
    assert!(stderr(&refused).contains("`tribosweep stability` computes modes"), "{}", stderr(&refused));
    folder.ok("report study-stability");
    folder.ok("--db other.db merge tribosweep.db");
    assert_eq!(folder.ok("--db other.db document study-stability"), document);
    folder.ok("rm study-stability");
    folder.ok("gc");
    assert_eq!(folder.counts("study")["done"], 1);
}

/// Protects: after Ctrl-C the same command continues, and no point is computed twice.
#[cfg(unix)]
#[test]
fn an_interrupted_sweep_continues() {
    let grid = json!({
        "mu": { "from": 0.05, "to": 0.6, "count": 12 },
        "omega_rpm": { "from": 1, "to": 100, "count": 4, "spacing": "log", "digits": 3 },
    });
    let folder = Folder::with("study", &small(&grid));
    let sweep = folder.start("stability study.json --no-thresholds --threads 1");
    folder.wait_for("study-stability", |counts| counts["done"] > 0);
    sweep.signal("INT");
    let (code, _, messages) = sweep.end();
    // A fast machine may have finished before the signal.
    assert!(matches!(code, Some(0 | 3)), "{code:?}: {messages}");
    let before = wall_times(&folder.ok("export study-stability"));
    assert!(!before.is_empty());
    folder.ok("stability study.json --no-thresholds --threads 2");
    let after = wall_times(&folder.ok("export study-stability"));
    assert_eq!(after.len(), 48);
    assert!(before.iter().all(|(job, wall_s)| after[job] == *wall_s));
    // Thresholds of an interrupted search are not those of a finished one.
    let search = folder.start("stability study.json --threads 1");
    folder.wait_for("study-stability", |counts| counts["done"] > 48);
    search.signal("INT");
    let (code, printed, messages) = search.end();
    assert!(matches!(code, Some(0 | 3)), "{code:?}: {messages}");
    assert_eq!(printed.contains("\nThresholds so far"), code == Some(3), "{printed}");
}

/// Protects: the folder of the command is a report: a page with its figures, what was analysed, where it comes from, and the
/// tables. The report of the study itself has the section, too.
#[test]
fn the_folder_is_a_report() {
    let study = small(&json!({ "mu": [0.1, 0.4], "omega_rpm": [7, 20] }));
    let folder = Folder::with("study", &study);
    let text = folder.ok("stability study.json");
    let path = |file: &str| format!("reports/study-stability/{file}");
    for figure in ["stability_map.svg", "lock_in.svg", "thresholds.svg"] {
        assert!(folder.read(path(figure)).starts_with("<svg"), "{figure}");
    }
    let page = folder.read(path("stability.html"));
    for part in ["study-stability", "Linear stability", "What was analysed", "Provenance", "modes.csv", "μ_c"]
    {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("href=\"modes/\"") && !page.contains("time step that was used"));
    assert_eq!(folder.read(path("modes.csv")).lines().next().unwrap(), COLUMNS);

    // What is printed is the lowest threshold of the file, in words.
    let printed: Vec<&str> =
        text.split("\nThresholds\n").nth(1).unwrap().lines().map(str::trim_start).collect();
    let thresholds = rows(&folder.read(path("thresholds.csv")));
    assert!(printed.len() >= 3, "{text}");
    for (line, omega_rpm) in printed[1..3].iter().zip(["7", "20"]) {
        let first = thresholds.iter().find(|row| row["omega_rpm"] == omega_rpm).unwrap();
        let words = line.strip_prefix(omega_rpm).unwrap().trim_start();
        let is_same = match (first["mu_c"].is_empty(), first["mu_below"].is_empty()) {
            (false, _) => {
                let shown: f64 = words.split_whitespace().next().unwrap().parse().unwrap();
                (shown - number(first, "mu_c")).abs() < 0.000_051
            }
            (true, true) => words.starts_with(&format!("≤ {}", first["mu_above"])),
            (true, false) => words.starts_with(&format!("> {}", first["mu_below"])),
        };
        assert!(is_same, "{line}: {first:?}");
    }

    folder.ok("run study.json");
    folder.ok("report study");
    assert!(folder.read("reports/study/report.html").contains("<h2>Linear stability</h2>"));
    assert_eq!(folder.read("reports/study/thresholds.csv"), folder.read(path("thresholds.csv")));
}

/// Protects: the shapes of the first modes at every point of the grid are files that ParaView reads, the largest amplitude is 5 %
/// of the pin's shortest edge, and a grid that is too large is refused before the work. With a frequency the shapes are those of the modes
/// that are shown.
#[test]
fn shapes_are_written_on_request() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.1, 0.4] })));
    folder.ok("stability study.json --modes 2 --shapes --no-thresholds --set omega_rpm=7");
    let modes = folder.path("reports/study-stability/modes");
    for mu in ["0.1", "0.4"] {
        for mode in ["1", "2"] {
            let name = format!("omega_rpm-7_mu-{mu}_mode-{mode}");
            let series = folder.read(modes.join(format!("{name}.pvd")));
            let files: Vec<&str> =
                series.split("file=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
            assert_eq!(files.len(), 24, "{series}");
            for file in files {
                let contents = std::fs::read(modes.join(file)).unwrap();
                assert!(contents.starts_with(b"<?xml") && contents.ends_with(b"</VTKFile>\n"), "{file}");
            }
        }
    }
    let listed = std::fs::read_dir(&modes).unwrap().flatten();
    let series = listed.filter(|entry| entry.path().extension().is_some_and(|own| own == "pvd"));
    assert_eq!(series.count(), 4);
    assert!(folder.read("reports/study-stability/stability.html").contains("href=\"modes/\""));

    let near = "stability study.json --modes 1 --near 20kHz --shapes --name near --no-thresholds --set omega_rpm=7 --json";
    let shown = folder.ok(near);
    let shown: Vec<Value> = shown.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(
        shown.iter().any(|row| row["mode"] != 1),
        "no mode but the first is shown, so the test shows nothing: {shown:?}"
    );
    let mut expected: Vec<String> =
        shown.iter().map(|row| format!("omega_rpm-7_mu-{}_mode-{}", row["mu"], row["mode"])).collect();
    let listed = std::fs::read_dir(folder.path("reports/near-stability/modes")).unwrap().flatten();
    let names = listed.map(|entry| entry.file_name().into_string().unwrap());
    let mut found: Vec<String> =
        names.filter_map(|name| name.strip_suffix(".pvd").map(str::to_owned)).collect();
    expected.sort();
    found.sort();
    assert_eq!(found, expected);

    let many = r#"stability study.json --shapes --name many --set mu={"from":0.1,"to":0.6,"count":51}"#;
    let refused = folder.command(many).assert().code(2);
    let message = stderr(&refused);
    assert!(
        message.contains("at most 50 points, and the grid has 51") && message.contains("--set"),
        "{message}"
    );
    assert!(!folder.path("reports/many-stability").exists());
}

/// Protects: what eigenvalues decide without a run has the outcome that the run has.
#[test]
fn eigenvalues_and_runs_agree() {
    let mut study = small(&json!({ "mu": [0.1, 0.6], "omega_rpm": [7] }));
    study["run"] = json!({ "limit_s": 0.1 });
    let folder = Folder::with("study", &study);
    folder.ok("run study.json --set stability=eigenvalues");
    folder.ok("run study.json --name simulated");
    let statuses = |name: &str| -> Vec<(String, String)> {
        let all = rows(&folder.ok(&format!("export {name}")));
        all.iter().map(|row| (row["mu"].clone(), row["status"].clone())).collect()
    };
    let decided = statuses("study");
    assert_eq!(decided, statuses("simulated"));
    assert_eq!(decided[0], ("0.1".to_owned(), "decayed".to_owned()));
    assert_ne!(decided[1].1, "decayed");
    let by: Vec<String> =
        rows(&folder.ok("export study --all")).iter().map(|row| row["decided_by"].clone()).collect();
    assert_eq!(by, ["eigenvalues", "run"]);
    let simulated = rows(&folder.ok("export simulated --all"));
    assert!(simulated.iter().all(|row| row["decided_by"] == "run"), "{simulated:?}");
}

/// Protects: a study with too many unknowns of pin and elastic disk is refused before any point is submitted.
#[test]
fn an_elastic_disk_that_is_too_fine_is_refused() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.1, 0.4] })));
    let refused = folder.command("stability study.json --set disk_kind=elastic").assert().code(2);
    let message = stderr(&refused);
    assert!(
        message.contains("at most 30000 displacements") && message.contains("element_size_m"),
        "{message}"
    );
    folder.command("export study-stability").assert().code(2);
}

/// Protects: a zip that moves μ and ω has thresholds: those of μ or, on request, of ω. Points between those of the list are on the way
/// between them, and the table has one line.
#[test]
fn a_zip_of_speed_and_friction_has_thresholds() {
    let mut study = small(&json!({ "young_modulus_pa": [1e9] }));
    study["samples"] = json!({ "zip": { "mu": [0.1, 0.3, 0.6], "omega_rpm": [5, 7, 10] } });
    let folder = Folder::with("study", &study);
    for (along, parameter) in [("", "mu"), (" --along omega_rpm", "omega_rpm")] {
        let printed = folder.ok(&format!("stability study.json{along}"));
        let (_, thresholds) = printed.split_once("Thresholds").unwrap();
        assert!(thresholds.contains(&format!("Thresholds are those of {parameter}, ")), "{thresholds}");
        assert!(
            thresholds.contains("moves") && thresholds.contains(&format!("{parameter}_c")),
            "{thresholds}"
        );
        let lines = rows(&folder.read("reports/study-stability/thresholds.csv"));
        assert!(!lines[0][&format!("{parameter}_c")].is_empty(), "{thresholds}");
        // Figures over the other of the two would have no axis.
        let drawn = ["lock_in.svg", "stability_map.svg", "thresholds.svg"]
            .map(|file| folder.path(format!("reports/study-stability/{file}")).exists());
        assert_eq!(drawn, [true, false, false]);
    }
    for row in rows(&folder.ok("export study-stability")) {
        let [mu, omega_rpm] = ["mu", "omega_rpm"].map(|name| number(&row, name));
        let on_the_way = if mu <= 0.3 { 5.0 + 10.0 * (mu - 0.1) } else { 7.0 + 10.0 * (mu - 0.3) };
        assert!((omega_rpm - on_the_way).abs() < 1.0e-6, "{row:?}");
    }
}

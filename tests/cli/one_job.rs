//! `solve`: one job in the foreground.

use serde_json::{Value, json};

use crate::cli::support::{Folder, handles_interrupts, rows, small, stderr, wait};

const HISTORY: &str = "time_s,load_n,normal_n,smooth_normal_n,clamp_tangential_n,contact_tangential_n,contact_sideways_n,mu_eq,\
stick_nodes,slip_nodes,separated_nodes,\
front_centre_ux_m,front_centre_uy_m,front_centre_uz_m,front_centre_y_velocity_m_s,front_centre_gap_m,\
front_centre_friction_x_n,front_centre_friction_y_n,front_centre_normal_n,front_centre_slip_speed_m_s,\
front_centre_mu_eq,front_centre_state,front_centre_sigma_n_delayed_pa,\
rear_centre_ux_m,rear_centre_uy_m,rear_centre_uz_m,rear_centre_y_velocity_m_s,rear_centre_gap_m,\
rear_centre_friction_x_n,rear_centre_friction_y_n,rear_centre_normal_n,rear_centre_slip_speed_m_s,\
rear_centre_mu_eq,rear_centre_state,rear_centre_sigma_n_delayed_pa";

fn folder() -> Folder {
    Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4], "omega_rpm": [2, 7] })))
}

/// The rows of a history.
struct History(Vec<crate::cli::support::ExportRow>);

impl History {
    fn read(folder: &Folder, file: &str) -> Self {
        let text = folder.read(file);
        assert_eq!(text.lines().next().unwrap(), HISTORY);
        Self(rows(&text))
    }

    fn column(&self, name: &str) -> Vec<f64> {
        self.0.iter().map(|row| row[name].parse().unwrap()).collect()
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Protects: the history has one line per step with increasing time, and every contact node is in one state. In the steady
/// state the mean of N is the load and the mean of T/F is μ*.
#[test]
fn the_history_is_that_of_the_run() {
    let folder = folder();
    let record: Value = serde_json::from_str(
        &folder.ok("solve mine.json --set mu=0.4 --set omega_rpm=7 --json --history history.csv"),
    )
    .unwrap();
    let history = History::read(&folder, "history.csv");
    let time = history.column("time_s");
    assert_eq!(time.len() as u64, record["steps"].as_u64().unwrap());
    assert!(time.windows(2).all(|pair| pair[0] < pair[1]));
    let states =
        [history.column("stick_nodes"), history.column("slip_nodes"), history.column("separated_nodes")];
    assert!((0..time.len()).all(|i| states.iter().map(|state| state[i]).sum::<f64>() == 20.0));

    let load = history.column("load_n");
    assert_eq!(*load.last().unwrap(), 30.0);
    // The window of the record holds whole cycles.
    let start = time.partition_point(|&time| time < record["window_start_s"].as_f64().unwrap());
    assert!(start > 0 && start < time.len() - 500, "{start}");
    let normal = mean(&history.column("normal_n")[start..]);
    assert!((normal / 30.0 - 1.0).abs() < 0.01, "mean normal force {normal} N");
    let mu_star = mean(&history.column("clamp_tangential_n")[start..]) / 30.0;
    assert!((mu_star - record["mu_star"].as_f64().unwrap()).abs() < 0.005, "{mu_star}");
    for state in history.0.iter().map(|row| row["front_centre_state"].as_str()) {
        assert!(["stick", "slip", "separated"].contains(&state), "{state}");
    }
}

/// Protects: `--every` keeps some lines of the history and does not change them.
#[test]
fn every_keeps_each_nth_step() {
    let folder = folder();
    let settings = "solve mine.json --set mu=0.2 --set omega_rpm=7 --set limit_s=0.002 --history";
    folder.ok(&format!("{settings} all.csv"));
    folder.ok(&format!("{settings} some.csv --every 10"));
    let (all, some) = (folder.read("all.csv"), folder.read("some.csv"));
    let expected: Vec<_> = all.lines().take(1).chain(all.lines().skip(1).step_by(10)).collect();
    assert_eq!(some.lines().collect::<Vec<_>>(), expected);
    // `--every` needs a history.
    folder.command("solve mine.json --set mu=0.2 --set omega_rpm=7 --every 10").assert().code(2);
}

/// Protects: a job alone has the same figures as in a sweep, to the last bit, and needs no database.
#[test]
fn a_single_job_is_that_of_the_sweep() {
    let folder = folder();
    let solved = folder.ok("solve mine.json --set mu=0.4 --set omega_rpm=7 --json");
    assert_eq!(folder.files(), ["mine.json"]);
    let record: Value = serde_json::from_str(&solved).unwrap();
    folder.ok("run mine.json");
    let export = rows(&folder.ok("export mine"));
    let row = export.iter().find(|row| row["mu"] == "0.4" && row["omega_rpm"] == "7").unwrap();
    for name in ["mu_star", "mu_star_se", "frequency_hz", "separated_share", "simulated_s", "energy_residual"]
    {
        assert_eq!(record[name].as_f64().unwrap(), row[name].parse::<f64>().unwrap(), "{name}");
    }
    assert_eq!(record["regime"], row["regime"].as_str());
    assert_eq!(record["status"], row["status"].as_str());
}

/// Protects: the text has the figures of the record, and settings reach the solver: with less damping the job does not come to rest in its time.
#[test]
fn the_text_agrees_with_the_record() {
    let folder = folder();
    let settings = "--set mu=0.2 --set omega_rpm=7 --set load_n=10 --set beta_r_s=5e-8";
    let record: Value =
        serde_json::from_str(&folder.ok(&format!("solve mine.json {settings} --json"))).unwrap();
    let text = folder.ok(&format!("solve mine.json {settings}"));
    let line = |name: &str| {
        let found = text.lines().find(|line| line.split_whitespace().next() == Some(name));
        found.map(|line| line.split_whitespace().nth(1).unwrap().to_owned())
    };
    assert_eq!(line("regime").as_deref(), Some("stable"), "{text}");
    assert_eq!(line("frequency_hz"), None, "{text}");
    let mu_star: f64 = line("mu_star").unwrap().parse().unwrap();
    assert!((mu_star / record["mu_star"].as_f64().unwrap() - 1.0).abs() < 1e-5, "{text}");
    // What `show` prints of the same job in a database is the same, but for the study and the provenance.
    folder.ok(&format!("run mine.json {settings} --name one"));
    let key = text.lines().next().unwrap().split_whitespace().nth(1).unwrap();
    let shown = folder.ok(&format!("show {key}"));
    let own = |text: &str| {
        let lines = text.lines().take_while(|line| *line != "Provenance");
        lines
            .filter(|line| !line.starts_with("study"))
            .map(|line| line.trim_end().to_owned())
            .collect::<Vec<_>>()
    };
    let [solved, shown] = [text.as_str(), &shown].map(own);
    assert_eq!(solved.join("\n").trim_end(), shown.join("\n").trim_end());
    // The stress is proportional to the load.
    let full: Value =
        serde_json::from_str(&folder.ok("solve mine.json --set mu=0.2 --set omega_rpm=7 --json")).unwrap();
    let ratio = full["sigma_n_max_pa"].as_f64().unwrap() / record["sigma_n_max_pa"].as_f64().unwrap();
    assert!((ratio - 3.0).abs() < 0.3, "{ratio}");
}

/// Protects: a device or a symbolic link that is given as the output file is written to and not replaced.
#[cfg(unix)]
#[test]
fn a_device_is_written_to_and_not_replaced() {
    let folder = folder();
    folder.write("target.csv", "old");
    for (link, target) in [("null", "/dev/null"), ("link.csv", "target.csv")] {
        std::os::unix::fs::symlink(target, folder.path(link)).unwrap();
        let settings = "--set mu=0.2 --set omega_rpm=7 --set limit_s=0.001";
        folder.ok(&format!("solve mine.json {settings} --history {link}"));
        assert!(folder.path(link).symlink_metadata().unwrap().is_symlink(), "{link}");
    }
    assert!(folder.read("target.csv").starts_with(HISTORY));
    assert_eq!(folder.files(), ["link.csv", "mine.json", "null", "target.csv"]);
}

/// Protects: the error for a history that cannot be written names the file, and no file remains.
#[test]
fn an_unwritable_history_is_named() {
    let folder = folder();
    let settings = "--set mu=0.2 --set omega_rpm=7 --set limit_s=0.001";
    let missing =
        folder.command(&format!("solve mine.json {settings} --history no/such.csv")).assert().code(2);
    assert!(stderr(&missing).starts_with("error: no/such.csv: "), "{}", stderr(&missing));
    assert_eq!(folder.files(), ["mine.json"]);
}

/// Protects: Ctrl-C ends a long job with the code for jobs that are left, and its history so far is written: it is the
/// beginning of the history of a whole run.
#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_job_keeps_its_history() {
    let folder = folder();
    let settings = "--set mu=0.2 --set omega_rpm=7 --set stop_early=false --every 50";
    let solving = folder.start(&format!("solve mine.json {settings} --set limit_s=50 --history history.csv"));
    wait("the signal handler", || handles_interrupts(&solving));
    solving.signal("INT");
    let (code, out, err) = solving.end();
    assert_eq!((code, out.as_str()), (Some(3), ""), "{err}");
    assert!(err.contains("interrupted"), "{err}");
    assert!(!History::read(&folder, "history.csv").0.is_empty());
    folder.ok(&format!("solve mine.json {settings} --set limit_s=0.01 --history whole.csv"));
    let (interrupted, whole) = (folder.read("history.csv"), folder.read("whole.csv"));
    for (number, (found, expected)) in interrupted.lines().zip(whole.lines()).enumerate() {
        assert_eq!(found, expected, "line {number}");
    }
}

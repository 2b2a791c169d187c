//! A folder with study files in which the command is run.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::Command;
use serde_json::{Value, json};
use tempfile::TempDir;

/// The command under test.
pub const TRIBOSWEEP: &str = env!("CARGO_BIN_EXE_tribosweep");

/// The header of the export, which other programs rely on.
pub const HEADER: &str = "study,job,omega_rpm,mu,status,regime,mu_star,mu_star_se,mu_star_mesh_error,\
mu_star_contact,frequency_hz,frequency_mesh_error_hz,stick_share,slip_share,separated_share,n_over_f_min,n_over_f_max,sigma_n_max_pa,slip_speed_max_m_s,cycles,\
simulated_s,steps,time_step_s,energy_residual,identity_residual,wall_s,error";

/// A process that takes longer hangs.
const TIMEOUT: Duration = Duration::from_mins(2);

pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    /// A folder with `NAME.json` in it.
    pub fn with(name: &str, study: &Value) -> Self {
        let folder = Self::new();
        folder.add(name, study);
        folder
    }

    pub fn add(&self, name: &str, study: &Value) {
        self.write(&format!("{name}.json"), &study.to_string());
    }

    pub fn write(&self, file: &str, text: &str) {
        std::fs::write(self.path(file), text).unwrap();
    }

    pub fn path(&self, file: impl AsRef<Path>) -> PathBuf {
        self.0.path().join(file)
    }

    pub fn read(&self, file: impl AsRef<Path>) -> String {
        let path = self.path(file);
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// The command in this folder, with arguments separated by spaces.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(TRIBOSWEEP);
        command.current_dir(&self.0).env_remove("TRIBOSWEEP_DB");
        command.args(arguments.split_whitespace());
        command.timeout(TIMEOUT);
        command
    }

    /// The standard output of the command, which must succeed.
    pub fn ok(&self, arguments: &str) -> String {
        stdout(&self.command(arguments).assert().code(0))
    }

    /// Starts the command without waiting for its end.
    pub fn start(&self, arguments: &str) -> Running {
        self.start_with(arguments, Stdio::piped())
    }

    /// As [`start`](Self::start), with the messages in a file, so that they can be read while the command runs.
    pub fn start_with_messages_in(&self, file: &str, arguments: &str) -> Running {
        self.start_with(arguments, std::fs::File::create(self.path(file)).unwrap().into())
    }

    fn start_with(&self, arguments: &str, messages: Stdio) -> Running {
        let child = std::process::Command::new(TRIBOSWEEP)
            .current_dir(&self.0)
            .env_remove("TRIBOSWEEP_DB")
            .args(arguments.split_whitespace())
            .stdout(Stdio::piped())
            .stderr(messages)
            .spawn();
        Running(Some(child.unwrap()))
    }

    /// The number of jobs in each state, from `status --json`.
    pub fn counts(&self, study: &str) -> BTreeMap<String, u64> {
        let status: Value = serde_json::from_str(&self.ok(&format!("status {study} --json"))).unwrap();
        serde_json::from_value(status["jobs"].clone()).unwrap()
    }

    /// Waits until the number of jobs in each state fulfils a condition.
    pub fn wait_for(&self, study: &str, is_fulfilled: impl Fn(&BTreeMap<String, u64>) -> bool) {
        wait("the jobs of the study", || {
            // The database or the study may not exist yet.
            let mut command = self.command(&format!("status {study} --json"));
            let Ok(output) = command.ok() else { return false };
            let status: Value = serde_json::from_slice(&output.stdout).unwrap();
            is_fulfilled(&serde_json::from_value(status["jobs"].clone()).unwrap())
        });
    }

    /// Every file below the folder, by its path from there.
    pub fn files(&self) -> Vec<String> {
        crate::walk::below(self.0.path())
    }
}

/// A command that runs in the background. It is killed when this is dropped.
pub struct Running(Option<Child>);

impl Running {
    pub fn id(&self) -> u32 {
        self.0.as_ref().unwrap().id()
    }

    /// Sends a signal, by its name without SIG.
    pub fn signal(&self, name: &str) {
        let mut kill = std::process::Command::new("kill");
        assert!(kill.args([format!("-{name}"), self.id().to_string()]).status().unwrap().success());
    }

    /// Waits for the end and returns exit code (`None` after a signal), standard output and standard error.
    pub fn end(mut self) -> (Option<i32>, String, String) {
        let output = self.0.take().unwrap().wait_with_output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        (output.status.code(), text(output.stdout), text(output.stderr))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(child) = &mut self.0 {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Whether SIGINT is one of the signals that the process catches.
#[cfg(target_os = "linux")]
pub fn handles_interrupts(process: &Running) -> bool {
    let status = std::fs::read_to_string(format!("/proc/{}/status", process.id())).unwrap();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
    u64::from_str_radix(caught.trim(), 16).unwrap() & 0b10 != 0
}

/// Waits until a condition holds. A condition that runs a command is looked at less often, so that the command does not take the
/// time of what is waited for.
pub fn wait(for_what: &str, mut is_fulfilled: impl FnMut() -> bool) {
    let start = Instant::now();
    loop {
        let look = Instant::now();
        if is_fulfilled() {
            return;
        }
        assert!(start.elapsed() < TIMEOUT, "waited too long for {for_what}");
        std::thread::sleep((3 * look.elapsed()).clamp(Duration::from_millis(5), Duration::from_millis(100)));
    }
}

pub fn stdout(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

pub fn stderr(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

/// A study on a mesh of 36 elements: a job takes some 10 ms.
pub fn small(grid: &Value) -> Value {
    json!({
        "scene": { "pin": { "elements": [3, 4, 3] }, "clamp": { "width_m": 0.004 } },
        "run": { "limit_s": 0.012 },
        "grid": grid,
    })
}

/// Jobs at 7 rpm, and jobs at a speed that single precision cannot hold: these diverge.
pub fn diverging(mu: &[f64]) -> Value {
    let mut study = small(&json!({ "omega_rpm": [7, 1e20], "mu": mu }));
    study["scene"]["disk"] = json!({ "track_radius_m": 1e19 });
    study["numerics"] = json!({ "precision": "single" });
    study
}

/// Jobs that all take a tenth of a second or more, so that they can be interrupted. There are more than two threads advance
/// together, so that some are left when the first ones are done.
pub fn long() -> Value {
    let mut study = small(&json!({ "mu": [0.2, 0.3, 0.4, 0.5], "omega_rpm": [2, 3, 5, 7, 10, 20] }));
    study["run"] = json!({ "limit_s": 0.12, "stop_early": false });
    study
}

/// The number of jobs of [`long`].
pub const LONG_JOBS: u64 = 24;

/// One row of an export, by column.
pub type ExportRow = BTreeMap<String, String>;

pub fn rows(export: &str) -> Vec<ExportRow> {
    csv::Reader::from_reader(export.as_bytes()).deserialize().collect::<Result<_, _>>().unwrap()
}

/// The wall time of every job that has ended.
pub fn wall_times(export: &str) -> BTreeMap<String, String> {
    let ended = rows(export).into_iter().filter(|row| !row["wall_s"].is_empty());
    ended.map(|row| (row["job"].clone(), row["wall_s"].clone())).collect()
}

/// The export without the values of `wall_s`; all other bytes are unchanged.
pub fn without_wall_times(export: &str) -> String {
    let column = HEADER.split(',').position(|name| name == "wall_s").unwrap();
    assert!(!export.contains('"'), "a quoted cell may hold a comma: {export}");
    let blank = |line: &str| {
        let mut cells: Vec<_> = line.split(',').collect();
        cells[column] = "";
        cells.join(",")
    };
    export.split('\n').map(|line| if line.is_empty() { String::new() } else { blank(line) + "\n" }).collect()
}

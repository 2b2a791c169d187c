//! The scripts for a Slurm cluster, as far as they can be tested without one; `scripts/slurm.py` runs them on a cluster.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::{Value, json};

use crate::cli::support::{Folder, TRIBOSWEEP, small, stderr, stdout, wait};

const SCRIPTS: [&str; 3] = ["workers.sbatch", "report.sbatch", "submit.sh"];
const URL: &str = "postgres://me@host:5432/sweeps";
/// Characters that a shell could interpret.
const ODD: &str = "a 'b' \"c\" $d `e` \\f;g & h*";

fn six_jobs() -> Value {
    small(&json!({ "mu": [0.2, 0.4], "omega_rpm": [2, 7, 20] }))
}

fn executable(path: &Path, text: &str) {
    std::fs::write(path, text).unwrap();
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).unwrap();
}

/// Asserts that bash can parse every script.
fn assert_valid_scripts(folder: &Path) {
    for script in SCRIPTS {
        let output = Command::new("bash").arg("-n").arg(folder.join(script)).output().unwrap();
        assert!(output.status.success(), "{script}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

/// The values of a script's settings in the shell.
fn settings(script: &Path) -> BTreeMap<String, String> {
    let text = std::fs::read_to_string(script).unwrap();
    let lines = text.lines().skip_while(|line| line.starts_with('#') || line.is_empty());
    let head: Vec<_> = lines.take_while(|line| !line.is_empty()).collect();
    let names: Vec<_> = head.iter().filter_map(|line| line.split_once('=')).map(|(name, _)| name).collect();
    let show: Vec<_> = names.iter().map(|name| format!("printf '%s\\0' \"${name}\"\n")).collect();
    let shell = Command::new("bash").arg("-c").arg(head.join("\n") + "\n" + &show.concat()).output().unwrap();
    assert!(shell.status.success(), "{}", String::from_utf8_lossy(&shell.stderr));
    let values = String::from_utf8(shell.stdout).unwrap();
    names.into_iter().map(str::to_owned).zip(values.split('\0').map(str::to_owned)).collect()
}

/// A folder with fake programs that come first in PATH: each logs its arguments, one line per call, and runs its script.
struct Cluster {
    folder: Folder,
}

impl Cluster {
    fn new(programs: &[(&str, &str)]) -> Self {
        let folder = Folder::with("mine", &six_jobs());
        std::fs::create_dir(folder.path("bin")).unwrap();
        for (name, script) in programs {
            let calls = folder.path("calls");
            let text = format!("#!/bin/bash\necho {name} \"$@\" >> {}\n{script}\n", calls.display());
            executable(&folder.path("bin").join(name), &text);
        }
        Self { folder }
    }

    fn command(&self, arguments: &str) -> assert_cmd::Command {
        let mut command = self.folder.command(arguments);
        let path = std::env::var("PATH").unwrap();
        command.env("PATH", format!("{}:{path}", self.folder.path("bin").display()));
        command
    }

    fn calls(&self) -> String {
        std::fs::read_to_string(self.folder.path("calls")).unwrap_or_default()
    }
}

const NUMBERS: &str = "case $* in *report*) echo '12;cluster';; *) echo 11;; esac";

/// Protects: the array has the requested settings, in both modes.
#[test]
fn an_array_of_workers() {
    for (db, has_shards) in [(URL, false), ("some.db", true)] {
        let folder = Folder::with("mine", &six_jobs());
        let options = "--workers 6 --cpus-per-worker 4 --partition a,b --time 1-12 --account x --mem 2G";
        let printed = folder.ok(&format!("slurm mine.json {options} --db {db}"));
        assert_eq!(printed, "mine.slurm/submit.sh\n");
        assert_valid_scripts(&folder.path("mine.slurm"));
        let workers = folder.read("mine.slurm/workers.sbatch");
        for line in [
            "--array=0-5",
            "--cpus-per-task=4",
            "--ntasks=1",
            "--partition=a,b",
            "--time=1-12",
            "--account=x",
            "--mem=2G",
            "--requeue",
            "--open-mode=append",
            "--output=%A_%a.log",
            "--signal=B:USR1@120",
        ] {
            assert!(workers.contains(&format!("\n#SBATCH {line}\n")), "{line}: {workers}");
        }
        assert_eq!(workers.contains("/shards/"), has_shards, "{workers}");
        assert_eq!(folder.path("mine.slurm/shards").is_dir(), has_shards);
        let report = folder.read("mine.slurm/report.sbatch");
        assert!(!report.contains("--array") && report.contains("\n#SBATCH --partition=a,b\n"), "{report}");
        let values = settings(&folder.path("mine.slurm/workers.sbatch"));
        assert_eq!((values["name"].as_str(), values["workers"].as_str()), ("mine", "6"));
        assert_eq!(values["tribosweep"], TRIBOSWEEP);
        assert_eq!(values.get("db").map(String::as_str), (!has_shards).then_some(URL));
        assert_eq!(values.get("merged").map(String::as_str), has_shards.then_some("some.db"));
    }
}

/// Protects: the scripts have no settings for options that are not given, so that Slurm's defaults apply.
#[test]
fn options_that_are_not_given_are_left_to_slurm() {
    let folder = Folder::with("mine", &six_jobs());
    folder.ok("slurm mine.json --workers 1");
    let workers = folder.read("mine.slurm/workers.sbatch");
    for option in ["partition", "time", "account", "mem"] {
        assert!(!workers.contains(&format!("#SBATCH --{option}=")), "{workers}");
    }
}

/// Protects: `--replace` reaches every submission of the scripts, and none has it without the option.
#[test]
fn a_replacement_is_passed_on() {
    for (option, expected) in [("", ""), ("--replace", "--replace")] {
        let folder = Folder::with("mine", &six_jobs());
        folder.ok(&format!("slurm mine.json --workers 1 {option}"));
        for script in SCRIPTS {
            let file = folder.path("mine.slurm").join(script);
            assert_eq!(settings(&file)["replace"], expected, "{script}");
            let text = std::fs::read_to_string(file).unwrap();
            let (submissions, passing) =
                (text.matches("\" submit --db").count(), text.matches("${replace:+\"$replace\"} --").count());
            assert_eq!((submissions, passing), (1, 1), "{script}: {text}");
        }
    }
}

/// Protects: paths with characters that a shell interprets are kept, and relative paths are made absolute.
#[test]
fn paths_are_quoted() {
    for db in [URL, "o'd d.db"] {
        let folder = Folder::new();
        let odd = folder.path(ODD);
        std::fs::create_dir(&odd).unwrap();
        std::fs::write(odd.join("mine.json"), six_jobs().to_string()).unwrap();
        let mut command = folder.command("slurm mine.json --workers 2 --out");
        command.current_dir(&odd).arg("it's \"here\"").args(["--db", db]).assert().code(0);
        let out = odd.join("it's \"here\"");
        assert_valid_scripts(&out);
        for script in SCRIPTS {
            let values = settings(&out.join(script));
            assert_eq!(values["study"], odd.join("mine.json").to_str().unwrap());
            assert_eq!(values["folder"], out.to_str().unwrap());
        }
        let values = settings(&out.join("report.sbatch"));
        assert_eq!(values.get("db").or(values.get("merged")).unwrap(), db);
    }
}

/// Protects: a password is neither written into files that others may read nor shown.
#[test]
fn a_password_is_refused() {
    let folder = Folder::with("mine", &six_jobs());
    for url in ["postgres://me:secret@host/db", "postgresql://host/db?password=secret"] {
        let message =
            stderr(&folder.command(&format!("slurm mine.json --workers 2 --db {url}")).assert().code(2));
        assert!(message.contains("~/.pgpass") && message.contains("PGPASSWORD"), "{message}");
        assert!(!message.contains("secret"), "{message}");
    }
    assert_eq!(folder.files(), ["mine.json"]);
}

/// Protects: options that Slurm would refuse or that make no sense are refused with advice before anything is written.
#[test]
fn bad_options() {
    let folder = Folder::with("mine", &six_jobs());
    folder.write("bad.json", "{ \"grid\": { \"nu\": [0.3] } }");
    for (arguments, expected) in [
        ("mine.json --workers 0", "1..="),
        ("mine.json --workers 7", "at most --workers 6"),
        ("mine.json --workers 2 --time abc", "hours:minutes:seconds"),
        ("mine.json --workers 2 --time 2", "at least 5 minutes"),
        ("mine.json --workers 2 --mem lots", "such as 500M or 2G"),
        ("mine.json --workers 2 --partition a;b", "expected a name"),
        ("mine.json --workers 2 --cpus-per-worker 0", "1..="),
        ("mine.json --workers 2 --db ..", "expected the name of a file"),
        ("mine.json", "--workers"),
        ("bad.json --workers 2", "grid.nu"),
    ] {
        let message = stderr(&folder.command(&format!("slurm {arguments}")).assert().code(2));
        assert!(message.contains(expected), "{arguments}: {message}");
    }
    assert_eq!(folder.files(), ["bad.json", "mine.json"]);
}

/// Protects: writing again replaces the scripts and keeps logs, shards and results.
#[test]
fn an_existing_folder() {
    let folder = Folder::with("mine", &six_jobs());
    folder.ok("slurm mine.json --workers 2");
    let kept = ["mine.slurm/1_0.log", "mine.slurm/shards/shard-0.db", "mine.slurm/jobs.csv"];
    for file in kept {
        folder.write(file, "kept");
    }
    folder.write("mine.slurm/workers.sbatch", "old");
    folder.ok("slurm mine.json --workers 3");
    assert!(folder.read("mine.slurm/workers.sbatch").contains("--array=0-2"));
    assert!(kept.iter().all(|file| folder.read(file) == "kept"));
}

/// Protects: with shards the study is checked and both scripts are submitted from their own folder, the report with a
/// dependency on the array.
#[test]
fn array_and_report_are_submitted() {
    let cluster =
        Cluster::new(&[("sbatch", &format!("pwd >> where\n{NUMBERS}")), ("squeue", ""), ("scancel", "")]);
    let end = cluster.command("slurm mine.json --workers 2 --submit").assert().code(0);
    assert_eq!(
        cluster.calls(),
        "sbatch --parsable workers.sbatch\nsbatch --parsable --dependency=afterany:11 report.sbatch\n"
    );
    assert!(stdout(&end).contains("array 11 with 2 tasks") && stdout(&end).contains("squeue --jobs=11,12"));
    assert_eq!(cluster.folder.read("mine.slurm/jobs"), "11 12\n");
    let out = cluster.folder.path("mine.slurm").canonicalize().unwrap();
    assert_eq!(cluster.folder.read("mine.slurm/where"), format!("{0}\n{0}\n", out.display()));
}

/// Protects: no second array is submitted while one is working on the shards.
#[test]
fn one_array_at_a_time() {
    let cluster = Cluster::new(&[("sbatch", NUMBERS), ("squeue", "echo still there"), ("scancel", "")]);
    cluster.command("slurm mine.json --workers 2 --submit").assert().code(0);
    let message = stderr(&cluster.command("slurm mine.json --workers 2 --submit").assert().code(2));
    assert!(message.contains("array 11 of this folder has not ended"), "{message}");
    assert_eq!(cluster.calls().matches("sbatch").count(), 2 * 2, "{}", cluster.calls());
}

/// Protects: if Slurm is missing or refuses, the message says so and no job is left in Slurm's queue.
#[test]
fn all_or_nothing_is_submitted() {
    let refusal = |cluster: &Cluster| {
        let end = cluster.command("slurm mine.json --workers 2 --submit").assert().code(2);
        assert!(!cluster.folder.path("mine.slurm/jobs").exists());
        stderr(&end)
    };
    let script = "echo 'sbatch: error: no such partition' >&2; exit 1";
    let refuses = Cluster::new(&[("sbatch", script), ("squeue", ""), ("scancel", "")]);
    let text = refusal(&refuses);
    assert!(text.contains("no such partition") && text.contains("nothing is submitted"), "{text}");

    let second =
        format!("case $* in *report*) {script};; *) echo 11;; esac").replace("; exit 1;;", "; exit 1 ;;");
    let half = Cluster::new(&[("sbatch", &second), ("squeue", ""), ("scancel", "")]);
    let text = refusal(&half);
    assert!(text.contains("array 11 was cancelled"), "{text}");
    assert!(half.calls().ends_with("scancel 11\n"), "{}", half.calls());

    let none = Folder::with("mine", &six_jobs());
    // A PATH with bash and without Slurm.
    std::fs::create_dir(none.path("bin")).unwrap();
    for program in ["bash", "env"] {
        let found =
            Command::new("sh").args(["-c", &format!("command -v {program}")]).output().unwrap().stdout;
        let found = String::from_utf8(found).unwrap();
        std::os::unix::fs::symlink(found.trim(), none.path("bin").join(program)).unwrap();
    }
    let mut command = none.command("slurm mine.json --workers 2 --submit");
    let text = stderr(&command.env("PATH", none.path("bin")).assert().code(2));
    assert!(text.contains("sbatch is not there"), "{text}");
}

/// A task of the array with a fake program, which logs its arguments, keeps a "database", makes a file when it can be asked
/// to stop, and works until another file is removed.
struct Task {
    cluster: Cluster,
}

/// The fake program. Its database has a line for each run of `work`.
const FAKE_PROGRAM: &str = r#"
command=$1
db=$(while [ $# -gt 0 ]; do if [ "$1" = --db ]; then echo "$2"; fi; shift; done)
case $command in
    submit) touch "$db" "$db.lock"; if [ -e "$db-wal" ]; then cat "$db-wal" >> "$db"; rm "$db-wal"; fi ;;
    work)
        echo worked >> "$db"
        trap 'exit 3' TERM
        touch "$TMPDIR/../ready"
        [ ! -e "$TMPDIR/die" ] || { rm "$TMPDIR/die"; echo unclosed > "$db-wal"; kill -KILL $$; }
        while [ -e "$TMPDIR/busy" ]; do sleep 0.05; done ;;
esac
"#;

impl Task {
    fn new() -> Self {
        let cluster = Cluster::new(&[("scontrol", ""), ("fake-program", FAKE_PROGRAM)]);
        cluster.folder.ok("slurm mine.json --workers 2");
        let script = cluster.folder.read("mine.slurm/workers.sbatch");
        let line = script.lines().find(|line| line.starts_with("tribosweep=")).unwrap();
        let fake_program = format!("tribosweep={}", cluster.folder.path("bin/fake-program").display());
        cluster.folder.write("mine.slurm/workers.sbatch", &script.replace(line, &fake_program));
        std::fs::create_dir(cluster.folder.path("node")).unwrap();
        Self { cluster }
    }

    fn start(&self) -> std::process::Child {
        let folder = &self.cluster.folder;
        let path = format!("{}:{}", folder.path("bin").display(), std::env::var("PATH").unwrap());
        let mut command = Command::new("bash");
        command
            .arg(folder.path("mine.slurm/workers.sbatch"))
            .env("PATH", path)
            .env("TMPDIR", folder.path("node"));
        for (name, value) in
            [("ARRAY_TASK_ID", "1"), ("ARRAY_JOB_ID", "11"), ("JOB_ID", "11"), ("CPUS_PER_TASK", "3")]
        {
            command.env(format!("SLURM_{name}"), value);
        }
        command.env_remove("SLURM_TMPDIR").stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    }

    /// Runs the task to its end, or sends it a signal when its worker runs.
    fn run(&self, signal: Option<&str>) -> Option<i32> {
        let ready = self.cluster.folder.path("ready");
        let _ = std::fs::remove_file(&ready);
        if signal.is_some() {
            self.cluster.folder.write("node/busy", "");
        }
        let mut task = self.start();
        if let Some(signal) = signal {
            wait("the worker", || ready.exists());
            let kill = Command::new("kill").args([format!("-{signal}"), task.id().to_string()]).status();
            assert!(kill.unwrap().success());
        }
        let code = task.wait().unwrap().code();
        let _ = std::fs::remove_file(self.cluster.folder.path("node/busy"));
        code
    }

    fn kept(&self) -> String {
        self.cluster.folder.read("mine.slurm/shards/shard-1.db")
    }

    fn left_on_the_node(&self) -> Vec<String> {
        self.cluster.folder.files().into_iter().filter(|file| file.starts_with("node/")).collect()
    }
}

/// Protects: a task plans its shard on the node, works on it, copies it to the shared folder and leaves no file on the node.
/// The next run continues from the copy.
#[test]
fn the_next_task_continues_from_the_copy() {
    let task = Task::new();
    assert_eq!(task.run(None), Some(0));
    assert_eq!(task.kept(), "worked\n");
    let calls = task.cluster.calls();
    assert!(calls.contains("--shard 2/2 -- ") && calls.contains("--threads 3"), "{calls}");
    assert_eq!(task.run(None), Some(0));
    assert_eq!(task.kept(), "worked\nworked\n");
    assert!(task.left_on_the_node().is_empty(), "{:?}", task.left_on_the_node());
    assert!(!task.cluster.folder.files().iter().any(|file| file.contains(".partial")));
    assert!(!task.cluster.calls().contains("scontrol"));
}

/// Protects: a task that is stopped waits for its worker and copies the shard. At the time limit it requeues itself, not the
/// whole array; after SIGTERM it does not requeue.
#[test]
fn a_task_that_is_stopped() {
    let task = Task::new();
    assert_eq!(task.run(Some("TERM")), Some(3));
    assert_eq!(task.kept(), "worked\n");
    assert!(!task.cluster.calls().contains("scontrol"), "{}", task.cluster.calls());
    assert_eq!(task.run(Some("USR1")), Some(3));
    assert_eq!(task.kept(), "worked\nworked\n");
    assert!(task.cluster.calls().ends_with("scontrol requeue 11_1\n"), "{}", task.cluster.calls());
    assert!(task.left_on_the_node().is_empty(), "{:?}", task.left_on_the_node());
}

/// Protects: a worker that is killed is started again, and the copy has the content of its write-ahead log.
#[test]
fn a_worker_that_is_killed() {
    let task = Task::new();
    task.cluster.folder.write("node/die", "");
    assert_eq!(task.run(None), Some(0));
    assert_eq!(task.kept(), "worked\nworked\nunclosed\n");
}

/// Protects: a task continues from the database that a killed task left on the node or from the copy, whichever is newer.
#[test]
fn a_task_continues_from_the_newer_database() {
    let task = Task::new();
    let folder = &task.cluster.folder;
    task.run(None);
    let db = task.cluster.calls().split("--db ").nth(1).unwrap().split(' ').next().unwrap().to_owned();
    let touch = |path: &Path, when: &str| {
        assert!(Command::new("touch").args(["-d", when]).arg(path).status().unwrap().success());
    };
    let kept = folder.path("mine.slurm/shards/shard-1.db");
    for (local_time, kept_time, expected) in [
        ("2026-01-02", "2026-01-01", "local\nworked\n"),
        ("2026-01-01", "2026-01-02", "kept\nworked\n"),
        ("2026-01-01", "2026-01-01", "local\nworked\n"),
    ] {
        std::fs::write(&db, "local\n").unwrap();
        std::fs::write(&kept, "kept\n").unwrap();
        touch(Path::new(&db), local_time);
        touch(&kept, kept_time);
        assert_eq!(task.run(None), Some(0));
        assert_eq!(task.kept(), expected);
    }
}

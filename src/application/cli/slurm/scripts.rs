//! The scripts of a job array, from templates and settings.

use super::args::Args;
use super::settings::Database;
use crate::cli::error::CliError;
use crate::cli::output::write_file;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The script that plans the study and submits the others.
pub(crate) const SUBMIT: &str = "submit.sh";
const WORKERS: &str = "workers.sbatch";
const REPORT: &str = "report.sbatch";

const BASH: &str = "#!/bin/bash\n";

/// How long before its time limit a task gets a signal, in seconds: it needs the time to store the states of its jobs and
/// to copy a shard.
const NOTICE_S: u32 = 120;
/// How long a worker on a shared database waits for jobs.
const IDLE_EXIT: &str = "60s";
/// The interval in seconds at which a shard is copied to the shared folder. A node that dies loses the work of at most one
/// interval.
const KEEP_EVERY_S: &str = "1800";
/// How often a task starts its worker again after it was killed: more often than a job needs to fail (`--max-crashes`).
const STARTS: &str = "10";

/// The scripts of one study and their folder.
pub(crate) struct Scripts {
    folder: PathBuf,
    has_shards: bool,
    texts: [(&'static str, String); 3],
}

impl Scripts {
    /// Creates the texts of the scripts; nothing is written.
    pub(crate) fn new(
        args: &Args,
        study: &Path,
        name: &str,
        database: &Database,
        folder: &Path,
    ) -> Result<Self, CliError> {
        let folder = std::path::absolute(folder).map_err(|source| CliError::file(folder, source))?;
        let study = std::path::absolute(study).map_err(|source| CliError::file(study, source))?;
        let program = program();
        let workers = args.workers.to_string();
        let common = [
            ("tribosweep", utf8(&program)?),
            ("study", utf8(&study)?),
            ("name", name),
            ("folder", utf8(&folder)?),
            ("workers", &workers),
        ];
        let mode = Mode::of(database);
        let replace = ("replace", if args.replacement.is_wanted { "--replace" } else { "" });
        let script = |head: String, what: &str, own: &[(&str, &str)], body: &[&str]| {
            let settings = settings(common.iter().chain(own))?;
            let about = format!("# {what} of the study {name}; written by `tribosweep slurm`.\n");
            Ok::<_, CliError>(format!("{head}{about}\n{settings}{}", body.concat()))
        };
        let array = sbatch(args, name, Some(args.workers));
        let own = [mode.database, mode.waiting, ("starts", STARTS), replace];
        let texts = [
            (WORKERS, script(array, "A worker", &own, &[include_str!("stop.sh"), mode.work])?),
            (
                REPORT,
                script(
                    sbatch(args, name, None),
                    "The report",
                    &[mode.database, replace],
                    &[include_str!("report.sh"), mode.report],
                )?,
            ),
            (
                SUBMIT,
                script(
                    BASH.to_owned(),
                    "Submits the workers and the report",
                    &[("db", mode.url), replace],
                    &[include_str!("submit.sh")],
                )?,
            ),
        ];
        Ok(Self { folder, has_shards: mode.url.is_empty(), texts })
    }

    /// Writes the scripts. Other files in the folder stay as they are.
    pub(crate) fn write(&self) -> Result<(), CliError> {
        create(&self.folder)?;
        if self.has_shards {
            create(&self.folder.join("shards"))?;
        }
        for (name, text) in &self.texts {
            write_file(&self.folder.join(name), text.as_bytes())?;
        }
        make_executable(&self.submit())
    }

    /// The script that submits the others.
    pub(crate) fn submit(&self) -> PathBuf {
        self.folder.join(SUBMIT)
    }
}

/// The difference between workers that share a database and workers with shards.
struct Mode<'a> {
    /// The URL of the shared database; empty with shards.
    url: &'a str,
    database: (&'static str, &'a str),
    waiting: (&'static str, &'static str),
    work: &'static str,
    report: &'static str,
}

impl<'a> Mode<'a> {
    fn of(database: &'a Database) -> Self {
        match database {
            Database::Shared(url) => Self {
                url,
                database: ("db", url),
                waiting: ("idle_exit", IDLE_EXIT),
                work: include_str!("workers_shared.sh"),
                report: include_str!("report_shared.sh"),
            },
            Database::Shards(merged) => Self {
                url: "",
                database: ("merged", merged),
                waiting: ("keep_every", KEEP_EVERY_S),
                work: include_str!("workers_shards.sh"),
                report: include_str!("report_shards.sh"),
            },
        }
    }
}

/// The head of a script for `sbatch`: Slurm reads these lines up to the first command. Paths are relative to the folder of
/// `submit.sh`, so that no path has to be quoted by Slurm's rules, which give % and \ a meaning.
fn sbatch(args: &Args, name: &str, workers: Option<u32>) -> String {
    let mut head = BASH.to_owned();
    let mut line = |option: &str, value: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(head, "#SBATCH --{option}={value}");
    };
    if let Some(workers) = workers {
        line("job-name", name);
        line("array", &format!("0-{}", workers - 1));
        line("cpus-per-task", &args.cpus.to_string());
        line("output", "%A_%a.log");
        line("signal", &format!("B:USR1@{NOTICE_S}"));
    } else {
        line("job-name", &format!("{name}-report"));
        line("cpus-per-task", "1");
        line("output", "report-%j.log");
    }
    line("ntasks", "1");
    line("open-mode", "append");
    let given = [
        ("partition", &args.partition),
        ("time", &args.time),
        ("account", &args.account),
        ("mem", &args.mem),
    ];
    for (option, value) in given {
        if let Some(value) = value {
            line(option, value);
        }
    }
    head + "#SBATCH --requeue\n"
}

/// Assignments to shell variables with quoted values.
fn settings<'a>(values: impl IntoIterator<Item = &'a (&'a str, &'a str)>) -> Result<String, CliError> {
    values.into_iter().try_fold(String::new(), |mut text, (name, value)| {
        let quoted = shlex::try_quote(value)
            .map_err(|error| CliError::Refused(format!("{name} cannot be written into a script: {error}")))?;
        let _ = writeln!(text, "{name}={quoted}");
        Ok(text)
    })
}

/// The path of this program, or its name if the file does not exist any more, for example after an update.
fn program() -> PathBuf {
    std::env::current_exe().ok().filter(|path| path.exists()).unwrap_or_else(|| PathBuf::from("tribosweep"))
}

fn utf8(path: &Path) -> Result<&str, CliError> {
    path.to_str().ok_or_else(|| {
        CliError::Refused(format!(
            "{}: the path cannot be written into a script because it is not UTF-8",
            path.display()
        ))
    })
}

fn create(folder: &Path) -> Result<(), CliError> {
    std::fs::create_dir_all(folder).map_err(|source| CliError::file(folder, source))
}

#[cfg(unix)]
fn make_executable(path: &Path) -> Result<(), CliError> {
    use std::os::unix::fs::PermissionsExt;
    let permissions = std::fs::Permissions::from_mode(0o755);
    std::fs::set_permissions(path, permissions).map_err(|source| CliError::file(path, source))
}

#[cfg(not(unix))]
fn make_executable(_: &Path) -> Result<(), CliError> {
    Ok(())
}

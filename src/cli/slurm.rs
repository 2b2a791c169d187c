//! `tribosweep slurm`: a study as a job array of a Slurm cluster.

mod scripts;
mod settings;

use super::error::CliError;
use super::output::{log, print};
use crate::exit;
use crate::queue::Location;
use crate::sweep::Plan;
use scripts::Scripts;
use settings::Database;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Arguments of `slurm`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study file.
    study: PathBuf,
    /// Number of workers, each of which is a task of the job array.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    workers: u32,
    /// Processors of each worker, and its threads.
    #[arg(long = "cpus-per-worker", value_name = "N", default_value_t = 1,
          value_parser = clap::value_parser!(u16).range(1..=1024))]
    cpus: u16,
    /// Partition (or several, with commas between them); default: the site's.
    #[arg(long, value_name = "P", value_parser = settings::names)]
    partition: Option<String>,
    /// Time limit of a task, which then continues in another time slot (30, 4:00:00, 1-12); default: the partition's.
    #[arg(long, value_name = "T", value_parser = settings::time_limit)]
    time: Option<String>,
    /// Account that the time is charged to; default: yours.
    #[arg(long, value_name = "A", value_parser = settings::names)]
    account: Option<String>,
    /// Memory of each worker (500M, 2G); default: the site's.
    #[arg(long, value_name = "M", value_parser = settings::memory)]
    mem: Option<String>,
    /// Folder for scripts, logs and results, which all nodes must see; default: STUDY.slurm.
    #[arg(long = "out", value_name = "FOLDER")]
    folder: Option<PathBuf>,
    /// Also submit the job array, by running the folder's submit.sh.
    #[arg(long)]
    submit: bool,
}

/// Writes the scripts, and submits them with `--submit`.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let database = Database::of(db)?;
    let plan = Plan::load(&args.study)?;
    let name = plan.name();
    if args.workers as usize > plan.jobs().len() {
        return Err(CliError::Usage(format!(
            "the study has fewer jobs than {} workers; give at most --workers {}",
            args.workers,
            plan.jobs().len()
        )));
    }
    let folder = args.folder.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.slurm")));
    let scripts = Scripts::new(args, name, &database, &folder)?;
    scripts.write()?;
    if args.submit {
        return submit(&scripts.submit());
    }
    log(format_args!("scripts written to {}; submit them with", folder.display()));
    print(&format!("{}\n", folder.join(scripts::SUBMIT).display()))?;
    Ok(exit::SUCCESS)
}

/// Runs the script, which prints what it does and submits everything or nothing.
fn submit(script: &Path) -> Result<u8, CliError> {
    let failed = |source| CliError::file(script, source);
    let status = Command::new("bash").arg(script).status().map_err(failed)?;
    if status.success() {
        return Ok(exit::SUCCESS);
    }
    Err(CliError::Refused(format!(
        "{} ended with {}; the lines above say why",
        script.display(),
        status.code().map_or_else(|| status.to_string(), |code| format!("code {code}"))
    )))
}

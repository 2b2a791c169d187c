//! The arguments of `tribosweep slurm`.

use super::settings;
use crate::cli::replace::Replacement;
use crate::cli::study_args::StudyArgs;
use std::path::PathBuf;

/// Arguments of `slurm`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    pub(super) study: StudyArgs,
    /// Number of workers, each of which is a task of the job array.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(super) workers: u32,
    /// Processors of each worker, and its threads.
    #[arg(long = "cpus-per-worker", value_name = "N", default_value_t = 1,
          value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) cpus: u16,
    /// Partition (or several, with commas between them); default: the site's.
    #[arg(long, value_name = "P", value_parser = settings::names)]
    pub(super) partition: Option<String>,
    /// Time limit of a task, which then continues in another time slot (30, 4:00:00, 1-12); default: the partition's.
    #[arg(long, value_name = "T", value_parser = settings::time_limit)]
    pub(super) time: Option<String>,
    /// Account that the time is charged to; default: yours.
    #[arg(long, value_name = "A", value_parser = settings::names)]
    pub(super) account: Option<String>,
    /// Memory of each worker (500M, 2G); default: the site's.
    #[arg(long, value_name = "M", value_parser = settings::memory)]
    pub(super) mem: Option<String>,
    /// Folder for scripts, logs and results, which all nodes must see; default: STUDY.slurm.
    #[arg(long = "out", value_name = "FOLDER")]
    pub(super) folder: Option<PathBuf>,
    #[command(flatten)]
    pub(super) replacement: Replacement,
    /// Also submit the job array, by running the folder's submit.sh.
    #[arg(long)]
    pub(super) submit: bool,
}

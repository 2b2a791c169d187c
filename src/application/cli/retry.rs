//! `tribosweep retry`: run failed and cancelled jobs again.

use super::error::CliError;
use super::output::log;
use super::work::log_taken_back;
use crate::exit;
use crate::publish::value;
use crate::queue::{Location, Retry};
use crate::sweep::{self, Purpose};

/// Arguments of `retry`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name or file.
    study: String,
    /// Retry failed jobs only, not cancelled ones.
    #[arg(long)]
    failed: bool,
    /// Retry only jobs that have ended and whose stored result or final motion cannot be read, or is damaged. That result is
    /// deleted.
    #[arg(long, conflicts_with = "failed")]
    unreadable: bool,
}

/// Makes the jobs pending again.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = sweep::study_name(&args.study)?;
    if args.unreadable {
        return run_again(&name, db);
    }
    let which = if args.failed { Retry::Failed } else { Retry::All };
    let (retried, stopped) = sweep::with_queue(db, Purpose::Change, async |queue| {
        let retried = queue.retry(&name, which).await?;
        let stopped = queue.stopped_workers().await?;
        Ok::<_, CliError>((retried, stopped))
    })?;
    log_taken_back(retried.taken_back);
    stopped.iter().for_each(log);
    let failed = value::count(retried.failed, "failed job");
    let cancelled = value::count(retried.cancelled, "cancelled job");
    let jobs = if args.failed { failed } else { format!("{failed} and {cancelled}") };
    log(format_args!("{name}: `retry` makes {jobs} pending again; `tribosweep work` runs pending jobs"));
    Ok(exit::SUCCESS)
}

fn run_again(name: &str, db: &Location) -> Result<u8, CliError> {
    let again = sweep::with_queue(db, Purpose::Change, async |queue| {
        let keys = sweep::unreadable_jobs(queue, name).await?;
        let again = if keys.is_empty() { 0 } else { queue.run_again(name, &keys).await? };
        Ok::<_, CliError>(again)
    })?;
    let jobs = value::count(again, "job");
    log(format_args!(
        "{name}: `retry` makes {jobs} pending again, whose results could not be read; `tribosweep work` runs pending jobs"
    ));
    Ok(exit::SUCCESS)
}

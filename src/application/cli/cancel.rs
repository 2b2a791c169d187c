//! `tribosweep cancel`: cancel the pending jobs of a study.

use super::error::CliError;
use super::output::log;
use crate::exit;
use crate::publish::value::count;
use crate::queue::Location;
use crate::sweep::{self, Purpose};

/// Arguments of `cancel`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name or file.
    study: String,
}

/// Cancels the jobs.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = sweep::study_name(&args.study)?;
    let cancelled =
        sweep::with_queue(db, Purpose::Change, async |queue| Ok::<_, CliError>(queue.cancel(&name).await?))?;
    log(format_args!(
        "{name}: {} cancelled; `tribosweep retry {name}` undoes this",
        count(cancelled.cancelled, "pending job")
    ));
    if cancelled.shared > 0 {
        log(format_args!(
            "not cancelled, because other studies need them: {}",
            count(cancelled.shared, "pending job")
        ));
    }
    if cancelled.running > 0 {
        log(format_args!(
            "running, and not cancelled: {}; press Ctrl-C in a worker to stop its jobs",
            count(cancelled.running, "job")
        ));
    }
    Ok(exit::SUCCESS)
}

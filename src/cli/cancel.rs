//! `tribosweep cancel`: cancel the pending jobs of a study.

use super::error::CliError;
use super::output::log;
use crate::exit;
use crate::publish::value::count;
use crate::queue::Location;
use crate::sweep;

/// Arguments of `cancel`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name or file.
    study: String,
}

/// Cancels the jobs.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = sweep::study_name(&args.study)?;
    let cancelled = sweep::block_on(async {
        let mut queue = sweep::open_to_change(db.clone()).await?;
        let cancelled = queue.cancel(&name).await?;
        queue.close().await?;
        Ok::<_, CliError>(cancelled)
    })?;
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

//! `tribosweep cancel`: pending jobs of a study are not wanted any more.

use super::error::CliError;
use super::output::{block_on, tell};
use super::rows;
use crate::exit;
use crate::queue::Location;

/// Arguments of `cancel`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study's name or file.
    study: String,
}

/// Cancels the jobs.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = rows::study_name(&args.study)?;
    let cancelled = block_on(async {
        let mut queue = rows::open_to_change(db).await?;
        let cancelled = queue.cancel(&name).await?;
        queue.close().await?;
        Ok(cancelled)
    })?;
    tell(format_args!(
        "{name}: {} pending jobs cancelled; `tribosweep retry {name}` brings them back",
        cancelled.cancelled
    ));
    if cancelled.shared > 0 {
        tell(format_args!("{} pending jobs stay: other studies ask for them", cancelled.shared));
    }
    if cancelled.running > 0 {
        tell(format_args!(
            "{} jobs are running and go on to their end; stop their worker with Ctrl-C to stop them",
            cancelled.running
        ));
    }
    Ok(exit::SUCCESS)
}

//! `tribosweep rm`: remove a study.

use super::error::CliError;
use super::output::{block_on, tell};
use super::rows;
use crate::exit;
use crate::queue::Location;

/// Arguments of `rm`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study's name or file.
    study: String,
}

/// Removes the study.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = rows::study_name(&args.study)?;
    let removed = block_on(async {
        let mut queue = rows::open_to_change(db).await?;
        let removed = queue.remove(&name).await?;
        queue.close().await?;
        Ok(removed)
    })?;
    tell(format_args!(
        "{name}: removed, {} rows; {} pending jobs that nobody else asks for cancelled; results stay until \
         `tribosweep gc`",
        removed.rows, removed.cancelled
    ));
    Ok(exit::SUCCESS)
}

//! `tribosweep rm`: remove a study.

use super::error::CliError;
use super::output::log;
use crate::exit;
use crate::queue::Location;
use crate::sweep;

/// Arguments of `rm`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name or file.
    study: String,
}

/// Removes the study.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = sweep::study_name(&args.study)?;
    let removed = sweep::block_on(async {
        let mut queue = sweep::open_to_change(db.clone()).await?;
        let removed = queue.remove(&name).await?;
        queue.close().await?;
        Ok::<_, CliError>(removed)
    })?;
    log(format_args!(
        "{name}: removed with {} rows; {} pending jobs that no other study needs are cancelled; results stay in the \
         database until `tribosweep gc`",
        removed.rows, removed.cancelled
    ));
    Ok(exit::SUCCESS)
}

//! `tribosweep document`: the file of a study in the database.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::queue::Location;
use crate::sweep;

/// Arguments of `document`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name.
    study: String,
}

/// Prints the document of the study as it was submitted.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let document = sweep::block_on(async {
        let mut queue = sweep::open_to_read(db.clone()).await?;
        let document = sweep::document(&mut queue, &args.study).await?;
        queue.close().await?;
        Ok::<_, CliError>(document)
    })?;
    print(&document)?;
    Ok(exit::SUCCESS)
}

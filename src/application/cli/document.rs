//! `tribosweep document`: the file of a study in the database.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::queue::Location;
use crate::sweep::{self, Purpose};

/// Arguments of `document`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name.
    study: String,
}

/// Prints the document of the study as it was submitted.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let document = sweep::with_queue(db, Purpose::Read, async |queue| {
        Ok::<_, CliError>(sweep::document(queue, &args.study).await?)
    })?;
    print(&document)?;
    Ok(exit::SUCCESS)
}

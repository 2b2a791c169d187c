//! `tribosweep rename`: another name for a study.

use super::error::CliError;
use super::output::log;
use crate::exit;
use crate::queue::Location;
use crate::sweep::{self, Purpose};

/// Arguments of `rename`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name or file.
    study: String,
    /// The new name, which no study has.
    name: String,
}

/// Renames the study in the database.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let old = sweep::study_name(&args.study)?;
    let new = &args.name;
    sweep::with_queue(db, Purpose::Change, async |queue| {
        sweep::rename(queue, &old, new).await?;
        Ok::<_, CliError>(())
    })?;
    log(format_args!(
        "{old}: is {new} in the database now; its report stays in the folder that it is in, and `tribosweep report {new}` \
         writes another one. Give the study's file the \"name\" {new} too: otherwise its next submission adds {old} again"
    ));
    Ok(exit::SUCCESS)
}

//! `tribosweep man`: manual pages.

use super::Cli;
use super::error::CliError;
use crate::exit;
use clap::CommandFactory;
use std::path::PathBuf;

/// Arguments of `man`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The folder, which is made if it is not there. Pages of the same names are replaced.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Writes a page for the program and one for each command.
pub(crate) fn run(args: &Args) -> Result<u8, CliError> {
    let written = std::fs::create_dir_all(&args.folder)
        .and_then(|()| clap_mangen::generate_to(Cli::command(), &args.folder));
    written.map_err(|source| CliError::file(&args.folder, source))?;
    Ok(exit::SUCCESS)
}

//! `tribosweep pareto`: error against run time.

use super::error::CliError;
use super::output::{log, print};
use super::report::OutFolder;
use super::rows;
use crate::exit;
use crate::queue::Location;
use crate::report::pareto;
use crate::study::is_numerics;

/// Arguments of `pareto`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Names or files of the studies; several are compared as one.
    #[arg(required = true)]
    studies: Vec<String>,
    #[command(flatten)]
    out: OutFolder,
}

/// Compares the finished jobs, prints the tables and writes the files.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let (names, rows) = rows::of_studies(&args.studies, db)?;
    let title = names.join(", ");
    let comparison = pareto::compare(&rows, is_numerics)
        .map_err(|error| CliError::Refused(format!("{title}: {error}")))?;
    print(&pareto::markdown(&comparison))?;
    let folder = args.out.of(&names[0]);
    pareto::write(&comparison, &folder, &title)?;
    log(format_args!("comparison written to {}", folder.display()));
    Ok(exit::SUCCESS)
}

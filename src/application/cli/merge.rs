//! `tribosweep merge` and `tribosweep copy`: studies from one database to another.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::publish::value::count;
use crate::queue::{Absorbed, Location};
use crate::sweep::{self, Transfer};
use clap::builder::{OsStringValueParser, TypedValueParser};

/// Arguments of `merge`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The databases whose studies, jobs and results are added to the one that --db names.
    #[arg(required = true, value_name = "PATH|URL",
          value_parser = OsStringValueParser::new().map(Location::parse))]
    sources: Vec<Location>,
}

/// Arguments of `copy`.
#[derive(Debug, clap::Args)]
pub(crate) struct CopyArgs {
    /// The name or file of the study to copy; default: all studies.
    study: Option<String>,
    /// The database to copy from; default: the one that --db names.
    #[arg(long, value_name = "PATH|URL", value_parser = OsStringValueParser::new().map(Location::parse))]
    from: Option<Location>,
    /// The database to copy to; it is created if it does not exist.
    #[arg(long, value_name = "PATH|URL", value_parser = OsStringValueParser::new().map(Location::parse))]
    to: Location,
}

/// Merges databases into the one at `db`.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    transfer(&args.sources, db, None)
}

/// Copies one study or all of them.
pub(crate) fn copy(args: &CopyArgs, db: &Location) -> Result<u8, CliError> {
    let study = args.study.as_deref().map(sweep::study_name).transpose()?;
    transfer(std::slice::from_ref(args.from.as_ref().unwrap_or(db)), &args.to, study.as_deref())
}

fn transfer(sources: &[Location], target: &Location, study: Option<&str>) -> Result<u8, CliError> {
    let transfers = sweep::block_on(sweep::transfer(sources, target, study))?;
    let lines = transfers.iter().map(line);
    print(&lines.collect::<String>())?;
    Ok(exit::SUCCESS)
}

fn line(Transfer { source, absorbed }: &Transfer) -> String {
    let Absorbed { studies, rows, added, ended, open } = absorbed;
    let still = if *open > 0 { format!("; still to be run: {open}") } else { String::new() };
    format!(
        "{source}: {} with {}; jobs that are new here: {added}, jobs with their results from there: {ended}{still}\n",
        count(*studies, "study"),
        count(*rows, "row")
    )
}

//! `tribosweep merge` and `tribosweep copy`: studies from one database into another.

use super::error::CliError;
use super::output::{block_on, print};
use super::rows;
use crate::exit;
use crate::queue::{Absorbed, Clock, Location, Queue, Scope};
use clap::builder::{OsStringValueParser, TypedValueParser};

/// Arguments of `merge`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The databases whose studies, jobs and results are taken over into the one that --db names.
    #[arg(required = true, value_name = "PATH|URL",
          value_parser = OsStringValueParser::new().map(Location::parse))]
    sources: Vec<Location>,
}

/// Arguments of `copy`.
#[derive(Debug, clap::Args)]
pub struct CopyArgs {
    /// The name or file of the study to copy; all of them when left out.
    study: Option<String>,
    /// The database to copy from; default: the one that --db names.
    #[arg(long, value_name = "PATH|URL", value_parser = OsStringValueParser::new().map(Location::parse))]
    from: Option<Location>,
    /// The database to copy to; it is created if it is not there.
    #[arg(long, value_name = "PATH|URL", value_parser = OsStringValueParser::new().map(Location::parse))]
    to: Location,
}

/// Brings databases together in the one at `db`.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    take_over(&args.sources, db, None)
}

/// Copies one or all studies.
pub fn copy(args: &CopyArgs, db: &Location) -> Result<u8, CliError> {
    let study = args.study.as_deref().map(rows::study_name).transpose()?;
    take_over(std::slice::from_ref(args.from.as_ref().unwrap_or(db)), &args.to, study.as_deref())
}

fn take_over(sources: &[Location], target: &Location, study: Option<&str>) -> Result<u8, CliError> {
    if let Some(same) = sources.iter().find(|source| is_same(source, target)) {
        return Err(CliError::Usage(format!(
            "{same} is both what is read and what is written; give two databases"
        )));
    }
    block_on(async {
        // All of them are opened before anything is written: a wrong name leaves no half behind.
        let mut opened = Vec::new();
        for source in sources {
            let mut source = rows::open(source).await?;
            source.counts(&study.map_or(Scope::All, |name| Scope::Study(name.to_owned()))).await?;
            opened.push(source);
        }
        let mut queue = Queue::open(target.clone(), Clock::OfDatabase).await?;
        let mut lines = Vec::new();
        for mut source in opened {
            let from = source.location().to_string();
            let absorbed = queue.absorb(&mut source, study).await?;
            lines.push(format!("{from}: {}\n", in_words(absorbed)));
            source.close().await?;
        }
        queue.close().await?;
        print(&lines.concat())
    })?;
    Ok(exit::SUCCESS)
}

fn is_same(source: &Location, target: &Location) -> bool {
    match (source.path().map(std::fs::canonicalize), target.path().map(std::fs::canonicalize)) {
        (Some(Ok(source)), Some(Ok(target))) => source == target,
        _ => source == target,
    }
}

fn in_words(Absorbed { studies, rows, added, ended, open }: Absorbed) -> String {
    let still = if open > 0 { format!("; {open} are still to be run") } else { String::new() };
    format!(
        "{studies} studies with {rows} rows; {added} jobs are new here, {ended} have their results from there{still}"
    )
}

//! `tribosweep retry`: failed and cancelled jobs are to be tried again.

use super::error::CliError;
use super::output::{block_on, tell};
use super::rows;
use crate::exit;
use crate::queue::{Location, Retry};

/// Arguments of `retry`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The study's name or file.
    study: String,
    /// Only the jobs that failed, not those that were cancelled.
    #[arg(long)]
    failed: bool,
}

/// Makes the jobs pending again.
pub fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = rows::study_name(&args.study)?;
    let which = if args.failed { Retry::Failed } else { Retry::All };
    let retried = block_on(async {
        let mut queue = rows::open_to_change(db).await?;
        let retried = queue.retry(&name, which).await?;
        queue.close().await?;
        Ok(retried)
    })?;
    let failed = format!("{} failed", retried.failed);
    let cancelled = if args.failed { String::new() } else { format!(" and {} cancelled", retried.cancelled) };
    tell(format_args!("{name}: {failed}{cancelled} jobs are pending again; `tribosweep work` runs them"));
    Ok(exit::SUCCESS)
}

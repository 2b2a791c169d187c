//! `tribosweep retry`: run failed and cancelled jobs again.

use super::error::CliError;
use super::output::log;
use super::work::log_taken_back;
use crate::exit;
use crate::publish::value;
use crate::queue::{Location, Retry};
use crate::sweep;

/// Arguments of `retry`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study's name or file.
    study: String,
    /// Retry failed jobs only, not cancelled ones.
    #[arg(long)]
    failed: bool,
}

/// Makes the jobs pending again.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let name = sweep::study_name(&args.study)?;
    let which = if args.failed { Retry::Failed } else { Retry::All };
    let retried = sweep::block_on(async {
        let mut queue = sweep::open_to_change(db.clone()).await?;
        let retried = queue.retry(&name, which).await?;
        queue.close().await?;
        Ok::<_, CliError>(retried)
    })?;
    log_taken_back(retried.taken_back);
    let failed = value::count(retried.failed, "failed job");
    let cancelled = value::count(retried.cancelled, "cancelled job");
    let jobs = if args.failed { failed } else { format!("{failed} and {cancelled}") };
    log(format_args!("{name}: `retry` makes {jobs} pending again; `tribosweep work` runs pending jobs"));
    Ok(exit::SUCCESS)
}

//! `tribosweep doctor`: check the database and its environment.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::publish::table::listed;
use crate::queue::{Clock, Finding, Location, Queue, examine};
use crate::sweep;

/// Arguments of `doctor`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Also read everything that is stored: each result with its digest, and the specifications, motions and checkpoints of
    /// jobs. This takes as long as an export.
    #[arg(long)]
    deep: bool,
}

/// Prints what was checked. The exit code says whether there is a problem.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let findings = sweep::block_on(async {
        let mut findings = examine(db, Clock::OfDatabase).await?;
        // If it does not open, the first findings say so.
        if args.deep
            && let Ok(queue) = sweep::open_to_read(db.clone()).await
        {
            let deep = async |queue: &mut Queue| Ok::<_, CliError>(sweep::examine_deeply(queue).await);
            findings.extend(sweep::with_open(queue, deep).await?);
        }
        Ok::<_, CliError>(findings)
    })?;
    let line = |finding: &Finding| {
        let mark = if finding.is_problem { "PROBLEM" } else { "ok     " };
        [mark.to_owned(), finding.subject.to_owned(), finding.text.clone()]
    };
    print(&listed(0, &findings.iter().map(line).collect::<Vec<_>>(), None))?;
    let is_well = findings.iter().all(|finding| !finding.is_problem);
    Ok(if is_well { exit::SUCCESS } else { exit::ERROR })
}

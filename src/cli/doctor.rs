//! `tribosweep doctor`: check the database and its environment.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::queue::{Clock, Location, examine};
use crate::sweep;
use std::fmt::Write;

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
            && let Ok(mut queue) = sweep::open_to_read(db.clone()).await
        {
            findings.extend(sweep::examine_deeply(&mut queue).await);
            queue.close().await?;
        }
        Ok::<_, CliError>(findings)
    })?;
    let width = findings.iter().map(|finding| finding.subject.len()).max().unwrap_or(0);
    let text = findings.iter().fold(String::new(), |mut text, finding| {
        let mark = if finding.is_problem { "PROBLEM" } else { "ok" };
        let _ = writeln!(text, "{mark:7}  {:width$}  {}", finding.subject, finding.text);
        text
    });
    print(&text)?;
    let is_well = findings.iter().all(|finding| !finding.is_problem);
    Ok(if is_well { exit::SUCCESS } else { exit::ERROR })
}

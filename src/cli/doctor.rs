//! `tribosweep doctor`: check the database and its environment.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::queue::{Clock, Location, examine};
use crate::sweep;
use std::fmt::Write;

/// Prints what was checked. The exit code says whether there is a problem.
pub(crate) fn run(db: &Location) -> Result<u8, CliError> {
    let findings = sweep::block_on(async { Ok::<_, CliError>(examine(db, Clock::OfDatabase).await?) })?;
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

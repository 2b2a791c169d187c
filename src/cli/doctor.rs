//! `tribosweep doctor`: what is wrong with the database, if anything is.

use super::error::CliError;
use super::output::{block_on, print};
use crate::exit;
use crate::queue::{Clock, Location, examine};
use std::fmt::Write;

/// Prints what was looked at; the exit code says whether something needs doing.
pub fn run(db: &Location) -> Result<u8, CliError> {
    let findings = block_on(async { Ok(examine(db, Clock::OfDatabase).await?) })?;
    let width = findings.iter().map(|finding| finding.subject.len()).max().unwrap_or(0);
    let text = findings.iter().fold(String::new(), |mut text, finding| {
        let mark = if finding.is_problem { "PROBLEM" } else { "ok" };
        let _ = writeln!(text, "{mark:7}  {:width$}  {}", finding.subject, finding.text);
        text
    });
    print(&text)?;
    let is_well = findings.iter().all(|finding| !finding.is_problem);
    Ok(if is_well { exit::SUCCESS } else { exit::BAD_INPUT })
}

//! `tribosweep validate`: check a study file without running it.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::sweep::Plan;
use std::path::PathBuf;

/// Arguments of `validate`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The study file.
    study: PathBuf,
}

/// Checks the study and prints the number of jobs.
pub(crate) fn run(args: &Args) -> Result<u8, CliError> {
    let plan = Plan::load(&args.study)?;
    let axes: Vec<String> = plan
        .study()
        .axes()
        .map(|(parameter, values)| format!("{} {}", parameter.name, values.len()))
        .collect();
    let grid = if axes.is_empty() { String::new() } else { format!(" ({})", axes.join(" × ")) };
    print(&format!("{}: valid, {} jobs{grid}\n", args.study.display(), plan.jobs().len()))?;
    Ok(exit::SUCCESS)
}

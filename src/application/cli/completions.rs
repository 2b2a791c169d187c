//! `tribosweep completions`: shell completion.

use super::Cli;
use super::error::CliError;
use super::output::print;
use crate::exit;
use clap::CommandFactory;
use clap_complete::Shell;

/// Arguments of `completions`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The shell.
    shell: Shell,
}

/// Prints the completion script.
pub(crate) fn run(args: &Args) -> Result<u8, CliError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "tribosweep", &mut script);
    print(&script)?;
    Ok(exit::SUCCESS)
}

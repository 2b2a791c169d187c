//! `tribosweep schema`: the JSON schema of study files.

use super::error::CliError;
use super::output::print;
use crate::{exit, study};

/// Arguments of `schema`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {}

/// Prints the schema.
pub(crate) fn run(_: &Args) -> Result<u8, CliError> {
    print(&format!("{:#}\n", study::schema()))?;
    Ok(exit::SUCCESS)
}

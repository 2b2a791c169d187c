//! The `tribosweep` command: parses the arguments, runs the command and returns its exit code.

use clap::Parser;
use std::process::ExitCode;
use tribosweep::cli::{self, Cli};

fn main() -> ExitCode {
    ExitCode::from(cli::main(Cli::parse()))
}

//! The `tribosweep` command: parses the arguments, runs the command and returns its exit code.

use std::process::ExitCode;
use tribosweep::cli::{self, Cli};

#[cfg(target_env = "musl")]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    ExitCode::from(cli::main(Cli::from_arguments()))
}

//! Output helpers: whole files or none, and a runtime for commands that read the database.

use super::error::CliError;
use std::fmt::Display;
use std::future::Future;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Runs a future on a runtime of this thread.
pub fn block_on<T>(future: impl Future<Output = Result<T, CliError>>) -> Result<T, CliError> {
    tokio::runtime::Builder::new_current_thread().enable_all().build()?.block_on(future)
}

/// Writes a result to standard output.
///
/// A reader that has seen enough (`tribosweep … | head`) is no failure, and changes no exit code.
pub fn print<T: AsRef<[u8]> + ?Sized>(content: &T) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(content.as_ref()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Writes a line to standard error. If nobody can read it, the work goes on all the same: `eprintln!`
/// would end the sweep with a panic.
pub fn tell(line: impl Display) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// Writes a file through a temporary sibling, so that it is never half-written.
pub fn write_file(path: &Path, content: &[u8]) -> Result<(), CliError> {
    let failed = |source| CliError::File { path: path.display().to_string(), source };
    let mut partial = path.as_os_str().to_owned();
    partial.push(".partial");
    std::fs::write(&partial, content).map_err(failed)?;
    std::fs::rename(&partial, path).map_err(failed)
}

//! Output helpers: whole files or none, and a runtime for commands that read the database.

use super::error::CliError;
use std::future::Future;
use std::io::Write;
use std::path::Path;

/// Runs a future on a runtime of this thread.
pub fn block_on<T>(future: impl Future<Output = Result<T, CliError>>) -> Result<T, CliError> {
    tokio::runtime::Builder::new_current_thread().enable_all().build()?.block_on(future)
}

/// Writes `content` to standard output.
pub fn print(content: &str) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    out.write_all(content.as_bytes())?;
    out.flush()?;
    Ok(())
}

/// Writes a file through a temporary sibling, so that it is never half-written.
pub fn write_file(path: &Path, content: &[u8]) -> Result<(), CliError> {
    let failed = |source| CliError::File { path: path.display().to_string(), source };
    let mut partial = path.as_os_str().to_owned();
    partial.push(".partial");
    std::fs::write(&partial, content).map_err(failed)?;
    std::fs::rename(&partial, path).map_err(failed)
}

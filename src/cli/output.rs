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
///
/// What is no regular file (`/dev/null`, a pipe) is written to and stays what it is, and a link leads to
/// the file that is replaced.
pub fn write_file(path: &Path, content: &[u8]) -> Result<(), CliError> {
    let failed = |source| CliError::File { path: path.display().to_string(), source };
    if path.metadata().is_ok_and(|metadata| !metadata.is_file()) {
        return std::fs::write(path, content).map_err(failed);
    }
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let mut partial = target.as_os_str().to_owned();
    partial.push(".partial");
    std::fs::write(&partial, content).and_then(|()| std::fs::rename(&partial, &target)).map_err(|source| {
        // The first error is the one to report; that of the clean-up adds nothing.
        let _ = std::fs::remove_file(&partial);
        failed(source)
    })
}

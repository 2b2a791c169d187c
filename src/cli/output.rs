//! Output helpers: whole files or none, and a runtime for commands that read the database.

use super::error::CliError;
use std::fmt::Display;
use std::fs::File;
use std::future::Future;
use std::io::{BufWriter, ErrorKind, Write};
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

/// Characters in a line of the terminal that shows standard output; a hundred where there is none.
pub fn width() -> usize {
    terminal_size::terminal_size_of(std::io::stdout()).map_or(100, |(width, _)| usize::from(width.0))
}

/// A text with its colours where standard output shows them: on a terminal, unless `NO_COLOR` is set.
pub fn coloured(text: String) -> String {
    match anstream::AutoStream::choice(&std::io::stdout()) {
        anstream::ColorChoice::Never => anstream::adapter::strip_str(&text).to_string(),
        _ => text,
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
    fill_file(path, |out| Ok(out.write_all(content)?))
}

/// As [`write_file`], for what is not held all at once: `fill` writes it. If it fails, nothing is replaced.
pub fn fill_file(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), CliError>,
) -> Result<(), CliError> {
    let failed = |source| CliError::File { path: path.display().to_string(), source };
    let write = |path: &Path| {
        let mut out = BufWriter::new(File::create(path).map_err(failed)?);
        let filled = fill(&mut out).and_then(|()| Ok(out.flush()?));
        // What is written goes to this file and nowhere else.
        filled.map_err(|error| if let CliError::Output(source) = error { failed(source) } else { error })
    };
    if path.metadata().is_ok_and(|metadata| !metadata.is_file()) {
        return write(path);
    }
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let mut partial = target.as_os_str().to_owned();
    partial.push(".partial");
    let partial = Path::new(&partial);
    let written = write(partial).and_then(|()| std::fs::rename(partial, &target).map_err(failed));
    written.inspect_err(|_| {
        // The first error is the one to report; that of the clean-up adds nothing.
        let _ = std::fs::remove_file(partial);
    })
}

/// Writes to standard output what is not held all at once, and takes a reader that has seen enough as [`print`] does.
pub fn stream(fill: impl FnOnce(&mut dyn Write) -> Result<(), CliError>) -> Result<(), CliError> {
    let mut out = BufWriter::new(std::io::stdout().lock());
    match fill(&mut out).and_then(|()| Ok(out.flush()?)) {
        Err(CliError::Output(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        filled => filled,
    }
}

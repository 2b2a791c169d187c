//! Standard output, standard error and files that are replaced as a whole.

use super::error::CliError;
use crate::publish::write_atomically;
use std::fmt::Display;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::Path;

/// Writes a result to standard output.
///
/// A reader that closes the pipe early (`tribosweep … | head`) is not an error and does not change the exit code.
pub(crate) fn print<T: AsRef<[u8]> + ?Sized>(content: &T) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match out.write_all(content.as_ref()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Writes to standard output a result that is too large to be held in memory. It treats a closed pipe as [`print`] does.
pub(crate) fn stream(fill: impl FnOnce(&mut dyn Write) -> Result<(), CliError>) -> Result<(), CliError> {
    let mut out = BufWriter::new(io::stdout().lock());
    match fill(&mut out).and_then(|()| Ok(out.flush()?)) {
        Err(CliError::Output(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        filled => filled,
    }
}

/// Characters per line of the terminal that shows standard output; 100 if it is not a terminal.
pub(crate) fn width() -> usize {
    terminal_size::terminal_size_of(io::stdout()).map_or(100, |(width, _)| usize::from(width.0))
}

/// Removes the colours from a text unless standard output shows them: on a terminal, and without `NO_COLOR`.
pub(crate) fn coloured(text: String) -> String {
    match anstream::AutoStream::choice(&io::stdout()) {
        anstream::ColorChoice::Never => anstream::adapter::strip_str(&text).to_string(),
        _ => text,
    }
}

/// Writes a line to standard error. An error is ignored: `eprintln!` would end the sweep with a panic if standard error
/// is closed.
pub(crate) fn log(line: impl Display) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// Writes a whole file; see [`write_atomically`](crate::publish::write_atomically).
pub(crate) fn write_file(path: &Path, content: &[u8]) -> Result<(), CliError> {
    write_atomically(path, |out| out.write_all(content)).map_err(|source| CliError::file(path, source))
}

/// As [`write_file`], for content that is too large to be held in memory: `fill` writes it. If `fill` fails, the file is
/// left as it was.
pub(crate) fn fill_file(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> Result<(), CliError>,
) -> Result<(), CliError> {
    // An error of `fill` that is not an error of the file.
    let mut failure = None;
    let written = write_atomically(path, |out| {
        fill(out).map_err(|error| match error {
            CliError::Output(source) => source,
            error => {
                failure = Some(error);
                io::Error::other("the content is not complete")
            }
        })
    });
    match failure {
        Some(error) => Err(error),
        None => written.map_err(|source| CliError::file(path, source)),
    }
}

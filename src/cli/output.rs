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
    terminal_width().unwrap_or(100)
}

/// Characters per line of the terminal that shows standard output, if it is a terminal.
pub(crate) fn terminal_width() -> Option<usize> {
    terminal_size::terminal_size_of(io::stdout()).map(|(width, _)| usize::from(width.0))
}

/// Breaks the lines that are wider than the terminal which shows standard output between words. Text that goes elsewhere is
/// left as it is, for programs that read it line by line.
pub(crate) fn fitted(text: String) -> String {
    match terminal_size::terminal_size_of(io::stdout()) {
        Some((width, _)) => broken(&text, usize::from(width.0)),
        None => text,
    }
}

/// Breaks the lines that are longer than `width` characters, colours not counted, between words.
fn broken(text: &str, width: usize) -> String {
    let fits = |line: &str| anstream::adapter::strip_str(line).to_string().chars().count() <= width;
    let lines =
        text.lines().flat_map(|line| if fits(line) { vec![line.to_owned()] } else { wrapped(line, width) });
    lines.fold(String::new(), |text, line| text + &line + "\n")
}

/// Breaks a text into lines of at most `width` characters. A longer word has a line of its own.
pub(crate) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
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

#[cfg(test)]
mod tests {
    use super::broken;

    /// Protects: long lines are broken between words, and lines that fit are not changed, also if their colours make them long.
    #[test]
    fn only_long_lines_are_broken() {
        let coloured = "\u{1b}[32m█████\u{1b}[0m  33 %";
        let text = format!("a  b\n{coloured}\n12 jobs: 3 done, 9 pending\n");
        assert_eq!(broken(&text, 16), format!("a  b\n{coloured}\n12 jobs: 3 done,\n9 pending\n"));
    }
}

//! Standard output, standard error and files that are replaced as a whole.

use super::error::CliError;
use crate::publish::write_atomically;
use crate::units::printable_lines;
use std::fmt::Display;
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Write};
use std::path::Path;

/// Writes a result to standard output.
///
/// A reader that closes the pipe early (`tribosweep … | head`) is not an error and does not change the exit code.
///
/// On a terminal, characters that it would obey are shown instead, except for the program's own colours.
pub(crate) fn print<T: AsRef<[u8]> + ?Sized>(content: &T) -> Result<(), CliError> {
    let out = io::stdout();
    let mut out = Shown::new(out.lock(), io::stdout().is_terminal());
    match out.write_all(content.as_ref()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Writes to standard output a result that is too large to be held in memory. It treats a closed pipe as [`print`] does.
pub(crate) fn stream(fill: impl FnOnce(&mut dyn Write) -> Result<(), CliError>) -> Result<(), CliError> {
    let mut out = Shown::new(BufWriter::new(io::stdout().lock()), io::stdout().is_terminal());
    match fill(&mut out).and_then(|()| Ok(out.flush()?)) {
        Err(CliError::Output(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        filled => filled,
    }
}

/// A writer to a terminal that does not obey what strangers have written, or to anything else, which gets every byte as it is.
struct Shown<W: Write> {
    out: W,
    is_terminal: bool,
    /// The line that has no end yet.
    line: Vec<u8>,
}

impl<W: Write> Shown<W> {
    fn new(out: W, is_terminal: bool) -> Self {
        Self { out, is_terminal, line: Vec::new() }
    }
}

impl<W: Write> Write for Shown<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if !self.is_terminal {
            return self.out.write(bytes);
        }
        // A character or a colour may come in two parts, but not in two lines.
        self.line.extend_from_slice(bytes);
        if let Some(end) = self.line.iter().rposition(|byte| *byte == b'\n') {
            let rest = self.line.split_off(end + 1);
            let lines = std::mem::replace(&mut self.line, rest);
            self.out.write_all(shown(&String::from_utf8_lossy(&lines)).as_bytes())?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let rest = std::mem::take(&mut self.line);
        self.out.write_all(shown(&String::from_utf8_lossy(&rest)).as_bytes())?;
        self.out.flush()
    }
}

/// A text for a terminal: with the colours of this program, and without anything else that a terminal obeys.
fn shown(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('\u{1b}') {
        shown += &printable_lines(&rest[..at]);
        let length = colour_length(&rest[at..]);
        shown += if length > 0 { &rest[at..at + length] } else { "\\u{1b}" };
        rest = &rest[at + length.max(1)..];
    }
    shown + &printable_lines(rest)
}

/// The length of the colour with which a text begins; 0 if it begins with something else. Colours are those of letters (30 to 37, 90
/// to 97) and their end (0): no text can be hidden.
fn colour_length(text: &str) -> usize {
    let Some((code, _)) = text.strip_prefix("\u{1b}[").and_then(|rest| rest.split_once('m')) else {
        return 0;
    };
    let is_colour = matches!(code.parse::<u8>(), Ok(0 | 30..=37 | 90..=97)) && code.len() <= 2;
    if is_colour { code.len() + 3 } else { 0 }
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
/// is closed. Characters that a terminal would obey are shown instead: messages quote keys, names and errors of strangers.
pub(crate) fn log(line: impl Display) {
    let line = line.to_string();
    let _ = writeln!(io::stderr(), "{}", printable_lines(&line));
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
    use super::{Shown, broken};
    use std::io::Write;

    /// Protects: a terminal shows what strangers wrote and obeys nothing of it; colours of the program pass, and files get every byte.
    #[test]
    fn a_terminal_obeys_nothing() {
        let through = |is_terminal: bool, parts: &[&str]| {
            let mut shown = Shown::new(Vec::new(), is_terminal);
            for part in parts {
                shown.write_all(part.as_bytes()).unwrap();
            }
            shown.flush().unwrap();
            String::from_utf8(shown.out).unwrap()
        };
        let hostile = ["a\u{1b}]0;owned\u{7}\n", "\u{1b}[32mgreen\u{1b}", "[0m\t\u{1b}[8mhidden\u{202e}"];
        let expected = "a\\u{1b}]0;owned\\u{7}\n\u{1b}[32mgreen\u{1b}[0m\t\\u{1b}[8mhidden\\u{202e}";
        assert_eq!(through(true, &hostile), expected);
        assert_eq!(through(false, &hostile), hostile.concat());
    }

    /// Protects: long lines are broken between words, and lines that fit are not changed, also if their colours make them long.
    #[test]
    fn only_long_lines_are_broken() {
        let coloured = "\u{1b}[32m█████\u{1b}[0m  33 %";
        let text = format!("a  b\n{coloured}\n12 jobs: 3 done, 9 pending\n");
        assert_eq!(broken(&text, 16), format!("a  b\n{coloured}\n12 jobs: 3 done,\n9 pending\n"));
    }
}

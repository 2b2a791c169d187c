//! Text files that users name: studies, meshes, maps, tables of points.

use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;

/// Reads a text file of at most `most_bytes` bytes.
///
/// # Errors
/// If it is no regular file (a pipe would wait for ever, a device may have no end), is larger, is not text in UTF-8, or cannot be
/// read.
pub fn read_text(path: &Path, most_bytes: u64) -> Result<String> {
    // What a shell has opened for the program, `<(…)`, is read like standard input.
    if ["/dev/fd", "/dev/stdin", "/proc/self/fd"].iter().any(|open| path.starts_with(open)) {
        return bounded(File::open(path)?, most_bytes);
    }
    // Opening a pipe that nobody writes to would wait.
    refuse_special(&std::fs::metadata(path)?)?;
    let file = File::open(path)?;
    let metadata = file.metadata()?;
    refuse_special(&metadata)?;
    if metadata.len() > most_bytes {
        return Err(too_large(most_bytes));
    }
    bounded(file, most_bytes)
}

/// Reads the text of a stream of at most `most_bytes` bytes.
///
/// # Errors
/// As [`read_text`].
pub(super) fn bounded(from: impl Read, most_bytes: u64) -> Result<String> {
    let mut bytes = Vec::new();
    from.take(most_bytes + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most_bytes {
        return Err(too_large(most_bytes));
    }
    decoded(bytes)
}

fn refuse_special(metadata: &std::fs::Metadata) -> Result<()> {
    let kind = metadata.file_type();
    if kind.is_file() {
        return Ok(());
    }
    let what = if kind.is_dir() { "a folder" } else { "a pipe or a device" };
    Err(Error::new(ErrorKind::InvalidInput, format!("it is {what}; expected a regular file")))
}

fn too_large(most_bytes: u64) -> Error {
    Error::new(ErrorKind::FileTooLarge, format!("it has more than {} MB", most_bytes / 1_000_000))
}

/// The text of bytes in UTF-8.
fn decoded(bytes: Vec<u8>) -> Result<String> {
    let wrong = |what: String| Error::new(ErrorKind::InvalidData, format!("{what}; save it as UTF-8"));
    // UTF-16 begins with its mark, or every other byte of its Latin letters is 0.
    let is_utf16 = |bytes: &[u8]| {
        bytes.starts_with(&[0xff, 0xfe])
            || bytes.starts_with(&[0xfe, 0xff])
            || bytes.len() > 3 && (bytes[1] == 0 && bytes[3] == 0 || bytes[0] == 0 && bytes[2] == 0)
    };
    if is_utf16(&bytes) {
        return Err(wrong("it is a text in UTF-16".to_owned()));
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..at].split(|byte| *byte == b'\n').count();
        wrong(format!("line {line} has a byte {:#04x} that is not UTF-8", error.as_bytes()[at]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: what is no file ends at once, and a text in another encoding is named as such.
    #[test]
    fn only_text_files_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let refusal = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            read_text(&path, 20).map_err(|error| error.to_string())
        };
        assert_eq!(refusal("{\"μ\": 1}".as_bytes()).unwrap(), "{\"μ\": 1}");
        assert_eq!(refusal(&[b'x'; 20]).unwrap().len(), 20);
        assert!(refusal(&[b'x'; 21]).unwrap_err().contains("more than"));
        assert!(
            refusal(b"a\nMessung \xdc")
                .unwrap_err()
                .contains("line 2 has a byte 0xdc that is not UTF-8; save it as UTF-8")
        );
        for utf16 in [&b"\xff\xfe{\0}\0"[..], b"\xfe\xff\0{", b"{\0}\0", b"\0{\0}"] {
            assert!(refusal(utf16).unwrap_err().contains("UTF-16; save it as UTF-8"), "{utf16:?}");
        }
        assert!(read_text(folder.path(), 20).unwrap_err().to_string().contains("it is a folder"));
        assert!(read_text(Path::new("/dev/zero"), 20).unwrap_err().to_string().contains("a device"));
        let fifo = folder.path().join("fifo");
        assert!(std::process::Command::new("mkfifo").arg(&fifo).status().unwrap().success());
        assert!(read_text(&fifo, 20).unwrap_err().to_string().contains("a pipe"));
        // The size is that of what is read, also of a stream without an end.
        assert_eq!(bounded(std::io::repeat(b'x'), 20).unwrap_err().kind(), ErrorKind::FileTooLarge);
    }
}

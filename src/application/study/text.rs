//! The text of a study: from a file or from standard input.

use super::error::StudyError;
use super::source::SourceText;
use super::text_file::{bounded, read_text};
use serde_json::Value;
use std::path::Path;

/// The path that stands for standard input.
const FROM_STDIN: &str = "-";

/// The largest file \[byte\]. The points of the largest study take less.
const MOST_BYTES: u64 = 256_000_000;

/// What messages call standard input.
pub(super) const STDIN: &str = "<stdin>";

/// The text of a study as it was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudyText {
    /// The text, unchanged.
    pub text: String,
    /// What messages call its source: the file as given, or `<stdin>`.
    pub source_name: String,
}

impl StudyText {
    /// Reads a study file; `-` is standard input.
    ///
    /// # Errors
    /// [`StudyError::Read`].
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let (source_name, read) = if Self::is_stdin(path) {
            (STDIN.to_owned(), bounded(std::io::stdin(), MOST_BYTES))
        } else {
            (path.display().to_string(), read_text(path, MOST_BYTES))
        };
        match read {
            Ok(text) => Ok(Self { text, source_name }),
            Err(reason) => Err(StudyError::Read { file: source_name, reason }),
        }
    }

    /// Whether the path stands for standard input.
    pub fn is_stdin(path: &Path) -> bool {
        path.as_os_str() == FROM_STDIN
    }
}

/// The value of a JSON text with the freedoms of a study: comments and trailing commas. Names and types are not checked.
///
/// # Errors
/// [`StudyError::Syntax`], with `source_name` as the file.
pub fn json_value(text: &str, source_name: &str) -> Result<Value, StudyError> {
    let (value, _) = SourceText::read(text, source_name)?;
    Ok(value)
}

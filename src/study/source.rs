//! The text of a study file: turns field paths into positions and values for messages.

use super::error::Problem;
use super::json::TypeMismatch;
use super::locate::{FieldSpan, FieldSpans, Position, RepeatedKey, join};
use jsonc_parser::errors::ParseError;

/// Longer values are shortened in messages.
const SHOWN_CHARS: usize = 60;

/// Longer field paths, which no study has, are shortened in messages.
const LONGEST_FIELD: usize = 200;

/// A study's text with the location of every field.
#[derive(Debug, Clone)]
pub(super) struct SourceText {
    pub file: String,
    text: String,
    spans: FieldSpans,
}

impl SourceText {
    /// The text of `file`, which `serde_json` has accepted.
    ///
    /// # Errors
    /// Those of [`FieldSpans::of`].
    pub(super) fn new(text: &str, file: &str) -> Result<Self, ParseError> {
        Ok(Self { file: file.to_owned(), text: text.to_owned(), spans: FieldSpans::of(text)? })
    }

    /// Whether the file itself gives `field`.
    pub(super) fn gives(&self, field: &str) -> bool {
        self.spans.by_path.contains_key(field)
    }

    /// Where the key of `field` stands, if the file gives it.
    pub(super) fn key_position(&self, field: &str) -> Option<Position> {
        self.spans.by_path.get(field).map(|span| span.key)
    }

    /// A problem with the value of `field`.
    pub(super) fn problem(&self, field: &str, message: impl Into<String>) -> Problem {
        let span = self.spans.by_path.get(field);
        Problem {
            file: self.file.clone(),
            position: span.map(|span| span.value),
            field: match field.len() {
                0 => "the study".to_owned(),
                1..=LONGEST_FIELD => field.to_owned(),
                _ => shorten(field),
            },
            value: span.map(|span| self.value_text(span)),
            message: message.into(),
            help: Vec::new(),
        }
    }

    /// A problem with the name of `field`; its position is that of the key.
    pub(super) fn problem_with_name(&self, field: &str, message: impl Into<String>) -> Problem {
        Problem { position: self.key_position(field), ..self.problem(field, message) }
    }

    /// A problem with the type of a field; the path in `mismatch` is relative to `path`.
    pub(super) fn mismatch(&self, path: &str, mismatch: TypeMismatch) -> Problem {
        let field = match (path, mismatch.path.as_str()) {
            (path, "") => path.to_owned(),
            (path, below) => join(path, below),
        };
        let mut problem = if mismatch.is_name {
            self.problem_with_name(&field, mismatch.message)
        } else {
            self.problem(&field, mismatch.message)
        };
        problem.help.extend(mismatch.suggestion.map(|name| format!("did you mean `{name}`?")));
        problem
    }

    /// One problem for each key that an object repeats.
    pub(super) fn repeated_keys(&self) -> Vec<Problem> {
        let describe = |repeated: &RepeatedKey| {
            let first = self.key_position(&repeated.path);
            let first = first.map_or(String::new(), |key| format!(" (first at {key})"));
            Problem {
                position: Some(repeated.span.key),
                value: Some(self.value_text(&repeated.span)),
                ..self.problem(&repeated.path, format!("this key is given twice{first}; expected it once"))
            }
        };
        self.spans.repeated.iter().map(describe).collect()
    }

    fn value_text(&self, span: &FieldSpan) -> String {
        shorten(&self.text[span.bytes.clone()])
    }
}

/// The text on one line, cut after [`SHOWN_CHARS`].
pub(super) fn shorten(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= SHOWN_CHARS {
        return line;
    }
    let start: String = line.chars().take(SHOWN_CHARS).collect();
    format!("{start}…")
}

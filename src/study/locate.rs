//! Where each field stands in a JSON text, and which keys an object repeats.
//!
//! `serde_json` forgets positions once it has read a text, and of two equal keys it keeps the last. Messages need the
//! position of any field later on, and a repeated axis must not be lost silently. So `jsonc-parser` reads the text a
//! second time, with all its extensions of JSON switched off.

use jsonc_parser::ast::Value;
use jsonc_parser::common::Ranged;
use jsonc_parser::errors::ParseError;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::fmt;
use std::ops::Range;

/// Line and column of a character.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// Where one field stands.
#[derive(Debug, Clone)]
pub(super) struct FieldSpan {
    /// Start of the key, or of the value for an entry of a list.
    pub key: Position,
    /// Start of the value.
    pub value: Position,
    /// Bytes of the value.
    pub bytes: Range<usize>,
}

/// A key that its object already has.
#[derive(Debug, Clone)]
pub(super) struct RepeatedKey {
    pub path: String,
    pub span: FieldSpan,
}

/// All fields of a JSON text by their path (`scene.pin.size_m[0]`; the whole text has the empty path).
#[derive(Debug, Clone, Default)]
pub(super) struct FieldSpans {
    pub by_path: HashMap<String, FieldSpan>,
    pub repeated: Vec<RepeatedKey>,
}

impl FieldSpans {
    /// Locates the fields of a text that `serde_json` has accepted, which limits its nesting.
    ///
    /// # Errors
    /// If `jsonc-parser` does not take the text for JSON.
    pub(super) fn of(text: &str) -> Result<Self, ParseError> {
        let mut locator = Locator { cursor: Cursor::new(text), found: Self::default() };
        let parsed = parse_to_ast(text, &CollectOptions::default(), &STRICT_JSON)?;
        if let Some(value) = parsed.value {
            locator.visit(&value, "", None);
        }
        Ok(locator.found)
    }
}

const STRICT_JSON: ParseOptions = ParseOptions {
    allow_comments: false,
    allow_loose_object_property_names: false,
    allow_trailing_commas: false,
    allow_missing_commas: false,
    allow_single_quoted_strings: false,
    allow_hexadecimal_numbers: false,
    allow_unary_plus_numbers: false,
    allow_bare_decimal_point_numbers: false,
    allow_non_finite_numbers: false,
    allow_extended_string_escapes: false,
};

/// Fields with longer paths are not located. No study has them, and a text with a long key above many values would take
/// memory with the square of its length.
const LONGEST_PATH: usize = 200;

/// The path that `extend` makes of `path`, or `path` itself where it is too long already.
fn below(path: &str, extend: impl FnOnce() -> String) -> Cow<'_, str> {
    if path.len() > LONGEST_PATH { Cow::Borrowed(path) } else { Cow::Owned(extend()) }
}

/// Path of the field `key` of the object at `path`.
pub(super) fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

struct Locator<'t> {
    cursor: Cursor<'t>,
    found: FieldSpans,
}

impl Locator<'_> {
    /// Visits the value at `path` and all below it in the order of the text; `key` is the start of its key.
    fn visit(&mut self, value: &Value<'_>, path: &str, key: Option<Position>) -> FieldSpan {
        let start = self.cursor.advance_to(value.start());
        match value {
            Value::Object(object) => {
                let mut seen = HashSet::new();
                for property in &object.properties {
                    let key_start = self.cursor.advance_to(property.start());
                    // Decoded: "mu" and "m\u0075" are the same key.
                    let key = property.name.as_str();
                    let field = below(path, || join(path, key));
                    let span = self.visit(&property.value, &field, Some(key_start));
                    if !seen.insert(key) {
                        let path = field.chars().take(LONGEST_PATH).collect();
                        self.found.repeated.push(RepeatedKey { path, span });
                    }
                }
            }
            Value::Array(array) => {
                for (index, entry) in array.elements.iter().enumerate() {
                    self.visit(entry, &below(path, || format!("{path}[{index}]")), None);
                }
            }
            _ => {}
        }
        let span = FieldSpan { key: key.unwrap_or(start), value: start, bytes: value.start()..value.end() };
        if path.len() <= LONGEST_PATH {
            self.found.by_path.entry(path.to_owned()).or_insert_with(|| span.clone());
        }
        span
    }
}

/// Turns byte offsets that only grow into positions, so that a text of one long line is read once.
struct Cursor<'t> {
    text: &'t str,
    offset: usize,
    at: Position,
}

impl<'t> Cursor<'t> {
    fn new(text: &'t str) -> Self {
        Self { text, offset: 0, at: Position { line: 1, column: 1 } }
    }

    fn advance_to(&mut self, offset: usize) -> Position {
        for c in self.text[self.offset..offset].chars() {
            if c == '\n' {
                self.at = Position { line: self.at.line + 1, column: 1 };
            } else {
                self.at.column += 1;
            }
        }
        self.offset = offset;
        self.at
    }
}

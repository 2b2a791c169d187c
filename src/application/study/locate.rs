//! Reads the text of a study: its value, where each field stands in it, and which keys an object repeats.
//!
//! The text is JSON with comments (`//` and `/* */`) and trailing commas, as editors know it (JSONC). Messages need the
//! position of any field later on, and a repeated axis must not be lost silently. So `jsonc-parser` makes a tree with
//! positions, which becomes a value here. Numbers are read by `serde_json`, to the last bit.

use jsonc_parser::ast;
use jsonc_parser::common::Ranged;
use jsonc_parser::errors::ParseErrorKind;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use serde::Serialize;
use serde_json::{Map, Number, Value};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::fmt;
use std::ops::Range;

/// What is said of a number beyond the largest double.
pub(super) const TOO_LARGE: &str = "the number is too large for a double, which ends at 1.8e308";

/// Line and column of a character.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
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

/// A text that is not JSON: where reading stopped, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NotJson {
    pub position: Position,
    pub message: String,
}

/// All fields of a JSON text by their path (`scene.pin.size_m[0]`; the whole text has the empty path).
#[derive(Debug, Clone, Default)]
pub(super) struct FieldSpans {
    pub by_path: HashMap<String, FieldSpan>,
    pub repeated: Vec<RepeatedKey>,
}

/// The value of a text and the locations of its fields. Of two equal keys of an object the value has the last.
///
/// # Errors
/// If the text is not JSON with comments and trailing commas, or is nested more than [`DEEPEST`] deep.
pub(super) fn read(text: &str) -> Result<(Value, FieldSpans), NotJson> {
    let mut reader = Reader { text, cursor: Cursor::new(text), found: FieldSpans::default(), beyond: 0 };
    let parsed = parse_to_ast(text, &CollectOptions::default(), &JSON_WITH_COMMENTS)
        .map_err(|error| not_json(text, error.range().start, describe(error.kind())))?;
    let Some(tree) = parsed.value else { return Err(not_json(text, 0, "the text is empty".to_owned())) };
    let (value, _) = reader.visit(&tree, "", None, 0)?;
    Ok((value, reader.found))
}

fn not_json(text: &str, offset: usize, message: String) -> NotJson {
    NotJson { position: Cursor::new(text).advance_to(offset), message }
}

/// What is wrong, in the words of a study's author.
fn describe(kind: &ParseErrorKind) -> String {
    match kind {
        ParseErrorKind::UnterminatedObject => "no } closes this object".to_owned(),
        ParseErrorKind::UnterminatedArray => "no ] closes this list".to_owned(),
        ParseErrorKind::UnterminatedCommentBlock => "no */ closes this comment".to_owned(),
        ParseErrorKind::ExpectedComma => "expected a comma".to_owned(),
        ParseErrorKind::ExpectedStringObjectProperty => "expected a name in double quotes".to_owned(),
        ParseErrorKind::SingleQuotedStringsNotAllowed => "expected double quotes".to_owned(),
        ParseErrorKind::MultipleRootJsonValues => "expected nothing after the end of the study".to_owned(),
        kind => {
            let text = kind.to_string();
            let mut chars = text.chars();
            chars.next().map_or_else(String::new, |first| first.to_lowercase().chain(chars).collect())
        }
    }
}

const JSON_WITH_COMMENTS: ParseOptions = ParseOptions {
    allow_comments: true,
    allow_loose_object_property_names: false,
    allow_trailing_commas: true,
    allow_missing_commas: false,
    allow_single_quoted_strings: false,
    allow_hexadecimal_numbers: false,
    allow_unary_plus_numbers: false,
    allow_bare_decimal_point_numbers: false,
    allow_non_finite_numbers: false,
    allow_extended_string_escapes: false,
};

/// The deepest nesting of a text. Values of a deeper one could exhaust the stack.
const DEEPEST: usize = 128;

/// Entries of lists are located as long as so few fields are.
const MOST_LOCATED: usize = 200_000;

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

struct Reader<'t> {
    text: &'t str,
    cursor: Cursor<'t>,
    found: FieldSpans,
    /// How many of the lists around are at entries that are not located.
    beyond: usize,
}

impl Reader<'_> {
    /// Visits the value at `path` and all below it in the order of the text; `key` is the start of its key.
    fn visit(
        &mut self,
        tree: &ast::Value<'_>,
        path: &str,
        key: Option<Position>,
        depth: usize,
    ) -> Result<(Value, FieldSpan), NotJson> {
        let start = self.cursor.advance_to(tree.start());
        let refuse = |message: String| Err(NotJson { position: start, message });
        let value = match tree {
            ast::Value::Object(_) | ast::Value::Array(_) if depth == DEEPEST => {
                return refuse(format!("nested more than {DEEPEST} deep"));
            }
            ast::Value::Object(object) => {
                let mut seen = HashSet::new();
                let mut fields = Map::new();
                for property in &object.properties {
                    let key_start = self.cursor.advance_to(property.start());
                    // Decoded: "mu" and "m\u0075" are the same key.
                    let key = property.name.as_str();
                    let field = below(path, || join(path, key));
                    let (value, span) = self.visit(&property.value, &field, Some(key_start), depth + 1)?;
                    if !seen.insert(key) {
                        let path = field.chars().take(LONGEST_PATH).collect();
                        self.found.repeated.push(RepeatedKey { path, span });
                    }
                    fields.insert(key.to_owned(), value);
                }
                Value::Object(fields)
            }
            ast::Value::Array(array) => {
                let mut entries = Vec::with_capacity(array.elements.len());
                for (index, entry) in array.elements.iter().enumerate() {
                    // The places of entries are for messages, and nobody looks for the millionth one.
                    let is_beyond = self.found.by_path.len() >= MOST_LOCATED;
                    let path = if is_beyond {
                        Cow::Borrowed(path)
                    } else {
                        below(path, || format!("{path}[{index}]"))
                    };
                    self.beyond += usize::from(is_beyond);
                    entries.push(self.visit(entry, &path, None, depth + 1)?.0);
                    self.beyond -= usize::from(is_beyond);
                }
                Value::Array(entries)
            }
            ast::Value::NumberLit(number) => match number.value.parse::<Number>() {
                Ok(number) => Value::Number(number),
                Err(error) => {
                    let text = error.to_string();
                    let message = without_place(&text);
                    let is_large = message == "number out of range";
                    return refuse(if is_large { TOO_LARGE } else { message }.to_owned());
                }
            },
            // Other programs that read JSON refuse such a text.
            ast::Value::StringLit(string)
                if self.text[string.start()..string.end()].contains(char::is_control) =>
            {
                return refuse(
                    "expected a string without line breaks, tabs and other control characters".to_owned(),
                );
            }
            ast::Value::StringLit(string) => Value::from(string.value.as_ref()),
            ast::Value::BooleanLit(flag) => Value::Bool(flag.value),
            ast::Value::NullKeyword(_) => Value::Null,
        };
        let span = FieldSpan { key: key.unwrap_or(start), value: start, bytes: tree.start()..tree.end() };
        if self.beyond == 0 && path.len() <= LONGEST_PATH && !self.found.by_path.contains_key(path) {
            self.found.by_path.insert(path.to_owned(), span.clone());
        }
        Ok((value, span))
    }
}

/// A message of `serde_json` about a single number, without its position in that number.
fn without_place(message: &str) -> &str {
    message.rsplit_once(" at line ").map_or(message, |(message, _)| message)
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

//! Where each field stands in a JSON text, and which keys an object repeats.
//!
//! `serde_json` knows positions only while it reads and lets the last of two equal keys win; a
//! message needs the position of any field later on, and a repeated axis must not vanish.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::fmt;
use std::ops::Range;

/// Line and column (in characters), both from 1.
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

/// One field: where its key (or, in a list, its value) and its value begin, and the value's text.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub key: Position,
    pub value: Position,
    pub span: Range<usize>,
}

/// A key that its object already has.
#[derive(Debug, Clone)]
pub(super) struct Repeated {
    pub path: String,
    pub place: Place,
}

/// All fields of a JSON text by their path (`scene.pin.size_m[0]`; the whole text is the empty path).
#[derive(Debug, Clone, Default)]
pub(super) struct Places {
    pub by_path: HashMap<String, Place>,
    pub repeated: Vec<Repeated>,
}

impl Places {
    /// Scans a text that `serde_json` has accepted, which bounds its nesting and lets the scan trust its form.
    pub(super) fn of_valid_json(text: &str) -> Self {
        let mut scanner =
            Scanner { text, offset: 0, at: Position { line: 1, column: 1 }, found: Self::default() };
        scanner.value("", None);
        scanner.found
    }
}

/// Fields with longer paths have no place of their own: no study has them, and a text with a long key over many
/// values would take memory with the square of its length.
const LONGEST_PATH: usize = 200;

/// The path that `extend` makes of `path`, or `path` itself where it is too long already.
fn below(path: &str, extend: impl FnOnce() -> String) -> Cow<'_, str> {
    if path.len() > LONGEST_PATH { Cow::Borrowed(path) } else { Cow::Owned(extend()) }
}

/// Path of the field `key` of the object at `path`.
pub(super) fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

struct Scanner<'t> {
    text: &'t str,
    offset: usize,
    at: Position,
    found: Places,
}

impl Scanner<'_> {
    fn peek(&self) -> Option<char> {
        self.text[self.offset..].chars().next()
    }

    fn advance(&mut self) {
        let Some(c) = self.peek() else { return };
        self.offset += c.len_utf8();
        if c == '\n' {
            self.at = Position { line: self.at.line + 1, column: 1 };
        } else {
            self.at.column += 1;
        }
    }

    fn skip_while(&mut self, skipped: impl Fn(char) -> bool) {
        while self.peek().is_some_and(&skipped) {
            self.advance();
        }
    }

    fn skip_space(&mut self) {
        self.skip_while(|c| c.is_ascii_whitespace());
    }

    /// Scans the value at `path`; `key` is where its key begins, `None` in a list.
    fn value(&mut self, path: &str, key: Option<Position>) -> Place {
        self.skip_space();
        let (value, start) = (self.at, self.offset);
        match self.peek() {
            Some('{') => self.object(path),
            Some('[') => self.list(path),
            Some('"') => self.string(),
            _ => self.skip_while(|c| !",]}".contains(c) && !c.is_ascii_whitespace()),
        }
        let place = Place { key: key.unwrap_or(value), value, span: start..self.offset };
        if path.len() <= LONGEST_PATH {
            self.found.by_path.entry(path.to_owned()).or_insert_with(|| place.clone());
        }
        place
    }

    fn object(&mut self, path: &str) {
        let mut seen = HashSet::new();
        self.advance();
        loop {
            self.skip_while(|c| c == ',' || c.is_ascii_whitespace());
            if self.peek() != Some('"') {
                break self.advance();
            }
            let (key_at, start) = (self.at, self.offset);
            self.string();
            // Decoded, because "mu" and "m\u0075" are the same key.
            let key: String = serde_json::from_str(&self.text[start..self.offset]).unwrap_or_default();
            self.skip_while(|c| c == ':' || c.is_ascii_whitespace());
            let field = below(path, || join(path, &key));
            let place = self.value(&field, Some(key_at));
            if !seen.insert(key) {
                let path = field.chars().take(LONGEST_PATH).collect();
                self.found.repeated.push(Repeated { path, place });
            }
        }
    }

    fn list(&mut self, path: &str) {
        self.advance();
        for index in 0.. {
            self.skip_while(|c| c == ',' || c.is_ascii_whitespace());
            if matches!(self.peek(), Some(']') | None) {
                break;
            }
            self.value(&below(path, || format!("{path}[{index}]")), None);
        }
        self.advance();
    }

    fn string(&mut self) {
        self.advance();
        while let Some(c) = self.peek() {
            self.advance();
            match c {
                '\\' => self.advance(),
                '"' => break,
                _ => {}
            }
        }
    }
}

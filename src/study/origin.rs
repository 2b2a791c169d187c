//! The text a study came from: turns field paths into positions and values for messages.

use super::error::Problem;
use super::json::Mismatch;
use super::locate::{Place, Places, Repeated, join};

/// Longer values are cut in messages.
const SHOWN_CHARS: usize = 60;

/// Longer fields, which no study has, are cut in messages.
const LONGEST_FIELD: usize = 200;

/// A study's text with the place of every field.
#[derive(Debug, Clone)]
pub(super) struct Origin {
    pub file: String,
    text: String,
    pub places: Places,
}

impl Origin {
    /// `text` must be valid JSON.
    pub(super) fn new(text: &str, file: &str) -> Self {
        Self { file: file.to_owned(), text: text.to_owned(), places: Places::of_valid_json(text) }
    }

    /// A problem with the value of `field`.
    pub(super) fn problem(&self, field: &str, message: impl Into<String>) -> Problem {
        let place = self.places.by_path.get(field);
        Problem {
            file: self.file.clone(),
            position: place.map(|place| place.value),
            field: match field.len() {
                0 => "the study".to_owned(),
                1..=LONGEST_FIELD => field.to_owned(),
                _ => shorten(field),
            },
            value: place.map(|place| self.value_text(place)),
            message: message.into(),
            help: Vec::new(),
        }
    }

    /// A problem with the name of `field`, which stands at the key.
    pub(super) fn problem_with_name(&self, field: &str, message: impl Into<String>) -> Problem {
        let key = self.places.by_path.get(field).map(|place| place.key);
        Problem { position: key, ..self.problem(field, message) }
    }

    /// A problem with the type of the field that `mismatch` names below `path`.
    pub(super) fn mismatch(&self, path: &str, mismatch: Mismatch) -> Problem {
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
        let describe = |repeated: &Repeated| {
            let first = self.places.by_path.get(&repeated.path);
            let first = first.map_or(String::new(), |place| format!(" (first at {})", place.key));
            Problem {
                position: Some(repeated.place.key),
                value: Some(self.value_text(&repeated.place)),
                ..self.problem(&repeated.path, format!("this key is given twice{first}; expected it once"))
            }
        };
        self.places.repeated.iter().map(describe).collect()
    }

    fn value_text(&self, place: &Place) -> String {
        shorten(&self.text[place.span.clone()])
    }
}

/// On one line and not too long.
pub(super) fn shorten(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= SHOWN_CHARS {
        return line;
    }
    let start: String = line.chars().take(SHOWN_CHARS).collect();
    format!("{start}…")
}

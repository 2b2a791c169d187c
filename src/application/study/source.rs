//! The text of a study file: turns field paths into positions and values for messages.

use super::error::{Problem, StudyError};
use super::json::{NUMBER, TypeMismatch, number_hint};
use super::locate::{self, FieldSpan, FieldSpans, NotJson, Position, RepeatedKey, join};
use super::parameter::Parameter;
use super::suggest::question;
use serde_json::Value;

/// Longer values are shortened in messages.
const SHOWN_CHARS: usize = 60;

/// Longer field paths, which no study has, are shortened in messages.
const LONGEST_FIELD: usize = 200;

/// A study's text with the location of every field.
#[derive(Debug, Clone)]
pub(super) struct SourceText {
    pub file: String,
    pub text: String,
    spans: FieldSpans,
    /// What the command line has changed of it.
    pub changes: Vec<Change>,
}

/// The fields of a study file that let it grow. A study has at most one of them.
pub(super) const GROWTH: [&str; 3] = ["refine", "continue", "calibrate"];

/// One value that the command line sets.
#[derive(Debug, Clone)]
pub(super) struct Change {
    /// Stands for the file in messages.
    place: String,
    /// The fields that have their value from it.
    fields: Vec<String>,
    /// The value as given.
    text: String,
}

impl Change {
    /// A value of a parameter, for its field or its axis. The fields of the parameters that it sets aside have their values
    /// from it too.
    pub(super) fn of_parameter(parameter: &Parameter, place: &str, text: &str) -> Self {
        let mut fields: Vec<String> = parameter.displaces().map(Parameter::field).collect();
        fields.extend([parameter.field(), format!("grid.{}", parameter.name)]);
        Self { place: place.to_owned(), fields, text: text.to_owned() }
    }

    /// The study's name.
    pub(super) fn of_name(place: &str, text: &str) -> Self {
        Self { place: place.to_owned(), fields: vec!["name".to_owned()], text: text.to_owned() }
    }

    /// What the study says about further jobs.
    pub(super) fn of_growth(place: &str, text: &str) -> Self {
        let fields = GROWTH.map(str::to_owned).to_vec();
        Self { place: place.to_owned(), fields, text: text.to_owned() }
    }

    fn covers(&self, path: &str) -> bool {
        let is_within = |field: &String| {
            path.strip_prefix(field).is_some_and(|rest| rest.is_empty() || rest.starts_with(['[', '.']))
        };
        self.fields.iter().any(is_within)
    }
}

impl Problem {
    /// A problem with a value that the command line sets at `place`.
    pub(super) fn of_change(place: &str, field: &str, text: &str, message: impl Into<String>) -> Self {
        Self {
            file: place.to_owned(),
            position: None,
            field: field.to_owned(),
            value: Some(shorten(text)),
            message: message.into(),
            help: Vec::new(),
        }
    }
}

impl SourceText {
    /// Reads the text of `file`. Also returns its value.
    ///
    /// # Errors
    /// [`StudyError::Syntax`] if the text is not JSON; comments and trailing commas are allowed.
    pub(super) fn read(text: &str, file: &str) -> Result<(Value, Self), StudyError> {
        // Some editors begin a file with a byte order mark, which is not a part of the text.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let (value, spans) = locate::read(text).map_err(|NotJson { position, message }| {
            let message = message + &syntax_hint(text, file, position);
            StudyError::Syntax { file: file.to_owned(), position, message }
        })?;
        Ok((value, Self { file: file.to_owned(), text: text.to_owned(), spans, changes: Vec::new() }))
    }

    /// Whether the file or the command line gives `field`.
    pub(super) fn gives(&self, field: &str) -> bool {
        self.spans.by_path.contains_key(field) || self.changes.iter().any(|change| change.covers(field))
    }

    /// Where the key of `field` stands, if the file gives it.
    pub(super) fn key_position(&self, field: &str) -> Option<Position> {
        self.spans.by_path.get(field).map(|span| span.key)
    }

    /// The text with another value of `field`, if the text gives that field.
    pub(super) fn with_value(&self, field: &str, value: &Value) -> Option<String> {
        let span = self.spans.by_path.get(field)?;
        let mut text = self.text.clone();
        text.replace_range(span.bytes.clone(), &value.to_string());
        Some(text)
    }

    /// This text with places in messages as they are in `original`, from which it differs by the value of some fields.
    pub(super) fn at_places_of(mut self, original: &Self) -> Self {
        let spans = &original.spans;
        for (path, span) in &mut self.spans.by_path {
            if let Some(place) = spans.by_path.get(path) {
                (span.key, span.value) = (place.key, place.value);
            }
        }
        self
    }

    /// A problem with the value of `field`.
    pub(super) fn problem(&self, field: &str, message: impl Into<String>) -> Problem {
        // The latest change is the one that has an effect.
        if let Some(change) = self.changes.iter().rev().find(|change| change.covers(field)) {
            return Problem::of_change(&change.place, field, &change.text, message);
        }
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
        let problem = self.problem(field, message);
        Problem { position: problem.position.and_then(|_| self.key_position(field)), ..problem }
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
        let of_parameter = Some(&field).filter(|_| mismatch.is_name).and_then(|field| meant_field(field));
        let own = field.rsplit('.').next().unwrap_or(&field);
        problem.help.extend(of_parameter.or(mismatch.suggestion).map(|name| question(own, &name)));
        if problem.message == NUMBER {
            // The value as the file has it, in quotes.
            let text = problem.value.as_deref().and_then(|value| serde_json::from_str::<String>(value).ok());
            problem.help.extend(text.as_deref().and_then(number_hint));
        }
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

/// The field of a parameter whose own name stands for it, in the object to which it belongs: `force_n` for `scene.load.load_n`.
fn meant_field(field: &str) -> Option<String> {
    let (object, name) = field.rsplit_once('.')?;
    let meant = Parameter::find(name)?.field();
    let (of_meant, meant) = meant.rsplit_once('.')?;
    (of_meant == object).then(|| meant.to_owned())
}

/// What to do about a text that is not JSON, as lines of help; empty if nothing is known.
fn syntax_hint(text: &str, file: &str, position: Position) -> String {
    let ends_with = |ending: &str| file.to_ascii_lowercase().ends_with(ending);
    let start = text.trim_start();
    let hint = if [".yaml", ".yml", ".toml"].into_iter().any(ends_with) {
        "a study is JSON, { \"name\": value, … }, and no YAML or TOML"
    } else if !start.is_empty() && !start.starts_with(['{', '[', '/', '"']) {
        "a study is a JSON object: { \"scene\": { … }, \"grid\": { … } }"
    } else {
        let line = text.lines().nth(position.line - 1).unwrap_or_default();
        let before: Vec<char> = line.chars().take(position.column - 1).collect();
        let after: String = line.chars().skip(position.column - 1).take_while(char::is_ascii_digit).collect();
        if let [.., digit, ','] = before[..]
            && digit.is_ascii_digit()
            && !after.is_empty()
        {
            let whole: Vec<char> =
                before[..before.len() - 1].iter().rev().take_while(|c| c.is_ascii_digit()).copied().collect();
            let whole: String = whole.into_iter().rev().collect();
            return format!("\n  help: a number has a decimal point: {whole}.{after}, not {whole},{after}");
        }
        return String::new();
    };
    format!("\n  help: {hint}")
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

//! The names of studies.

use super::source::SourceText;
use serde_json::Value;

/// What a study's name looks like, for messages.
pub(super) const EXPECTED: &str = "expected a name of letters A-Z a-z, digits, _ and -";

/// Whether a study can have this name: `[A-Za-z0-9_-]+`.
pub fn is_study_name(name: &str) -> bool {
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    !name.is_empty() && name.chars().all(allowed)
}

/// The text of a study with another name in its field `name`; everything else stays as its author wrote it. A text
/// without that field is returned unchanged, because such a study takes its name from elsewhere.
pub fn renamed(text: &str, name: &str) -> String {
    let source = SourceText::read(text, "");
    let edited = source.ok().and_then(|(_, source)| source.with_value("name", &Value::from(name)));
    edited.unwrap_or_else(|| text.to_owned())
}

//! The names of studies.

use super::source::SourceText;
use serde_json::Value;

/// What a study's name looks like, for messages.
pub(super) const EXPECTED: &str = "expected a name of letters A-Z a-z, digits, _ and -";

/// The longest name of a new study. Folders and files are called by it, with some letters more, and a file's name has 255 bytes.
const LONGEST: usize = 200;

/// Whether a study can have this name: `[A-Za-z0-9_-]+`.
pub fn is_study_name(name: &str) -> bool {
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    !name.is_empty() && name.chars().all(allowed)
}

/// Why a new study cannot have this name; none if it can. Studies in databases may have names that are refused here, because older
/// versions took them.
pub fn refused_name(name: &str) -> Option<String> {
    if !is_study_name(name) {
        return Some(EXPECTED.to_owned());
    }
    if name.len() > LONGEST {
        let length = name.len();
        return Some(format!(
            "{length} letters; expected at most {LONGEST}, because folders and files have the name"
        ));
    }
    if name.starts_with('-') {
        return Some("expected a name that does not begin with -, as options do".to_owned());
    }
    is_device(name).then(|| "expected another name: on Windows this one is a device and no folder".to_owned())
}

/// Whether Windows takes the name for a device.
fn is_device(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let numbered = |port: &str| matches!(name.strip_prefix(port).map(str::as_bytes), Some([b'1'..=b'9']));
    matches!(name.as_str(), "con" | "prn" | "aux" | "nul") || numbered("com") || numbered("lpt")
}

/// A name that a study can have and that reads like `wrong`: `my-study` for `my study`.
pub(super) fn similar_name(wrong: &str) -> Option<String> {
    let mut name = String::new();
    for c in wrong.chars() {
        match c {
            'ä' => name.push_str("ae"),
            'ö' => name.push_str("oe"),
            'ü' => name.push_str("ue"),
            'Ä' => name.push_str("Ae"),
            'Ö' => name.push_str("Oe"),
            'Ü' => name.push_str("Ue"),
            'ß' => name.push_str("ss"),
            'à' | 'á' | 'â' | 'å' | 'ã' => name.push('a'),
            'è' | 'é' | 'ê' | 'ë' => name.push('e'),
            'ì' | 'í' | 'î' | 'ï' => name.push('i'),
            'ò' | 'ó' | 'ô' | 'õ' | 'ø' => name.push('o'),
            'ù' | 'ú' | 'û' => name.push('u'),
            'ç' => name.push('c'),
            'ñ' => name.push('n'),
            'μ' | 'µ' => name.push_str("mu"),
            c if is_study_name(c.encode_utf8(&mut [0; 4])) => name.push(c),
            _ if name.ends_with('-') => {}
            _ => name.push('-'),
        }
    }
    let name: String = name.trim_matches('-').chars().take(LONGEST).collect();
    let name = if is_device(&name) { format!("{name}-study") } else { name };
    refused_name(&name).is_none().then_some(name)
}

/// The text of a study with another name in its field `name`; everything else stays as its author wrote it. A text
/// without that field is returned unchanged, because such a study takes its name from elsewhere.
pub fn renamed(text: &str, name: &str) -> String {
    let source = SourceText::read(text, "");
    let edited = source.ok().and_then(|(_, source)| source.with_value("name", &Value::from(name)));
    edited.unwrap_or_else(|| text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a name that a folder, a command line or another system cannot have is refused before any job runs, and a name
    /// that reads alike is offered.
    #[test]
    fn names_that_make_trouble_are_refused() {
        for good in ["a", "figure7", "A_b-1", "console", "com10", &"x".repeat(LONGEST)] {
            assert_eq!(refused_name(good), None, "{good}");
        }
        for bad in ["", "a b", "Ü", "-rf", "con", "NUL", "Lpt9", "../x", &"x".repeat(LONGEST + 1)] {
            assert!(refused_name(bad).is_some(), "{bad}");
        }
        for (wrong, offered) in [
            ("my study", Some("my-study")),
            ("Messung Ü", Some("Messung-Ue")),
            ("-rf", Some("rf")),
            ("con", Some("con-study")),
            ("μ*: 1. Versuch ", Some("mu-1-Versuch")),
            ("測試", None),
            ("", None),
        ] {
            assert_eq!(similar_name(wrong).as_deref(), offered, "{wrong:?}");
        }
    }
}

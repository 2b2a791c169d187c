//! Text of strangers for a terminal.

use std::borrow::Cow;

/// Whether a terminal may do something else with the character than show it: control characters, which begin escape sequences,
/// and those that change the direction of text or break lines.
fn is_unsafe(c: char) -> bool {
    let turns_text =
        matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns_text || matches!(c, '\u{2028}' | '\u{2029}' | '\u{feff}')
}

/// The text on one line, in which characters that a terminal would obey are written as `\u{1b}`.
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, is_unsafe)
}

/// As [`printable`], for a text of several lines, which keep their breaks and tabs.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |c| is_unsafe(c) && !matches!(c, '\n' | '\t'))
}

fn escaped(text: &str, is_unsafe: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&is_unsafe) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_unsafe(c) { escaped.extend(c.escape_unicode()) } else { escaped.push(c) }
    }
    Cow::Owned(escaped)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: no escape sequence and no change of direction reaches a terminal, and other text is not changed.
    #[test]
    fn nothing_is_left_that_a_terminal_obeys() {
        assert_eq!(printable("\u{1b}]0;owned\u{7}mu"), "\\u{1b}]0;owned\\u{7}mu");
        assert_eq!(printable("a\u{202e}b\u{9b}31m\nc"), "a\\u{202e}b\\u{9b}31m\\u{a}c");
        assert_eq!(printable_lines("a\r\n\tb\u{2066}"), "a\\u{d}\n\tb\\u{2066}");
        for plain in ["μ* = 0.3 ± 0.1 °", "häßlich 測試"] {
            assert!(matches!(printable(plain), Cow::Borrowed(text) if text == plain));
        }
    }
}

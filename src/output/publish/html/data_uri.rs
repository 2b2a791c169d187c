//! Files inside of links.

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};

/// What is coded in a link: all bytes but letters, digits and the other characters of numbers and names.
const CODED: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'_')
    .remove(b'.')
    .remove(b'~')
    .remove(b',')
    .remove(b':')
    .remove(b'*')
    .remove(b'/');

/// The address of a link that holds a CSV file.
///
/// Base64 would be shorter for text in which most characters have to be coded. In tables of numbers only the line
/// breaks are.
pub(super) fn csv(text: &str) -> String {
    format!("data:text/csv;charset=utf-8,{}", utf8_percent_encode(text, CODED))
}

/// What is coded in the path of a file: all bytes but letters, digits and these.
const CODED_IN_PATHS: &AsciiSet =
    &NON_ALPHANUMERIC.remove(b'-').remove(b'_').remove(b'.').remove(b'~').remove(b'/');

/// The address of a file beside a page, from its relative path.
pub(super) fn of_path(path: &str) -> String {
    utf8_percent_encode(path, CODED_IN_PATHS).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: numbers stay readable, and no character can end the attribute or the address.
    #[test]
    fn separators_and_markup_are_coded() {
        assert_eq!(csv("a,b\n1.5,μ \"<#"), "data:text/csv;charset=utf-8,a,b%0A1.5,%CE%BC%20%22%3C%23");
    }
}

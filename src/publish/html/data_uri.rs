//! Files inside of links.

/// A CSV file as a link's address.
///
/// What is not plain is written by its bytes. Base64 would be shorter for text in which most characters are not plain;
/// in numbers all are but the separators.
pub(super) fn csv(text: &str) -> String {
    let mut uri = String::with_capacity(text.len() + text.len() / 4 + 32);
    uri.push_str("data:text/csv;charset=utf-8,");
    for &byte in text.as_bytes() {
        if byte.is_ascii_alphanumeric() || b"-_.~,:*/".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            const DIGITS: &[u8; 16] = b"0123456789ABCDEF";
            uri.push('%');
            uri.push(char::from(DIGITS[usize::from(byte >> 4)]));
            uri.push(char::from(DIGITS[usize::from(byte & 15)]));
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: numbers stay readable, and nothing can end the attribute or the address.
    #[test]
    fn separators_and_markup_are_coded() {
        assert_eq!(csv("a,b\n1.5,μ \"<#"), "data:text/csv;charset=utf-8,a,b%0A1.5,%CE%BC%20%22%3C%23");
    }
}

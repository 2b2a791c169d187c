//! Lines of text in columns.

use std::fmt::Write;

/// The narrowest last column: below it, lines are not broken.
const NARROWEST: usize = 24;

/// Lines whose cells stand below each other, indented by `indent`. On a terminal of `width` characters the last cells are
/// broken between words.
pub(crate) fn lines<const N: usize>(indent: usize, cells: &[[String; N]], width: Option<usize>) -> String {
    let mut text = String::new();
    let mut start = indent;
    let widths: [usize; N] = std::array::from_fn(|column| {
        cells.iter().map(|line| line[column].chars().count()).max().unwrap_or_default()
    });
    start += widths[..N - 1].iter().map(|width| width + 2).sum::<usize>();
    for line in cells {
        let mut written = " ".repeat(indent);
        for (cell, width) in line[..N - 1].iter().zip(widths) {
            let _ = write!(written, "{cell:<width$}  ");
        }
        match width.map(|width| width.saturating_sub(start)).filter(|width| *width >= NARROWEST) {
            None => written.push_str(&line[N - 1]),
            Some(width) => {
                let mut left = width;
                for (number, word) in line[N - 1].split(' ').enumerate() {
                    let length = word.chars().count();
                    if number > 0 && length + 1 > left {
                        let _ = write!(written, "\n{}", " ".repeat(start));
                        left = width;
                    } else if number > 0 {
                        written.push(' ');
                        left -= 1;
                    }
                    written.push_str(word);
                    left = left.saturating_sub(length);
                }
            }
        }
        let _ = writeln!(text, "{}", written.trim_end());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: cells stand below each other; long ones are broken between words within the terminal and keep all words.
    #[test]
    fn cells_are_aligned_and_broken() {
        let cell = |text: &str| text.to_owned();
        let long = "one two three four five six seven eight";
        let cells = [[cell("μ"), cell("0.4"), cell(long)], [cell("load"), cell("30 N"), cell("")]];
        let text = lines(1, &cells, None);
        assert_eq!(text, format!(" μ     0.4   {long}\n load  30 N\n"));
        let text = lines(1, &cells, Some(40));
        let expected = " μ     0.4   one two three four five six\n             seven eight\n load  30 N\n";
        assert_eq!(text, expected);
        assert!(text.lines().all(|line| line.chars().count() <= 40), "{text}");
        assert_eq!(lines(1, &cells, Some(30)).lines().count(), 2, "too narrow to break");
    }
}

//! Markdown that is readable as plain text too.

/// A table whose columns are padded to equal width.
pub(super) fn table(header: &[String], lines: &[Vec<String>], right_aligned: bool) -> String {
    let header: Vec<String> = header.iter().map(|cell| escape(cell)).collect();
    let lines: Vec<Vec<String>> =
        lines.iter().map(|line| line.iter().map(|cell| escape(cell)).collect()).collect();
    let widths: Vec<usize> = (0..header.len())
        .map(|column| {
            let cells = std::iter::once(&header).chain(&lines).map(|line| line[column].chars().count());
            // `---:` is the shortest rule that states an alignment.
            cells.max().unwrap_or(0).max(4)
        })
        .collect();
    let pad = |cell: &String, width: usize| {
        if right_aligned { format!(" {cell:>width$} |") } else { format!(" {cell:<width$} |") }
    };
    let write_line = |line: &Vec<String>| {
        let cells: String = line.iter().zip(&widths).map(|(cell, &width)| pad(cell, width)).collect();
        format!("|{cells}\n")
    };
    let rule: String = widths
        .iter()
        .map(|&width| {
            let dashes = "-".repeat(width - 1);
            if right_aligned { format!(" {dashes}: |") } else { format!(" :{dashes} |") }
        })
        .collect();
    let body: String = lines.iter().map(write_line).collect();
    format!("{}|{rule}\n{body}", write_line(&header))
}

/// Text on one line, escaped for a table or a heading.
pub(super) fn escape(text: &str) -> String {
    // Large tables consist of numbers mostly: this is the fast path for them.
    if text.bytes().all(|c| c.is_ascii_alphanumeric() || matches!(c, b'.' | b'_' | b'~' | b'-')) {
        return text.to_owned();
    }
    one_line(text)
        .replace('\\', "\\\\")
        .replace('|', "\\|")
        .replace('<', "&lt;")
        .replace('*', "\\*")
        .replace('`', "\\`")
}

/// Text as a span of code.
pub(super) fn code(text: &str) -> String {
    format!("`{}`", one_line(text).replace('`', "'"))
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

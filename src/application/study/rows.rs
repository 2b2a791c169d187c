//! Text files of numbers in rows.

/// What the numbers of a file are.
#[derive(Debug)]
pub(super) struct Entry {
    /// One of them in a message.
    pub one: &'static str,
    /// Several of them in a message.
    pub plural: &'static str,
    /// What a number that cannot be read should be.
    pub expected: &'static str,
    /// Most numbers of a file.
    pub most: usize,
    /// Whether it is a table as spreadsheets write it: the first line may have the names of the columns, and where semicolons separate,
    /// numbers may have a decimal comma.
    pub is_table: bool,
}

/// The numbers of a text, a row for each line. Empty lines and lines that begin with `#` are passed over. The error is a line and
/// what is wrong with it.
pub(super) fn rows(text: &str, entry: &Entry) -> Result<Vec<Vec<f64>>, (usize, String)> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut last = 0;
    let mut may_be_names = entry.is_table;
    for (index, line) in text.lines().enumerate() {
        let (number, line) = (index + 1, line.trim());
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let entries = entries(line, entry);
        if std::mem::take(&mut may_be_names)
            && entries.iter().all(|text| text.replace(',', ".").parse::<f64>().is_err())
        {
            continue;
        }
        let row = row(&entries, entry).map_err(|message| (number, message))?;
        if let Some(first) = rows.first()
            && first.len() != row.len()
        {
            let message =
                format!("{} {}: expected {}, as in the lines before", row.len(), entry.plural, first.len());
            return Err((number, message));
        }
        if row.len() < 2 {
            return Err((number, format!("1 {}: expected at least 2 in a row", entry.one)));
        }
        if (rows.len() + 1) * row.len() > entry.most {
            return Err((number, format!("more than {} {}; resample them", entry.most, entry.plural)));
        }
        rows.push(row);
        last = number;
    }
    if rows.len() < 2 {
        return Err((last.max(1), format!("{} rows of {}: expected at least 2", rows.len(), entry.plural)));
    }
    Ok(rows)
}

/// The entries of a line. Many programs end each line with a separator.
fn entries<'a>(line: &'a str, entry: &Entry) -> Vec<&'a str> {
    let separators: &[char] = if entry.is_table && line.contains(';') { &[';'] } else { &[',', ';'] };
    if line.contains(separators) {
        line.trim_end_matches(separators).split(separators).map(str::trim).collect()
    } else {
        line.split_whitespace().collect()
    }
}

/// A number, which may have a decimal comma.
fn finite(text: &str) -> Option<f64> {
    text.replace(',', ".").parse().ok().filter(|number: &f64| number.is_finite())
}

fn row(entries: &[&str], entry: &Entry) -> Result<Vec<f64>, String> {
    let number = |(at, text): (usize, &&str)| {
        let refused =
            || format!("`{}` at place {}: expected {}", super::source::shorten(text), at + 1, entry.expected);
        finite(text).ok_or_else(refused)
    };
    entries.iter().enumerate().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEIGHT: Entry = Entry {
        one: "height",
        plural: "heights",
        expected: "a height in metres",
        most: 65_536,
        is_table: false,
    };

    /// Protects: every way to separate numbers, and that a bad line is named.
    #[test]
    fn rows_are_read_or_their_line_is_named() {
        let good = [
            "1e-6, 2e-6,3e-6\n4e-6,5e-6,6e-6\n",
            "# heights\r\n1e-6 2e-6\t3e-6\r\n\r\n 4e-6 5e-6 6e-6",
            "\u{feff}1e-6;2e-6;3e-6;\n4e-6; 5e-6; 6e-6;",
        ];
        for text in good {
            assert_eq!(rows(text, &HEIGHT).unwrap(), [[1e-6, 2e-6, 3e-6], [4e-6, 5e-6, 6e-6]], "{text:?}");
        }
        for (text, line, part) in [
            ("1,2\n3,4,5", 2, "3 heights: expected 2"),
            ("1,2\n\n3,NaN", 3, "`NaN` at place 2"),
            ("1,2\n3,inf", 2, "`inf`"),
            ("1,2\n3,,4", 2, "`` at place 2"),
            ("x y\n1 2", 1, "`x` at place 1"),
            ("1\n2", 1, "at least 2 in a row"),
            ("1 2\n", 1, "1 rows"),
            ("", 1, "0 rows"),
        ] {
            let (found, message) = rows(text, &HEIGHT).unwrap_err();
            assert!(found == line && message.contains(part), "{text:?}: line {found}, {message}");
        }
        let wide = vec!["1"; 256].join(" ") + "\n";
        assert_eq!(rows(&wide.repeat(256), &HEIGHT).unwrap().len(), 256);
        assert_eq!(rows(&wide.repeat(257), &HEIGHT).unwrap_err().0, 257);
    }

    /// Protects: names of columns are passed over where a file may have them, once and not among numbers.
    #[test]
    fn a_first_line_of_names_is_passed_over() {
        let entry = Entry { is_table: true, ..HEIGHT };
        assert_eq!(rows("speed, mu\n0,1\n2,3", &entry).unwrap(), [[0.0, 1.0], [2.0, 3.0]]);
        for (text, line) in
            [("speed, mu\nm/s, -\n0,1\n2,3", 2), ("0,1\nspeed, mu\n2,3", 2), ("speed, 1\n2,3", 1)]
        {
            assert_eq!(rows(text, &entry).unwrap_err().0, line, "{text:?}");
        }
    }
}

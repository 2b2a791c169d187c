//! The file of a height map: it is read with the study, whose text and jobs then contain the heights.
//!
//! A job must not depend on a file that may change, and its key must depend on the heights. So nothing behind the study
//! knows of files: the document that a database keeps has the heights in place of the file's name.

use super::error::StudyError;
use super::source::SourceText;
use super::text_file::read_text;
use crate::spec::MOST_HEIGHTS;
use serde_json::{Value, json};
use std::io::ErrorKind;
use std::path::Path;

/// The field of the map.
const MAP: &str = "scene.pin.base.height_map";

/// Bytes that a height may take in the file, on average.
const BYTES_OF_HEIGHT: usize = 64;

/// The text of the study with heights in place of the file's name; `None` if it names none. The file's path is relative to
/// the folder of the study, or to the working directory for standard input.
pub(super) fn with_heights(value: &Value, source: &SourceText) -> Result<Option<String>, StudyError> {
    let Some(map) = value.pointer("/scene/pin/base/height_map").and_then(Value::as_object) else {
        return Ok(None);
    };
    let Some(Value::String(name)) = map.get("file") else { return Ok(None) };
    let refuse = |message: String| Err(source.problem(&format!("{MAP}.file"), message).into());
    if map.contains_key("heights_m") {
        return refuse("expected either a file or heights_m".to_owned());
    }
    let folder = Path::new(&source.file).parent().unwrap_or(Path::new(""));
    let path = folder.join(name);
    let text = match read(&path) {
        Ok(text) => text,
        Err(reason) => return refuse(format!("{}: cannot be read: {reason}", path.display())),
    };
    let rows = match rows(&text) {
        Ok(rows) => rows,
        Err((line, message)) => return refuse(format!("{}:{line}: {message}", path.display())),
    };
    let mut fields = map.clone();
    fields.remove("file");
    fields.insert("heights_m".to_owned(), json!(rows));
    Ok(source.with_value(MAP, &Value::Object(fields)))
}

/// Reads a text file that is not larger than a map can be.
fn read(path: &Path) -> std::io::Result<String> {
    let most = MOST_HEIGHTS * BYTES_OF_HEIGHT;
    read_text(path, most as u64).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => {
            let message = format!("more than {most} bytes; a map has at most {MOST_HEIGHTS} heights");
            std::io::Error::other(message)
        }
        _ => error,
    })
}

/// The numbers of a text, a row for each line. Empty lines and lines that begin with `#` are passed over. The error is a line and
/// what is wrong with it.
fn rows(text: &str) -> Result<Vec<Vec<f64>>, (usize, String)> {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut last = 0;
    for (index, line) in text.lines().enumerate() {
        let (number, line) = (index + 1, line.trim());
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let row = row(line).map_err(|message| (number, message))?;
        if let Some(first) = rows.first()
            && first.len() != row.len()
        {
            let message = format!("{} heights: expected {}, as in the lines before", row.len(), first.len());
            return Err((number, message));
        }
        if row.len() < 2 {
            return Err((number, "1 height: expected at least 2 in a row".to_owned()));
        }
        if (rows.len() + 1) * row.len() > MOST_HEIGHTS {
            return Err((number, format!("more than {MOST_HEIGHTS} heights; resample the map")));
        }
        rows.push(row);
        last = number;
    }
    if rows.len() < 2 {
        return Err((last.max(1), format!("{} rows of heights: expected at least 2", rows.len())));
    }
    Ok(rows)
}

fn row(line: &str) -> Result<Vec<f64>, String> {
    let is_list = line.contains([',', ';']);
    let entries: Vec<&str> = if is_list {
        // Many programs end each line with a separator.
        line.trim_end_matches([',', ';']).split([',', ';']).map(str::trim).collect()
    } else {
        line.split_whitespace().collect()
    };
    let number = |(at, text): (usize, &&str)| match text.parse::<f64>() {
        Ok(height) if height.is_finite() => Ok(height),
        _ => Err(format!(
            "`{}` at place {}: expected a height in metres",
            super::source::shorten(text),
            at + 1
        )),
    };
    entries.iter().enumerate().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: every way to separate numbers, and that a bad line is named.
    #[test]
    fn rows_are_read_or_their_line_is_named() {
        let good = [
            "1e-6, 2e-6,3e-6\n4e-6,5e-6,6e-6\n",
            "# heights\r\n1e-6 2e-6\t3e-6\r\n\r\n 4e-6 5e-6 6e-6",
            "\u{feff}1e-6;2e-6;3e-6;\n4e-6; 5e-6; 6e-6;",
        ];
        for text in good {
            assert_eq!(rows(text).unwrap(), [[1e-6, 2e-6, 3e-6], [4e-6, 5e-6, 6e-6]], "{text:?}");
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
            let (found, message) = rows(text).unwrap_err();
            assert!(found == line && message.contains(part), "{text:?}: line {found}, {message}");
        }
        let wide = vec!["1"; 256].join(" ") + "\n";
        assert_eq!(rows(&wide.repeat(256)).unwrap().len(), 256);
        assert_eq!(rows(&wide.repeat(257)).unwrap_err().0, 257);
    }
}

//! The files of a height map and of a friction table: they are read with the study, whose text and jobs then contain the numbers.
//!
//! A job must not depend on a file that may change, and its key must depend on the numbers. So nothing behind the study
//! knows of files: the document that a database keeps has the numbers in place of the file's name.

use super::error::StudyError;
use super::rows::{Entry, rows};
use super::source::SourceText;
use super::text_file::read_text;
use crate::spec::MOST_HEIGHTS;
use serde_json::{Value, json};
use std::io::ErrorKind;
use std::path::Path;

/// The field of the map.
const MAP: &str = "scene.pin.base.height_map";

/// The field of the table.
const TABLE: &str = "scene.contact.mu_of_speed";

/// Bytes that a number may take in a file, on average.
const BYTES_OF_NUMBER: usize = 64;

const HEIGHT: Entry = Entry {
    one: "height",
    plural: "heights",
    expected: "a height in metres",
    most: MOST_HEIGHTS,
    is_table: false,
};

/// A file may have more pairs than a table: the refusal then says what to do.
const PAIR: Entry =
    Entry { one: "number", plural: "numbers", expected: "a number", most: 20_000, is_table: true };

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
    let rows = match rows_of_file(source, name, &HEIGHT) {
        Ok(rows) => rows,
        Err(message) => return refuse(message),
    };
    let mut fields = map.clone();
    fields.remove("file");
    fields.insert("heights_m".to_owned(), json!(rows));
    Ok(source.with_value(MAP, &Value::Object(fields)))
}

/// The text of the study with pairs in place of the file's name, if the table of the friction law is a file.
pub(super) fn with_friction(value: &Value, source: &SourceText) -> Result<Option<String>, StudyError> {
    let Some(Value::String(name)) = value.pointer("/scene/contact/mu_of_speed") else { return Ok(None) };
    let refuse = |message: String| Err(source.problem(TABLE, message).into());
    match rows_of_file(source, name, &PAIR) {
        Ok(rows) if rows.iter().any(|row| row.len() != 2) => refuse(format!(
            "{name}: {} columns: expected two, the slip speed in m/s and the friction coefficient",
            rows[0].len()
        )),
        Ok(rows) => Ok(source.with_value(TABLE, &json!(rows))),
        Err(message) => refuse(message),
    }
}

/// The rows of a file beside the study, or what is wrong with it.
fn rows_of_file(source: &SourceText, name: &str, entry: &Entry) -> Result<Vec<Vec<f64>>, String> {
    let folder = Path::new(&source.file).parent().unwrap_or(Path::new(""));
    let path = folder.join(name);
    let most = entry.most * BYTES_OF_NUMBER;
    let text = read_text(&path, most as u64).map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge => {
            format!("more than {most} bytes; expected at most {} {}", entry.most, entry.plural)
        }
        _ => error.to_string(),
    });
    let text = text.map_err(|reason| format!("{}: cannot be read: {reason}", path.display()))?;
    rows(&text, entry).map_err(|(line, message)| format!("{}:{line}: {message}", path.display()))
}

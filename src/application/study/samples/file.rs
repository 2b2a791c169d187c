//! Points from a CSV file: it is read with the study, whose text then has the points.

use super::given::SamplesFile;
use crate::study::error::StudyError;
use crate::study::limits::MAX_JOBS;
use crate::study::parameter::{PARAMETERS, Parameter};
use crate::study::source::{SourceText, shorten};
use crate::study::suggest::nearest_name;
use crate::study::text_file::read_text;
use serde_json::{Map, Value, json};
use std::collections::HashSet;
use std::path::Path;

/// The field.
const SAMPLES: &str = "samples";

/// The largest file \[byte\]: that of a million points of ten parameters.
const MOST_BYTES: u64 = 256_000_000;

/// The text of the study with lists in place of the file's name; `None` if it names none. The file's path is relative to the folder of
/// the study, or to the working directory for standard input.
pub(in crate::study) fn with_points(
    value: &Value,
    source: &SourceText,
) -> Result<Option<String>, StudyError> {
    // Fields of wrong types are found with the other fields of the study.
    let given = value.get(SAMPLES).cloned().map(serde_json::from_value::<SamplesFile>);
    let Some(Ok(samples)) = given else { return Ok(None) };
    let Some(name) = &samples.file else { return Ok(None) };
    if samples != (SamplesFile { file: samples.file.clone(), ..SamplesFile::default() }) {
        let message = "expected nothing else beside `file`";
        return Err(source.problem(SAMPLES, message).into());
    }
    let path = Path::new(&source.file).parent().unwrap_or(Path::new("")).join(name);
    match columns(&path) {
        Ok(columns) => Ok(source.with_value(SAMPLES, &json!({ "zip": columns }))),
        Err(message) => {
            Err(source.problem(&format!("{SAMPLES}.file"), format!("{}{message}", path.display())).into())
        }
    }
}

/// The columns of a file. A value is read as JSON, or else as a text.
///
/// # Errors
/// What follows the file's name in a message.
fn columns(path: &Path) -> Result<Map<String, Value>, String> {
    let text = read_text(path, MOST_BYTES).map_err(|error| format!(": cannot be read: {error}"))?;
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
    let not_csv = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        format!(":{line}: not a row of the table: {error}")
    };
    let header = reader.headers().map_err(not_csv)?.clone();
    let unknown = header.iter().find(|name| Parameter::find(name).is_none());
    if let Some(name) = unknown {
        let shown = shorten(name);
        let advice = nearest_name(name, PARAMETERS.iter().map(|parameter| parameter.name));
        let advice = advice.map_or_else(String::new, |name| format!("; did you mean `{name}`?"));
        return Err(format!(":1: column {shown:?}: no such parameter{advice}"));
    }
    let mut names = HashSet::new();
    if let Some(name) = header.iter().find(|name| !names.insert(*name)) {
        return Err(format!(":1: column {name:?} is repeated"));
    }
    let mut columns: Vec<Vec<Value>> = vec![Vec::new(); header.len()];
    for record in reader.records() {
        let record = record.map_err(not_csv)?;
        if columns[0].len() == MAX_JOBS {
            return Err(format!(": more than {MAX_JOBS} points"));
        }
        for (column, field) in columns.iter_mut().zip(&record) {
            if field.is_empty() {
                let line = record.position().map_or(1, csv::Position::line);
                return Err(format!(":{line}: expected a value in every column"));
            }
            column.push(serde_json::from_str(field).unwrap_or_else(|_| Value::from(field)));
        }
    }
    Ok(header.iter().map(str::to_owned).zip(columns.into_iter().map(Value::from)).collect())
}

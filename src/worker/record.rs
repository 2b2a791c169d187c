//! A record as the queue stores it.

use crate::analysis::JobRecord;

/// Writes a record as JSON, unless a figure in it is not finite.
///
/// JSON has no such number: it would be stored as null, and no report could read the record again.
///
/// # Errors
/// What is wrong with the record.
pub fn encode(record: &JobRecord) -> Result<String, String> {
    let text = serde_json::to_string(record).map_err(|error| format!("unwritable record: {error}"))?;
    let mut reader = serde_json::Deserializer::from_str(&text);
    match serde_path_to_error::deserialize::<_, JobRecord>(&mut reader) {
        Ok(read) if read == *record => Ok(text),
        Ok(_) => Err(not_finite("a figure")),
        Err(error) => Err(not_finite(&error.path().to_string())),
    }
}

fn not_finite(figure: &str) -> String {
    format!(
        "the run ended, but {figure} is not finite: look for extreme material, load or friction values in \
         this job"
    )
}

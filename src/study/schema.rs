//! The JSON schema of study files.

use super::file::StudyFile;
use schemars::schema_for;
use serde_json::Value;

/// The JSON schema (draft 2020-12) of a study file.
///
/// It describes names and types. The physical limits are checked by [`Study::parse`](super::Study::parse).
pub fn schema() -> Value {
    schema_for!(StudyFile).to_value()
}

//! The JSON schema of study files.

use super::file::StudyFile;
use super::time_defaults;
use schemars::schema_for;
use serde_json::Value;

/// The JSON schema (draft 2020-12) of a study file.
///
/// It describes names and types. The physical limits are checked by [`Study::parse`](super::Study::parse).
pub fn schema() -> Value {
    let mut schema = schema_for!(StudyFile).to_value();
    remove_defaults(&mut schema);
    schema
}

/// Removes the defaults of the fields whose default depends on other fields. Their descriptions say what it is.
fn remove_defaults(schema: &mut Value) {
    match schema {
        Value::Object(fields) => {
            for name in time_defaults::FIELDS {
                if let Some(Value::Object(field)) = fields.get_mut(name) {
                    field.remove("default");
                } else {
                    // A field of an object that is a default itself.
                    fields.remove(name);
                }
            }
            fields.values_mut().for_each(remove_defaults);
        }
        Value::Array(entries) => entries.iter_mut().for_each(remove_defaults),
        _ => {}
    }
}

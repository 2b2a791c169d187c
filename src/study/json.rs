//! Conversion between JSON values and typed data. serde's messages are rewritten in the words of a study file.

use super::locate::join;
use super::suggest;
use crate::spec::JobSpec;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Why a value does not have the required type.
pub(super) struct TypeMismatch {
    /// Path from the decoded value on; empty for the value itself.
    pub path: String,
    /// What is expected.
    pub message: String,
    /// The name that the author probably meant.
    pub suggestion: Option<String>,
    /// Whether the field's name is wrong rather than its value.
    pub is_name: bool,
}

/// The job as JSON, in which [`Parameter::set`](super::Parameter) sets fields.
pub(super) fn encode(job: &JobSpec) -> Value {
    serde_json::to_value(job).expect("a job is plain data with string keys")
}

/// Decodes a job from [`encode`] in which only values of checked types were set.
pub(super) fn decode_checked(value: &Value) -> JobSpec {
    JobSpec::deserialize(value).expect("each value was checked for its type on this job")
}

/// Decodes `value`, which must have objects and names where `template` has them.
pub(super) fn decode<T: DeserializeOwned>(value: &Value, template: &Value) -> Result<T, TypeMismatch> {
    same_shape(value, template, "")?;
    serde_path_to_error::deserialize(value).map_err(|error| {
        let path = error.path().to_string();
        let path = if path == "." { String::new() } else { path };
        explain(path, &error.inner().to_string())
    })
}

/// Refuses two forms that serde accepts and a reader would not understand: a list of a structure's values without their
/// names, and a name written as `{"inner_side": null}`.
fn same_shape(value: &Value, template: &Value, path: &str) -> Result<(), TypeMismatch> {
    let refuse = |message: &str| {
        let (path, message) = (path.to_owned(), message.to_owned());
        Err(TypeMismatch { path, message, suggestion: None, is_name: false })
    };
    match (template, value) {
        (Value::Object(fields), Value::Object(given)) => given.iter().try_for_each(|(name, inner)| {
            fields.get(name).map_or(Ok(()), |field| same_shape(inner, field, &join(path, name)))
        }),
        (Value::Object(_), _) => refuse("expected an object { … }"),
        (Value::String(_), Value::String(_)) => Ok(()),
        (Value::String(_), _) => refuse("expected a name, as a string"),
        _ => Ok(()),
    }
}

/// Rewrites a message of serde.
fn explain(path: String, message: &str) -> TypeMismatch {
    let is_name = message.starts_with("unknown field");
    let is_unknown = is_name || message.starts_with("unknown variant");
    // serde writes: unknown field `wrong`, expected one of `a`, `b`
    let mut quoted = message.split('`').skip(1).step_by(2);
    let wrong = quoted.next().filter(|_| is_unknown);
    let suggestion = wrong.and_then(|wrong| {
        suggest::nearest(wrong, quoted.map(|name| (name, vec![name.to_owned()]))).map(str::to_owned)
    });
    let message = match message.split_once(", expected ") {
        Some((_, expected)) if is_name => format!("no such field; expected {expected}"),
        Some((_, expected)) => format!("expected {}", in_json_words(expected)),
        None => message.to_owned(),
    };
    TypeMismatch { path, message, suggestion, is_name }
}

/// Translates type names of Rust and serde into the words of JSON.
fn in_json_words(expected: &str) -> &str {
    match expected {
        "f64" => "a number",
        "usize" | "u64" => "a whole number >= 0, without a decimal point",
        "a boolean" => "true or false",
        "a map" => "an object { … }",
        "fewer elements in array" => "fewer entries in the list",
        other if other.starts_with("an array of length 3") => "a list of 3 entries",
        other => other,
    }
}

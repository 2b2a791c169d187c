//! Many rows as one parameter of a statement. The statement unpacks them with `json_each` or `json_array_elements`.

use serde::Serialize;

/// The rows as JSON.
///
/// # Panics
/// If a number is not finite: JSON cannot represent it.
pub(super) fn json(rows: &impl Serialize) -> String {
    serde_json::to_string(rows).expect("strings and finite numbers have a JSON form")
}

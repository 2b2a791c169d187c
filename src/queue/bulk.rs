//! Many rows as one parameter of a statement, which takes them apart with `json_each`.

use serde::Serialize;

/// The rows as JSON.
///
/// # Panics
/// If a number is not finite: JSON has no form for it.
pub(super) fn json(rows: &impl Serialize) -> String {
    serde_json::to_string(rows).expect("strings and finite numbers have a JSON form")
}

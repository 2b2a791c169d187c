//! The limits of single fields in the JSON schema.

use crate::spec::{End, Limit};
use serde_json::{Map, Value};

/// The keywords of a schema that say what a limit says.
pub(super) fn keywords(limit: &Limit) -> Map<String, Value> {
    let [low, high] = [limit.low, limit.high].map(|end| match end {
        End::Open => None,
        End::At(value) => Some((value, ["minimum", "maximum"])),
        End::Beyond(value) => Some((value, ["exclusiveMinimum", "exclusiveMaximum"])),
    });
    // A limit of a whole number is one, too.
    let number = |value: f64| {
        if value.fract() == 0.0 && value.abs() < 1.0e15 { Value::from(value as i64) } else { value.into() }
    };
    let low = low.map(|(value, names)| (names[0].to_owned(), number(value)));
    let high = high.map(|(value, names)| (names[1].to_owned(), number(value)));
    low.into_iter().chain(high).collect()
}

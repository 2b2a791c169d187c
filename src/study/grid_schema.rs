//! The JSON schema of a study's grid.

use super::parameter::{Kind, PARAMETERS, Parameter};
use super::range::Range;
use schemars::{Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

/// Every parameter by name, and no other property.
pub(super) fn grid_schema(schemas: &mut SchemaGenerator) -> Schema {
    let properties: Map<String, Value> = PARAMETERS
        .iter()
        .map(|parameter| (parameter.name.to_owned(), axis_schema(parameter, schemas)))
        .collect();
    json_schema!({
        "description": "Parameters to vary; the jobs are all combinations, the first parameter slowest. Absent: a single job.",
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
        "minProperties": 1,
    })
}

fn axis_schema(parameter: &Parameter, schemas: &mut SchemaGenerator) -> Value {
    let value = match parameter.kind {
        Kind::Number => json!({ "type": "number" }),
        Kind::Count => json!({ "type": "integer", "minimum": 1 }),
        Kind::Counts => {
            json!({ "type": "array", "items": { "type": "integer", "minimum": 1 }, "minItems": 3, "maxItems": 3 })
        }
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Name(names) => names(schemas).to_value(),
    };
    let list = json!({ "type": "array", "items": value, "minItems": 1, "uniqueItems": true });
    let forms = match parameter.kind {
        Kind::Number | Kind::Count => vec![list, schemas.subschema_for::<Range>().to_value()],
        Kind::Counts | Kind::Flag | Kind::Name(_) => vec![list],
    };
    json!({ "description": parameter.doc, "anyOf": forms })
}

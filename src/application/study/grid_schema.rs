//! The JSON schemas of objects whose fields are parameters: a grid, points, distributions and conditions.

use super::limit_schema::keywords;
use super::parameter::{Kind, PARAMETERS, Parameter};
use super::range::Range;
use super::samples::distribution::Distribution;
use crate::spec::Limit;
use schemars::{Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

/// Every parameter by name, and no other property.
pub(super) fn grid_schema(schemas: &mut SchemaGenerator) -> Schema {
    let mut grid = of_parameters(schemas, axis_schema);
    grid.insert(
        "description".to_owned(),
        "Parameters to vary; the jobs are all combinations, the first parameter slowest. Absent: a single job.".into(),
    );
    grid.into()
}

/// A point: a value for each parameter.
pub(super) fn points_schema(schemas: &mut SchemaGenerator) -> Schema {
    let point = of_parameters(schemas, value_schema);
    json_schema!({
        "description": "The points one by one, each with a value for each of the same parameters.",
        "type": "array",
        "items": point,
        "minItems": 1,
    })
}

/// The parameters of a measured point.
pub(super) fn measured_schema(schemas: &mut SchemaGenerator) -> Schema {
    let mut point = of_parameters(schemas, value_schema);
    point.remove("minProperties");
    let words = "The values of the parameters that the grid varies, such as `{ \"omega_rpm\": 100 }`.";
    point.insert("description".to_owned(), words.into());
    point.into()
}

/// Lists or ranges of equal lengths.
pub(super) fn zip_schema(schemas: &mut SchemaGenerator) -> Schema {
    let mut zip = of_parameters(schemas, column_schema);
    zip.insert(
        "description".to_owned(),
        "Lists or ranges of equal lengths: the first values of all are the first point, and so on.".into(),
    );
    zip.into()
}

/// Parameters with expressions.
pub(super) fn derive_schema(schemas: &mut SchemaGenerator) -> Schema {
    let text = |parameter: &Parameter, _: &mut SchemaGenerator| {
        let words = format!("Expression for: {}. It has names of other parameters.", parameter.meaning);
        json!({ "description": words, "type": "string" })
    };
    let mut derive = of_parameters(schemas, text);
    if let Some(Value::Object(fields)) = derive.get_mut("properties") {
        fields.retain(|name, _| Parameter::find(name).is_some_and(|own| matches!(own.kind, Kind::Number)));
    }
    let words = "Parameters that are tied to others by an expression: `{ \"mu_static\": \"1.4 * mu\" }`.";
    derive.insert("description".to_owned(), words.into());
    derive.into()
}

/// Parameters with distributions.
pub(super) fn distributions_schema(schemas: &mut SchemaGenerator) -> Schema {
    let mut of = of_parameters(schemas, |_, schemas| schemas.subschema_for::<Distribution>().to_value());
    of.insert("description".to_owned(), "Parameters of a design with their distributions.".into());
    of.into()
}

/// Conditions on parameters.
pub(super) fn conditions_schema(schemas: &mut SchemaGenerator) -> Schema {
    let condition = of_parameters(schemas, |parameter, schemas| {
        let value = value_schema(parameter, schemas);
        let mut forms = vec![json!({ "type": "array", "items": value }), value];
        if parameter.is_number() {
            let limit = |which: &str| json!({ "description": format!("The {which} value, included."), "type": "number" });
            forms.push(json!({
                "type": "object",
                "properties": { "from": limit("smallest"), "to": limit("largest") },
                "additionalProperties": false,
                "minProperties": 1,
            }));
        }
        json!({ "anyOf": forms })
    });
    json_schema!({
        "description": "Conditions on points: parameters with limits (both included), a list of values or a value.",
        "type": "array",
        "items": condition,
    })
}

/// A closed object with at least one parameter.
fn of_parameters(
    schemas: &mut SchemaGenerator,
    of: impl Fn(&Parameter, &mut SchemaGenerator) -> Value,
) -> Map<String, Value> {
    let property = |parameter: &Parameter| {
        let value = of(parameter, schemas);
        let is_described = value.get("description").is_some();
        let value =
            if is_described { value } else { json!({ "description": parameter.doc(), "anyOf": [value] }) };
        (parameter.name.to_owned(), value)
    };
    let properties: Map<String, Value> = PARAMETERS.iter().map(property).collect();
    let object = json!({
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
        "minProperties": 1,
    });
    object.as_object().cloned().unwrap_or_default()
}

/// A value of a parameter.
fn value_schema(parameter: &Parameter, schemas: &mut SchemaGenerator) -> Value {
    match parameter.kind {
        Kind::Number | Kind::Count => {
            let kind = if matches!(parameter.kind, Kind::Number) { "number" } else { "integer" };
            let mut number = Map::from_iter([("type".to_owned(), kind.into())]);
            number.extend(limit_of(parameter));
            number.into()
        }
        Kind::Counts => {
            let mut count = Map::from_iter([("type".to_owned(), "integer".into())]);
            count.extend(limit_of(parameter));
            json!({ "type": "array", "items": count, "minItems": 3, "maxItems": 3 })
        }
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Name(names) => names(schemas).to_value(),
    }
}

/// What a schema says about the limit of a parameter's values.
fn limit_of(parameter: &Parameter) -> Map<String, Value> {
    let field = parameter.field();
    let limit = Limit::of(&field).or_else(|| Limit::of(&format!("{field}[]")));
    limit.map_or_else(Map::new, keywords)
}

/// Values of a parameter, which may be repeated.
fn column_schema(parameter: &Parameter, schemas: &mut SchemaGenerator) -> Value {
    let list = json!({ "type": "array", "items": value_schema(parameter, schemas), "minItems": 1 });
    forms_of_values(parameter, list, schemas)
}

fn axis_schema(parameter: &Parameter, schemas: &mut SchemaGenerator) -> Value {
    let value = value_schema(parameter, schemas);
    let list = json!({ "type": "array", "items": value, "minItems": 1, "uniqueItems": true });
    forms_of_values(parameter, list, schemas)
}

fn forms_of_values(parameter: &Parameter, list: Value, schemas: &mut SchemaGenerator) -> Value {
    let forms = match parameter.kind {
        Kind::Number | Kind::Count => {
            // `from` is always a value; `to` need not be one, with a step.
            let range = schemas.subschema_for::<Range>().to_value();
            let from = json!({ "properties": { "from": limit_of(parameter) } });
            vec![list, json!({ "allOf": [range, from] })]
        }
        Kind::Counts | Kind::Flag | Kind::Name(_) => vec![list],
    };
    json!({ "description": parameter.doc(), "anyOf": forms })
}

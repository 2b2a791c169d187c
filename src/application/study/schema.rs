//! The JSON schema of study files.

use super::file::StudyFile;
use super::limit_schema::keywords;
use super::time_defaults;
use super::with_unit::PATTERN;
use crate::spec::LIMITS;
use crate::units::name_and_unit;
use schemars::schema_for;
use serde_json::Value;

/// The JSON schema (draft 2020-12) of a study file.
///
/// It describes names, types and the [limits](LIMITS) of single fields. Limits that depend on several fields are checked by
/// [`Study::parse`](super::Study::parse).
pub fn schema() -> Value {
    let mut schema = schema_for!(StudyFile).to_value();
    remove_defaults(&mut schema);
    for limit in LIMITS {
        let pointer = pointer_to(limit.field, &schema);
        if let Some(Value::Object(field)) = schema.pointer_mut(&pointer) {
            field.extend(keywords(limit));
            // A field that must be given has a default that nobody can use.
            if field.get("default").and_then(Value::as_f64).is_some_and(|value| !limit.holds(value)) {
                field.remove("default");
            }
        }
    }
    allow_units(&mut schema, false);
    schema
}

/// The definitions of values of any parameter, with a unit or without.
const OF_PARAMETERS: [&str; 2] = ["Range", "Distribution"];

/// Lets every number whose name ends with a unit be a text with a unit, too. `has_unit` is whether the name of `schema` does.
fn allow_units(schema: &mut Value, has_unit: bool) {
    let Value::Object(fields) = schema else { return };
    let kinds = fields.get_mut("type").filter(|_| has_unit);
    let allowed = match kinds {
        Some(Value::String(kind)) if kind == "number" => Some(vec!["number".into(), "string".into()]),
        Some(Value::Array(kinds)) if kinds.contains(&"number".into()) => {
            Some(kinds.iter().cloned().chain(["string".into()]).collect())
        }
        _ => None,
    };
    if let Some(kinds) = allowed {
        fields.insert("type".to_owned(), Value::Array(kinds));
        fields.insert("pattern".to_owned(), PATTERN.into());
    }
    for (keyword, inner) in fields {
        match (keyword.as_str(), inner) {
            ("properties", Value::Object(properties)) => {
                for (name, property) in properties {
                    allow_units(property, has_unit || !name_and_unit(name).1.is_empty());
                }
            }
            ("$defs", Value::Object(definitions)) => {
                for (name, definition) in definitions {
                    allow_units(definition, OF_PARAMETERS.contains(&name.as_str()));
                }
            }
            ("items", item) => allow_units(item, has_unit),
            ("anyOf" | "oneOf" | "allOf", Value::Array(forms)) => {
                for form in forms {
                    allow_units(form, has_unit);
                }
            }
            _ => {}
        }
    }
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

/// The JSON pointer to the schema of a field, `scene.pin.size_m[]`.
fn pointer_to(field: &str, schema: &Value) -> String {
    let mut pointer = String::new();
    for step in field.replace("[]", ".[]").split('.') {
        // An optional field may be the object or null.
        let node = schema.pointer(&pointer);
        let forms = node.and_then(|node| node.get("anyOf")).and_then(Value::as_array);
        let reference = node.into_iter().chain(forms.into_iter().flatten()).find_map(|form| form.get("$ref"));
        if let Some(target) = reference.and_then(Value::as_str).and_then(|target| target.strip_prefix('#')) {
            target.clone_into(&mut pointer);
        }
        pointer.push_str(if step == "[]" { "/items" } else { "/properties/" });
        pointer.push_str(if step == "[]" { "" } else { step });
    }
    pointer
}

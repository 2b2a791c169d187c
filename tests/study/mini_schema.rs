//! A JSON schema validator for the keywords that the study schema uses; any other keyword is an error.

use serde_json::Value;

/// The keywords that the validator understands.
#[rustfmt::skip]
pub const KNOWN: &[&str] = &[
    // Keywords that do not constrain a value.
    "$schema", "$defs", "title", "description", "default", "format",
    // Keywords that do.
    "$ref", "type", "const", "enum", "anyOf", "oneOf", "properties", "additionalProperties", "required",
    "minProperties", "items", "minItems", "maxItems", "uniqueItems", "minimum", "maximum",
    "exclusiveMinimum", "exclusiveMaximum", "allOf", "pattern",
];

/// Where and why `value` violates `schema`, if it does.
pub fn violation(root: &Value, schema: &Value, value: &Value, at: &str) -> Option<String> {
    let fail = |why: String| Some(format!("{at}: {why}"));
    let number = |limit: &Value| limit.as_f64().expect("a limit is a number");
    let length = |limit: &Value| limit.as_u64().expect("a limit of length is a count") as usize;
    for (keyword, rule) in schema.as_object().expect("a schema is an object") {
        assert!(KNOWN.contains(&keyword.as_str()), "{at}: keyword {keyword} is not understood");
        let found = match (keyword.as_str(), value) {
            ("$ref", _) => {
                let pointer =
                    rule.as_str().and_then(|target| target.strip_prefix('#')).expect("a local $ref");
                violation(root, root.pointer(pointer).expect("the $ref has a target"), value, at)
            }
            ("type", _) if !types(rule).any(|name| has_type(value, name)) => {
                fail(format!("not of type {rule}"))
            }
            ("const", _) if value != rule => fail(format!("not {rule}")),
            ("enum", _) if !rule.as_array().expect("enum is a list").contains(value) => {
                fail(format!("not in {rule}"))
            }
            ("anyOf" | "oneOf", _) => {
                let forms = rule.as_array().expect("forms are a list");
                let fits = forms.iter().filter(|form| violation(root, form, value, at).is_none()).count();
                let right = if keyword == "oneOf" { fits == 1 } else { fits > 0 };
                if right { None } else { fail(format!("fits {fits} forms of {keyword}")) }
            }
            ("properties", Value::Object(fields)) => fields
                .iter()
                .find_map(|(name, inner)| violation(root, rule.get(name)?, inner, &format!("{at}/{name}"))),
            ("additionalProperties", Value::Object(fields)) => {
                assert_eq!(rule, &Value::Bool(false), "only a closed object is supported");
                let known = |name: &String| schema["properties"].get(name).is_some();
                fields
                    .keys()
                    .find(|name| !known(name))
                    .and_then(|name| fail(format!("{name} is not allowed")))
            }
            ("required", Value::Object(fields)) => {
                let names = rule.as_array().expect("required is a list").iter().filter_map(Value::as_str);
                names
                    .into_iter()
                    .find(|name| !fields.contains_key(*name))
                    .and_then(|name| fail(format!("no {name}")))
            }
            ("minProperties", Value::Object(fields)) if fields.len() < length(rule) => {
                fail("too few fields".into())
            }
            ("items", Value::Array(entries)) => entries
                .iter()
                .enumerate()
                .find_map(|(i, entry)| violation(root, rule, entry, &format!("{at}/{i}"))),
            ("minItems", Value::Array(entries)) if entries.len() < length(rule) => fail("too short".into()),
            ("maxItems", Value::Array(entries)) if entries.len() > length(rule) => fail("too long".into()),
            ("uniqueItems", Value::Array(entries)) => {
                let repeated = (1..entries.len()).any(|i| entries[..i].contains(&entries[i]));
                if repeated { fail("repeated entry".into()) } else { None }
            }
            ("minimum", Value::Number(_)) if number(value) < number(rule) => fail("too small".into()),
            ("maximum", Value::Number(_)) if number(value) > number(rule) => fail("too large".into()),
            ("exclusiveMinimum", Value::Number(_)) if number(value) <= number(rule) => {
                fail("too small".into())
            }
            ("exclusiveMaximum", Value::Number(_)) if number(value) >= number(rule) => {
                fail("too large".into())
            }
            ("allOf", _) => {
                let forms = rule.as_array().expect("forms are a list");
                forms.iter().find_map(|form| violation(root, form, value, at))
            }
            ("pattern", Value::String(text)) => {
                let fits = match rule.as_str() {
                    Some("^[A-Za-z0-9_-]+$") => {
                        let allowed = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
                        !text.is_empty() && text.chars().all(allowed)
                    }
                    Some(r"^[+-]?[0-9.]+([eE][+-]?[0-9]+)? *(1/|[^0-9+., -]).*$") => {
                        let rest = text.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.".contains(c));
                        let is_number = rest.len() < text.len();
                        let unit = rest.trim_start();
                        let is_unit = |c: char| !c.is_ascii_digit() && !"+., -".contains(c);
                        is_number && (unit.starts_with(is_unit) || unit.starts_with("1/"))
                    }
                    other => panic!("the pattern {other:?} is not supported"),
                };
                if fits { None } else { fail(format!("{text}: not of the pattern {rule}")) }
            }
            _ => None,
        };
        if found.is_some() {
            return found;
        }
    }
    None
}

/// Calls `visit` with every schema within a schema, and with its place.
pub fn for_each(schema: &Value, at: &str, visit: &mut impl FnMut(&Value, &str)) {
    visit(schema, at);
    for keyword in ["$defs", "properties"] {
        for (name, inner) in schema[keyword].as_object().into_iter().flatten() {
            for_each(inner, &format!("{at}/{name}"), visit);
        }
    }
    for keyword in ["anyOf", "oneOf"] {
        for form in schema[keyword].as_array().into_iter().flatten() {
            for_each(form, at, visit);
        }
    }
    if let Some(entry) = schema.get("items") {
        for_each(entry, at, visit);
    }
}

fn types(rule: &Value) -> impl Iterator<Item = &str> {
    let several = rule.as_array().map(Vec::as_slice).unwrap_or_default();
    rule.as_str().into_iter().chain(several.iter().filter_map(Value::as_str))
}

fn has_type(value: &Value, name: &str) -> bool {
    match name {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|float| float.fract() == 0.0),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("type {other} is not supported"),
    }
}

//! Conversion between JSON values and typed data. serde's messages are rewritten in the words of a study file.

use super::locate::{TOO_LARGE, join};
use super::suggest;
use crate::spec::JobSpec;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer};
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

/// The job as JSON.
pub(super) fn encode(job: &JobSpec) -> Value {
    serde_json::to_value(job).expect("a job is plain data with string keys")
}

/// The value at a pointer to a parameter. [`Value::pointer`] makes two texts for each name on the way, which takes most of the time where
/// all inputs of many jobs are read. Names of parameters need no such care.
pub(super) fn at<'a>(value: &'a Value, pointer: &str) -> Option<&'a Value> {
    pointer.split('/').skip(1).try_fold(value, |inner, name| match inner {
        Value::Object(fields) => fields.get(name),
        Value::Array(items) => items.get(name.parse::<usize>().ok()?),
        _ => None,
    })
}

/// Reads an optional field that is present: `"grid": null` is a mistake and not the absence of a grid.
pub(super) fn present<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    T::deserialize(deserializer).map(Some)
}

/// What was read from a JSON value.
pub(super) struct Decoded<T> {
    /// The data, in which fields that cannot be read have the template's values; absent if that was not possible.
    pub value: Option<T>,
    /// One entry for each field that cannot be read.
    pub mismatches: Vec<TypeMismatch>,
}

/// Decodes `value`, which must have objects and names where `template` has them. The error is the first one that is found.
pub(super) fn decode<T: DeserializeOwned>(value: &Value, template: &Value) -> Result<T, TypeMismatch> {
    let mut mismatches = Vec::new();
    same_shape(value, template, "", &mut mismatches);
    match mismatches.into_iter().next() {
        Some(mismatch) => Err(mismatch),
        None => deserialize(value),
    }
}

/// Largest number of problems that are looked for: each one costs an attempt to read the whole value.
const MOST_MISMATCHES: usize = 1000;

/// As [`decode`], but finds all fields that cannot be read.
pub(super) fn decode_all<T: DeserializeOwned>(value: &Value, template: &Value) -> Decoded<T> {
    let mut mismatches = Vec::new();
    same_shape(value, template, "", &mut mismatches);
    if mismatches.is_empty()
        && let Ok(value) = deserialize(value)
    {
        return Decoded { value: Some(value), mismatches };
    }
    let mut value = value.clone();
    for mismatch in &mismatches {
        replace(&mut value, template, &mismatch.path);
    }
    // serde stops at the first error. The field that it refuses is replaced, so that it finds the next one.
    loop {
        match deserialize(&value) {
            Ok(value) => return Decoded { value: Some(value), mismatches },
            Err(mismatch) => {
                let is_replaced = replace(&mut value, template, &mismatch.path);
                // What is not replaced is a missing field. It may be missing because it was refused.
                if is_replaced || mismatches.is_empty() {
                    mismatches.push(mismatch);
                }
                if !is_replaced || mismatches.len() >= MOST_MISMATCHES {
                    return Decoded { value: None, mismatches };
                }
            }
        }
    }
}

fn deserialize<T: DeserializeOwned>(value: &Value) -> Result<T, TypeMismatch> {
    serde_path_to_error::deserialize(value).map_err(|error| {
        let path = error.path().to_string();
        let path = if path == "." { String::new() } else { path };
        explain(path, &error.inner().to_string())
    })
}

/// Gives the field at `path` (`scene.pin.size_m[0]`) the value that it has in `template`, or removes it if the template
/// does not have it. Returns whether the value has changed; otherwise serde would find the same error again.
fn replace(value: &mut Value, template: &Value, path: &str) -> bool {
    let (list, index) = match path.strip_suffix(']').and_then(|path| path.rsplit_once('[')) {
        Some((list, index)) => (list, index.parse::<usize>().ok()),
        None => (path, None),
    };
    let (mut outer, mut template, mut rest) = (value, Some(template), list);
    loop {
        let Some(object) = outer.as_object_mut() else { return false };
        // A key may contain a dot. Then it is no field of any structure, and it is the last part of the path.
        let is_last = object.contains_key(rest);
        let (name, below) = if is_last { (rest, "") } else { rest.split_once('.').unwrap_or((rest, "")) };
        let usual = template.and_then(|template| template.get(name));
        if !below.is_empty() {
            let Some(inner) = object.get_mut(name) else { return false };
            (outer, template, rest) = (inner, usual, below);
            continue;
        }
        let entry = index.and_then(|index| object.get_mut(name)?.get_mut(index).zip(usual?.get(index)));
        if let Some((entry, usual)) = entry {
            let has_changed = entry != usual;
            *entry = usual.clone();
            return has_changed;
        }
        let old = match usual {
            Some(usual) => object.insert(name.to_owned(), usual.clone()),
            None => object.remove(name),
        };
        return old.is_some_and(|old| usual != Some(&old));
    }
}

/// Finds two forms that serde accepts and a reader would not understand: a list of a structure's values without their
/// names, and a name written as `{"inner_side": null}`.
fn same_shape(value: &Value, template: &Value, path: &str, found: &mut Vec<TypeMismatch>) {
    let mut refuse = |message: &str| {
        let (path, message) = (path.to_owned(), message.to_owned());
        found.push(TypeMismatch { path, message, suggestion: None, is_name: false });
    };
    match (template, value) {
        (Value::Object(fields), Value::Object(given)) => {
            for (name, inner) in given {
                if let Some(field) = fields.get(name) {
                    same_shape(inner, field, &join(path, name), found);
                }
            }
        }
        (Value::Object(_), _) => refuse("expected an object { … }"),
        (Value::String(_), Value::String(_)) => {}
        (Value::String(_), _) => refuse("expected a name, as a string"),
        _ => {}
    }
}

/// An entry of a list as JSON has it: a number, or a number with a unit in quotes; `None` if it is neither.
fn entry_of_list(text: &str) -> Option<String> {
    let text = text.trim().trim_matches('"');
    if let Ok(number) = text.parse() {
        let number = serde_json::Number::from_f64(number)?.to_string();
        return Some(number.trim_end_matches(".0").to_owned());
    }
    let unit_at = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE ".contains(c)))?;
    let (number, unit) = text.split_at(unit_at);
    let has_one_number = number.trim().parse::<f64>().is_ok_and(f64::is_finite) && !unit.contains(' ');
    has_one_number.then(|| format!("\"{text}\""))
}

/// What to write instead of a text where a number is expected; none if the text says nothing about that.
pub(super) fn number_hint(text: &str) -> Option<String> {
    let text = text.trim();
    // Rust reads `1e999` as infinity, and the words `inf` and `nan` as numbers.
    let has_digit = text.bytes().any(|byte| byte.is_ascii_digit());
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => return Some(format!("write {text} without quotes")),
        Ok(_) if has_digit => return Some(TOO_LARGE.to_owned()),
        Ok(_) => return Some("expected a finite number".to_owned()),
        Err(_) => {}
    }
    let is_number = |part: &str| part.trim().parse::<f64>().is_ok();
    if let Some(inner) = text.strip_prefix('[') {
        // JSON that cannot be read arrives as a text: units without quotes, or a bracket that is not closed.
        let inner = inner.trim_end_matches(']').trim().trim_end_matches([',', ';']);
        let entries: Option<Vec<String>> = inner.split([',', ';']).map(entry_of_list).collect();
        return Some(format!("a list is [{}]", entries?.join(", ")));
    }
    let parts: Vec<&str> = text.split([',', ';']).collect();
    if let [whole, fraction] = parts[..]
        && text.contains(',')
        && whole.trim_start_matches('-').bytes().all(|byte| byte.is_ascii_digit())
        && !fraction.is_empty()
        && fraction.bytes().all(|byte| byte.is_ascii_digit())
    {
        return Some(format!(
            "a number has a decimal point: {whole}.{fraction}; a list is [{whole}, {fraction}]"
        ));
    }
    if parts.len() > 1 && parts.iter().all(|part| is_number(part)) {
        return Some(format!(
            "a list is [{}]",
            parts.iter().map(|part| part.trim()).collect::<Vec<_>>().join(", ")
        ));
    }
    let ends: Vec<&str> = text.split(':').flat_map(|part| part.split("..")).collect();
    if let [from, .., to] = ends[..]
        && ends.iter().all(|end| is_number(end))
    {
        return Some(format!("a range is {{\"from\": {from}, \"to\": {to}, \"count\": 5}}"));
    }
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c)))?;
    let (number, unit) = (text[..end].trim_end_matches(['e', 'E']), text[end..].trim());
    (is_number(number) && !unit.is_empty()).then(|| "write the number alone".to_owned())
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

/// The message about a value that is no number.
pub(super) const NUMBER: &str = "expected a number";

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

#[cfg(test)]
mod tests {
    use super::number_hint;

    /// Protects: who writes a number as people do is told how JSON has it.
    #[test]
    fn numbers_of_people_get_a_hint() {
        for (text, part) in [
            ("0,3", "0.3"),
            ("-0,3", "-0.3"),
            ("0.2,0.3", "[0.2, 0.3]"),
            ("0.2; 0.3;0.4", "[0.2, 0.3, 0.4]"),
            ("50:400", "{\"from\": 50, \"to\": 400, \"count\": 5}"),
            ("50..400", "\"from\": 50, \"to\": 400"),
            ("20N", "the number alone"),
            ("8 mm", "the number alone"),
            ("3", "3 without quotes"),
            ("1e999", "too large for a double"),
            ("-1e999", "too large for a double"),
            ("inf", "a finite number"),
        ] {
            let hint = number_hint(text).unwrap_or_default();
            assert!(hint.contains(part), "{text}: {hint}");
        }
        for text in ["", "high", "x:y", "a,b"] {
            assert_eq!(number_hint(text), None, "{text}");
        }
    }
}

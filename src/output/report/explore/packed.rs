//! Columns of values that take little room in a page.

use indexmap::IndexMap;
use serde::Serialize;
use serde_json::Value;
use serde_json::ser::{Formatter, Serializer};
use serde_json::value::RawValue;
use std::io::{self, Write};

/// The values of a column in all rows.
#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Values {
    /// The same in all rows.
    All(Value),
    /// Numbers and nulls.
    Numbers(Box<RawValue>),
    /// Other values: the different ones, and the place among them of each row's value; null where there is none.
    Names(Vec<Value>, Box<RawValue>),
}

impl Values {
    /// None if no row has a value: such a column would only be in the way.
    pub(super) fn of(given: &[Value]) -> Option<Self> {
        let first = given.iter().find(|value| !value.is_null())?;
        if given.iter().all(|value| value == first) {
            return Some(Self::All(first.clone()));
        }
        if given.iter().all(|value| value.is_null() || value.is_number()) {
            return Some(Self::Numbers(serde_json::value::to_raw_value(given).ok()?));
        }
        let mut names: IndexMap<String, Value> = IndexMap::new();
        let mut place = |value: &Value| {
            (!value.is_null()).then(|| {
                let entry = names.entry(value.to_string());
                let place = entry.index();
                entry.or_insert_with(|| value.clone());
                place
            })
        };
        let places: Vec<Option<usize>> = given.iter().map(&mut place).collect();
        let places = serde_json::value::to_raw_value(&places).ok()?;
        Some(Self::Names(names.into_values().collect(), places))
    }
}

/// Writes data as JSON that can stand in a page: no text in it can end the script that it is in.
pub(super) fn write_embedded(data: &impl Serialize, out: impl Write) -> io::Result<()> {
    data.serialize(&mut Serializer::with_formatter(out, Embedded)).map_err(io::Error::from)
}

struct Embedded;

impl Formatter for Embedded {
    fn write_string_fragment<W: ?Sized + Write>(&mut self, writer: &mut W, fragment: &str) -> io::Result<()> {
        for (number, part) in fragment.split('<').enumerate() {
            if number > 0 {
                writer.write_all(b"\\u003c")?;
            }
            writer.write_all(part.as_bytes())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{Values, write_embedded};
    use serde_json::{Value, json};

    fn embedded(given: &[Value]) -> String {
        let mut out = Vec::new();
        write_embedded(&Values::of(given), &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    /// Protects: the forms that the script reads, and that no text of a study ends the script.
    #[test]
    fn columns_are_packed() {
        assert_eq!(embedded(&[Value::Null, Value::Null]), "null");
        assert_eq!(embedded(&[json!(0.4), json!(0.4)]), "{\"all\":0.4}");
        assert_eq!(embedded(&[json!(0.4), Value::Null, json!(7)]), "{\"numbers\":[0.4,null,7]}");
        let mixed = [json!("</script>"), json!(3), Value::Null, json!("</script>")];
        assert_eq!(embedded(&mixed), "{\"names\":[[\"\\u003c/script>\",3],[0,1,null,0]]}");
    }
}

//! A study as a text.

use super::grid::Grid;
use super::source::SourceText;
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::Value;

/// The top-level fields in the order in which a document is written; others come before the grid.
const ORDER: [&str; 13] = [
    "$schema",
    "name",
    "description",
    "preset",
    "accuracy",
    "sliding_speed_m_s",
    "damping",
    "scene",
    "numerics",
    "run",
    "detection",
    "stability",
    "derive",
];

/// The text of a study file that says what `document` and `grid` say: the text of `source` if the command line has not
/// changed it.
pub(super) fn text(document: &Value, grid: &Grid, source: &SourceText) -> String {
    if source.changes.is_empty() {
        return source.text.clone();
    }
    let text = serde_json::to_string_pretty(&Written(document, grid));
    text.expect("a study is plain data with string keys") + "\n"
}

/// The object with its fields in a reader's order and the axes in the grid's order. A map of `serde_json` sorts its keys.
struct Written<'a>(&'a Value, &'a Grid);

impl Serialize for Written<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields: Vec<_> = self.0.as_object().into_iter().flatten().collect();
        fields.retain(|(name, _)| *name != "grid" && *name != "samples");
        fields.sort_by_key(|(name, _)| ORDER.iter().position(|known| known == name).unwrap_or(ORDER.len()));
        let mut map = serializer.serialize_map(None)?;
        for (name, value) in fields {
            map.serialize_entry(name, value)?;
        }
        if let Some(samples) = &self.1.samples {
            map.serialize_entry("samples", samples.written())?;
        }
        if !self.1.axes.is_empty() {
            map.serialize_entry("grid", &WrittenGrid(self.1))?;
        }
        map.end()
    }
}

struct WrittenGrid<'a>(&'a Grid);

impl Serialize for WrittenGrid<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let axes = self.0.axes.iter().map(|axis| (axis.parameter.name, axis.written()));
        serializer.collect_map(axes)
    }
}

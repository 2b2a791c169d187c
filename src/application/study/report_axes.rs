//! What a study's file says about its report.

use super::error::Problem;
use super::parameter::{PARAMETERS, Parameter};
use super::range::Spacing;
use super::source::SourceText;
use super::suggest::nearest_name;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// The axes and quantities of the study's report.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ReportAxes {
    /// The parameter along the axis of figures and the rows of tables; ω when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "name_schema")]
    pub x: Option<String>,
    /// The parameter that tells curves and columns apart; μ when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "name_schema")]
    pub by: Option<String>,
    /// Quantities with figures and tables of their own, besides the usual ones: names of columns of the export.
    pub y: Vec<String>,
    /// How the axes of parameters are scaled; as their values are given when absent: a range or a distribution says it, and a list
    /// of values > 0 that spans a factor of 20 is logarithmic, as that of ω is in any case.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    #[schemars(schema_with = "scale_schema")]
    pub scale: BTreeMap<String, Spacing>,
}

/// The name of the source of a row, which stands for a parameter in comparisons.
const SOURCE: &str = "source";

/// The names that [`ReportAxes::x`] and [`ReportAxes::by`] can have.
fn names() -> impl Iterator<Item = &'static str> {
    PARAMETERS.iter().map(|parameter| parameter.name).chain([SOURCE])
}

fn name_schema(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string", "enum": names().collect::<Vec<_>>() })
}

fn scale_schema(_: &mut SchemaGenerator) -> Schema {
    let field = |name: &str| json!({ "description": format!("How the axis of {name} is scaled."), "enum": ["linear", "log"] });
    let fields: Map<String, Value> =
        PARAMETERS.iter().map(|parameter| (parameter.name.to_owned(), field(parameter.name))).collect();
    json_schema!({ "type": "object", "properties": fields, "additionalProperties": false })
}

impl ReportAxes {
    /// An example with all fields, for checks of a file's shape.
    pub(super) fn template() -> Self {
        Self {
            x: Some("omega_rpm".to_owned()),
            by: Some("mu".to_owned()),
            y: Vec::new(),
            scale: BTreeMap::new(),
        }
    }

    /// What is wrong with the parameters. The names of quantities are not known here.
    pub(super) fn problems(&self, source: &SourceText) -> Vec<Problem> {
        let mut problems = Vec::new();
        let axes = [("report.x", &self.x), ("report.by", &self.by)];
        let axes = axes.into_iter().filter_map(|(field, name)| Some((field.to_owned(), name.as_deref()?)));
        let scales = self.scale.keys().map(|name| (format!("report.scale.{name}"), name.as_str()));
        for (field, name) in axes.chain(scales) {
            if Parameter::find(name).is_some() || name == SOURCE {
                continue;
            }
            let mut problem = source.problem(&field, "no such parameter");
            problem.help.extend(nearest_name(name, names()).map(|name| format!("did you mean `{name}`?")));
            problem.help.push(format!("the parameters are {}", names().collect::<Vec<_>>().join(", ")));
            problems.push(problem);
        }
        if self.x.is_some() && self.x == self.by {
            problems.push(source.problem("report.by", "expected another parameter than report.x"));
        }
        problems
    }
}

//! Points that are no grid, as a study file has them.

use super::design::Design;
use crate::study::grid_schema::{distributions_schema, points_schema, zip_schema};
use crate::study::range::axis_length;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Points that are no grid, as a study file has them. Exactly one of `points`, `zip`, `file` and `design` is given.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(in crate::study) struct SamplesFile {
    /// The points one by one, each with a value for each of the same parameters.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "points_schema")]
    pub points: Option<Vec<Map<String, Value>>>,
    /// Lists or ranges of equal lengths: the first values of all are the first point, and so on.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "zip_schema")]
    pub zip: Option<Map<String, Value>>,
    /// A CSV file with a column for each parameter, relative to the folder of the study.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// How points are drawn from the distributions in `of`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub design: Option<Design>,
    /// Number of points of a design; of `morris`, the number of trajectories.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// Number of the design among those of its kind. Absent: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Parameters of a design with their distributions.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "distributions_schema")]
    pub of: Option<Map<String, Value>>,
}

impl SamplesFile {
    /// Number of points, as far as it can be known before they are read.
    pub fn length(&self) -> usize {
        let of_zip = || self.zip.as_ref()?.values().map(axis_length).max();
        let of_design = || {
            let parameters = self.of.as_ref().map_or(0, Map::len);
            Some(self.design?.points(self.count.unwrap_or(1), parameters))
        };
        self.points.as_ref().map(Vec::len).or_else(of_zip).or_else(of_design).unwrap_or(1).max(1)
    }
}

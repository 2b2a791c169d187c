//! How exact a result is to be.

use super::check::Violations;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How exact a result is to be. The job goes from mesh to mesh, up to that of the study, and ends on the first one whose error is small
/// enough. Each mesh has up to twice as many elements in each direction as the one before, and a run there starts from the limit cycle
/// of that one where it can.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object, for example { \"mu_star\": 0.01 } for 1 %")]
pub struct Accuracy {
    /// Largest error of μ\* by the mesh, relative to μ\*: 0.01 is 1 %.
    pub mu_star: f64,
}

impl Accuracy {
    pub(super) fn check(self, found: &mut Violations) {
        found.within("accuracy.mu_star", self.mu_star);
    }
}

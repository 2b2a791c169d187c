//! How exact a result is to be.

use super::check::Violations;
use super::{DiskKind, JobSpec};
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

impl JobSpec {
    /// What an accuracy needs: a steady state, and meshes that the program makes.
    pub(super) fn check_levels(&self, found: &mut Violations) {
        let refused = if self.scene.pin.own_elements().is_none() {
            "absent for a mesh from a file: the program makes no finer one of it"
        } else if !self.scene.program.is_constant() {
            "absent with scene.program: such a run has no steady state"
        } else if self.continuation.is_some() {
            "absent in a study with `continue`: its jobs begin in motions on one mesh"
        } else if self.scene.disk.kind == DiskKind::Elastic {
            "absent on an elastic disk, whose mesh has an error of its own"
        } else if !self.has_measured_elements() {
            "absent with large strains or another element than `full`: mesh errors were not measured with them"
        } else if !self.run.stop_early {
            "absent with run.stop_early = false: each mesh has as long a run as its own error needs"
        } else if self.numerics.time_step_s.is_some() {
            "absent with numerics.time_step_s: each mesh has its own time step"
        } else {
            return;
        };
        found.add("accuracy", "given", refused);
    }
}

//! A job that continues another one.

use super::check::Violations;
use serde::{Deserialize, Serialize};

/// That a job begins with the motion in which another one ended, and that its own last motion is kept for others.
///
/// Study files do not have this object: `continue` in a study makes such jobs.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Continuation {
    /// The key of the job that it continues; none for a job that begins at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parent: Option<String>,
    /// Root mean square \[m/s\] of the velocities that are added to the motion at the beginning.
    pub kick_m_s: f64,
    /// Which random velocities are added.
    pub kick_seed: u64,
}

impl Continuation {
    /// A job that begins at rest and can be continued.
    pub const ROOT: Self = Self { parent: None, kick_m_s: 0.0, kick_seed: 0 };

    pub(super) fn check(&self, found: &mut Violations) {
        if !(self.kick_m_s >= 0.0 && self.kick_m_s.is_finite()) {
            found.add("continuation.kick_m_s", self.kick_m_s, "a speed ≥ 0 m/s");
        }
    }
}

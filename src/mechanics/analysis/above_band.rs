//! What is known above the frequencies up to which modes were looked for.

use serde::{Deserialize, Serialize};

/// What is known about modes above the frequency up to which they were looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AboveBand {
    /// There is none: all modes of the mesh were looked for.
    Nothing,
    /// None grows: damping wins there, by an estimated bound.
    Damped,
    /// Nobody looked for one, but a run of the job on a coarser mesh, which carries such vibrations, decayed.
    CoarserRun,
    /// Nobody looked. A record of a version that did not say it counts as such.
    #[default]
    NotLookedAt,
}

impl AboveBand {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::Damped => "damped",
            Self::CoarserRun => "coarser_run",
            Self::NotLookedAt => "not_looked_at",
        }
    }

    /// Whether every mode that can grow is among those that were looked for.
    pub fn is_known(self) -> bool {
        matches!(self, Self::Nothing | Self::Damped)
    }
}

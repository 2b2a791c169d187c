//! How a job ended, and its contact regime.

use serde::{Deserialize, Serialize};

/// How a run ended, or what the eigenvalues say about a job without a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Outcome {
    /// A periodic steady state was reached.
    Periodic,
    /// The oscillation decays at a measured negative growth rate: sliding is stable.
    Decayed,
    /// The run reached its time limit first. The figures are averages over the last part of the run.
    NotPeriodic,
    /// The speed or the load changed in time, and the run reached its end. The figures are averages over the run after the load's
    /// ramp; those of its windows are beside them.
    Completed,
    /// A mode of steady sliding grows, and there was no run. The figures are those of steady sliding.
    Unstable,
}

impl Outcome {
    /// The name used in tables and CSV.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The name for a reader.
    pub fn label(self) -> &'static str {
        match self {
            Self::Periodic => "periodic",
            Self::Decayed => "decayed",
            Self::NotPeriodic => "not periodic",
            Self::Completed => "program completed",
            Self::Unstable => "unstable, without a run",
        }
    }
}

/// The contact regime, from the shares of node-time spent in each state over whole cycles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Regime {
    /// All nodes in contact slip, and the oscillation decays.
    Stable,
    /// Stick and slip, (almost) no separation.
    StickSlip,
    /// Stick, slip and separation.
    StickSlipSeparation,
    /// Slip and separation, (almost) no stick.
    SlipSeparation,
    /// (Almost) all nodes slip, but neither a decay nor a limit cycle was established.
    Undecided,
}

impl Regime {
    /// The name used in tables and CSV.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The name for a reader.
    pub fn label(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::StickSlip => "stick–slip",
            Self::StickSlipSeparation => "stick–slip–separation",
            Self::SlipSeparation => "slip–separation",
            Self::Undecided => "undecided",
        }
    }
}

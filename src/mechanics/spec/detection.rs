//! Thresholds by which a state counts as periodic or as decayed, and by which a regime gets its name.

use super::check::Violations;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// When a state counts as periodic or as decayed, and what names the regime.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Detection {
    /// Number of consecutive limit cycles over which the per-cycle figures are compared.
    pub cycles: usize,
    /// Largest spread of any per-cycle figure over these cycles: T/F, N/F and the state shares as they
    /// are; the period, the peak stress and the amplitude of N relative to their means. The share of plastic work may differ by as much of itself between the two
    /// halves of the cycles, unless it is at most 0.0001.
    pub tolerance: f64,
    /// Largest change of the mean of any per-cycle figure from the first to the second half of these cycles.
    pub drift_tolerance: f64,
    /// A contact state is named in the regime when its share of the node-time exceeds this.
    pub regime_threshold: f64,
    /// Shortest time (s) of uninterrupted sliding over which a decay is measured before it is believed. Absent in a study:
    /// 0.008 for the pin of the reference scene, in proportion to their slowest vibrations for other pins.
    pub decay_observation_s: f64,
}

impl Default for Detection {
    fn default() -> Self {
        Self {
            cycles: 20,
            tolerance: 0.01,
            drift_tolerance: 0.001,
            regime_threshold: 0.03,
            decay_observation_s: 0.008,
        }
    }
}

impl Detection {
    pub(super) fn check(&self, found: &mut Violations) {
        found.within("detection.cycles", self.cycles as f64);
        found.within("detection.tolerance", self.tolerance);
        found.within("detection.drift_tolerance", self.drift_tolerance);
        found.within("detection.regime_threshold", self.regime_threshold);
        found.within("detection.decay_observation_s", self.decay_observation_s);
    }
}

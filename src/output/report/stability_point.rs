//! The linear stability of steady sliding at one point.

use super::parameters::Parameters;
use crate::analysis::{ComplexMode, SlidingStability, UnknownError};
use serde_json::Value;

/// Steady sliding at one speed and one friction coefficient, and what its eigenvalues say.
#[derive(Debug, Clone, PartialEq)]
pub struct StabilityPoint {
    /// The parameters of the point.
    pub parameters: Parameters,
    /// Whether it is a point of the grid. The other ones refine thresholds.
    pub on_grid: bool,
    /// Why its modes could not be compared with those of a coarser mesh; `None` if they were.
    pub stands_alone: Option<UnknownError>,
    /// The eigenvalues.
    pub stability: SlidingStability,
}

impl StabilityPoint {
    /// The value of a parameter; null if the point has none of that name.
    pub fn parameter(&self, name: &str) -> Value {
        self.parameters.get(name).cloned().unwrap_or_default()
    }

    /// The mode that grows fastest, or decays slowest.
    pub fn leading(&self) -> Option<&ComplexMode> {
        leading(&self.stability)
    }
}

/// The mode that grows fastest, or decays slowest.
pub(super) fn leading(stability: &SlidingStability) -> Option<&ComplexMode> {
    let known = stability.modes.iter().filter(|mode| mode.growth_rate_per_s.is_finite());
    known.max_by(|a, b| a.growth_rate_per_s.total_cmp(&b.growth_rate_per_s))
}

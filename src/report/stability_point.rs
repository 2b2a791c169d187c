//! The linear stability of steady sliding at one point.

use super::parameters::{MU, OMEGA};
use crate::analysis::{ComplexMode, SlidingStability};
use serde_json::Value;

/// Steady sliding at one speed and one friction coefficient, and what its eigenvalues say.
#[derive(Debug, Clone, PartialEq)]
pub struct StabilityPoint {
    /// Disk speed ω in revolutions per minute.
    pub omega_rpm: f64,
    /// Local friction coefficient μ.
    pub mu: f64,
    /// The grid parameters by name, in the order of the study.
    pub parameters: Vec<(String, Value)>,
    /// Whether it is a point of the grid. The other ones refine thresholds.
    pub on_grid: bool,
    /// The eigenvalues.
    pub stability: SlidingStability,
}

impl StabilityPoint {
    /// The value of a parameter; null if the point has none of that name.
    pub fn parameter(&self, name: &str) -> Value {
        let further = || self.parameters.iter().find(|(own, _)| own == name).map(|(_, value)| value.clone());
        match name {
            OMEGA => self.omega_rpm.into(),
            MU => self.mu.into(),
            _ => further().unwrap_or(Value::Null),
        }
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

//! A complex mode in a record.

use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A complex mode of small vibrations about steady sliding.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ComplexMode {
    /// Frequency \[Hz\].
    pub frequency_hz: f64,
    /// Bound of the error \[Hz\] that the mesh makes; none if it is unknown.
    #[serde(default)]
    pub frequency_mesh_error_hz: Option<f64>,
    /// Growth rate \[1/s\]; negative if the mode decays.
    pub growth_rate_per_s: f64,
    /// Bound of the error \[1/s\] that the mesh makes; none if it is unknown.
    #[serde(default)]
    pub growth_rate_mesh_error_per_s: Option<f64>,
    /// Damping ratio ζ = −Re λ/|λ|.
    pub damping_ratio: f64,
    /// Residual of the full problem, relative.
    pub residual: f64,
    /// Whether the residual is within the tolerance.
    pub is_converged: bool,
}

impl ComplexMode {
    /// Whether the mode grows, or at least does not decay.
    pub fn grows(&self) -> bool {
        self.growth_rate_per_s >= 0.0
    }

    /// A converged mode without a residual, of whose error by the mesh nothing is known.
    pub fn of(frequency_hz: f64, growth_rate_per_s: f64) -> Self {
        let size_per_s = libm::hypot(TAU * frequency_hz, growth_rate_per_s);
        Self {
            frequency_hz,
            frequency_mesh_error_hz: None,
            growth_rate_per_s,
            growth_rate_mesh_error_per_s: None,
            damping_ratio: if size_per_s == 0.0 { 0.0 } else { -growth_rate_per_s / size_per_s },
            residual: 0.0,
            is_converged: true,
        }
    }
}

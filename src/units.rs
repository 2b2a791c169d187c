//! Conversions between customary units and SI.

use std::f64::consts::PI;

/// Angular speed [rad/s] of `omega_rpm` revolutions per minute.
pub fn rad_per_s_from_rpm(omega_rpm: f64) -> f64 {
    omega_rpm * (2.0 * PI / 60.0)
}

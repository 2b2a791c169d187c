//! Conversions to SI units, and durations in units for a reader.

use serde::Serializer;
use std::f64::consts::PI;
use std::time::Duration;

/// Angular speed [rad/s] of `omega_rpm` revolutions per minute.
pub fn rad_per_s_from_rpm(omega_rpm: f64) -> f64 {
    omega_rpm * (2.0 * PI / 60.0)
}

/// A duration of so many seconds for a reader, in the unit that fits it: `350 ms`, `12.5 s`, `3.8 min`, `2.5 h`,
/// `4.0 days`.
///
/// `decimals` is the number of decimals of seconds and minutes. Without decimals the smallest unit is the second: this
/// is for estimates. Hours and days always have one decimal.
pub fn duration_text(seconds: f64, decimals: usize) -> String {
    match seconds {
        s if s < 0.9995 && decimals > 0 => format!("{:.0} ms", s * 1e3),
        s if s < 120.0 => format!("{s:.decimals$} s"),
        s if s < 7200.0 => format!("{:.decimals$} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86_400.0),
    }
}

/// A duration as a number of seconds, for [`serde`].
///
/// # Errors
/// Those of the serializer.
pub fn as_seconds<S: Serializer>(duration: &Duration, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_f64(duration.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: every duration is in the unit that a reader expects, with and without decimals.
    #[test]
    fn durations_are_in_the_unit_that_fits() {
        let exact = [0.35, 12.5, 228.0, 9000.0, 345_600.0].map(|seconds| duration_text(seconds, 1));
        assert_eq!(exact, ["350 ms", "12.5 s", "3.8 min", "2.5 h", "4.0 days"]);
        let rough = [0.0, 40.2, 228.0, 9000.0].map(|seconds| duration_text(seconds, 0));
        assert_eq!(rough, ["0 s", "40 s", "4 min", "2.5 h"]);
    }
}

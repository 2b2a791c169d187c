//! Violations of physical or numerical limits, with the field, its value and what would be right.

use std::fmt;

/// One value that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldError {
    /// Path of the field below the job, e.g. `scene.pin.poisson_ratio`.
    pub field: String,
    /// The value as given.
    pub value: String,
    /// What would be right.
    pub expected: String,
}

impl fmt::Display for FieldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}: expected {}", self.field, self.value, self.expected)
    }
}

/// All violations found in one job; never empty when returned as an error.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Violations(pub Vec<FieldError>);

impl Violations {
    /// Records that `field` has the unusable `value`.
    pub fn add(&mut self, field: &str, value: impl fmt::Display, expected: impl Into<String>) {
        self.0.push(FieldError {
            field: field.to_owned(),
            value: value.to_string(),
            expected: expected.into(),
        });
    }

    /// Records a violation unless `value` is finite and `holds`.
    pub fn require(&mut self, field: &str, value: f64, holds: bool, expected: &str) {
        if !(value.is_finite() && holds) {
            self.add(field, readable(value), expected);
        }
    }

    /// Records a violation unless `value` is a positive quantity that can be computed with: see [`MAGNITUDES`].
    pub fn require_magnitude(&mut self, field: &str, value: f64, expected: &str) {
        let (low, high) = (*MAGNITUDES.start(), *MAGNITUDES.end());
        if value.is_finite() && value > 0.0 && !MAGNITUDES.contains(&value) {
            self.add(field, readable(value), format!("{expected}, from {low:e} to {high:e}"));
        } else {
            self.require(field, value, value > 0.0, expected);
        }
    }

    /// Records a violation if `value`, otherwise good, is too large to be computed with: see [`MAGNITUDES`].
    pub fn at_most(&mut self, field: &str, value: f64) {
        let highest = *MAGNITUDES.end();
        if value.is_finite() && value > highest {
            self.add(field, readable(value), format!("at most {highest:e}"));
        }
    }

    /// `Ok` when nothing was found.
    ///
    /// # Errors
    /// The violations themselves.
    pub fn into_result(self) -> Result<(), Self> {
        if self.0.is_empty() { Ok(()) } else { Err(self) }
    }
}

/// Positive quantities in SI units beyond these ends belong to no pin. Within them all that the solver forms of
/// them (squares of forces and speeds, masses, stiffness over mass) stays far inside the range of f64; beyond,
/// a frequency can overflow before the first step.
const MAGNITUDES: std::ops::RangeInclusive<f64> = 1.0e-20..=1.0e20;

/// A number without the zeros that plain notation spends on small and large ones.
pub(super) fn readable(value: f64) -> String {
    if value == 0.0 || (1.0e-4..1.0e7).contains(&value.abs()) || !value.is_finite() {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

impl fmt::Display for Violations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, violation) in self.0.iter().enumerate() {
            if i > 0 {
                f.write_str("; ")?;
            }
            violation.fmt(f)?;
        }
        Ok(())
    }
}

impl std::error::Error for Violations {}

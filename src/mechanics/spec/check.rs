//! Violations of physical or numerical limits: the field, its value and the expectation.

use super::limit::{Limit, MAGNITUDES};
use std::fmt;

/// One value that violates a limit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldError {
    /// Path of the field from the job's root, e.g. `scene.pin.poisson_ratio`.
    pub field: String,
    /// The value as given.
    pub value: String,
    /// What is expected instead.
    pub expected: String,
}

impl fmt::Display for FieldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}: expected {}", self.field, self.value, self.expected)
    }
}

/// All violations of one job; never empty when returned as an error.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Violations(pub Vec<FieldError>);

impl Violations {
    /// Records that `field` has the unusable `value`.
    pub(super) fn add(&mut self, field: &str, value: impl fmt::Display, expected: impl Into<String>) {
        self.0.push(FieldError {
            field: field.to_owned(),
            value: value.to_string(),
            expected: expected.into(),
        });
    }

    /// Records a violation unless `value` is finite and `holds`.
    pub(super) fn require(&mut self, field: &str, value: f64, holds: bool, expected: &str) {
        if !(value.is_finite() && holds) {
            self.add(field, readable(value), expected);
        }
    }

    /// Records a violation unless `value` is within the [limit](Limit) of `field`. Returns whether it is.
    ///
    /// # Panics
    /// If the field has no limit.
    pub(super) fn within(&mut self, field: &str, value: f64) -> bool {
        let limit = Limit::of(field).unwrap_or_else(|| panic!("{field} has no limit"));
        let holds = limit.holds(value);
        if !holds {
            self.add(field, readable(value), limit.expected(value));
        }
        holds
    }

    /// As [`Self::within`], if there is a value.
    pub(super) fn within_if_given(&mut self, field: &str, value: Option<f64>) {
        if let Some(value) = value {
            self.within(field, value);
        }
    }

    /// Records a violation if `value` exceeds the upper end of [`MAGNITUDES`].
    pub(super) fn limit_magnitude(&mut self, field: &str, value: f64) {
        let highest = *MAGNITUDES.end();
        if value.is_finite() && value > highest {
            self.add(field, readable(value), format!("at most {highest:e}"));
        }
    }

    /// `Ok` when there is no violation, otherwise the violations as the error.
    pub(super) fn into_result(self) -> Result<(), Self> {
        if self.0.is_empty() { Ok(()) } else { Err(self) }
    }
}

/// The number in plain notation, or with an exponent where plain notation would have many zeros.
pub(super) fn readable(value: f64) -> String {
    if value == 0.0 || (1.0e-4..1.0e7).contains(&value.abs()) || !value.is_finite() {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// A computed number with at most four significant digits, which are enough to choose a value by.
pub(crate) fn short(value: f64) -> String {
    readable(format!("{value:.3e}").parse().unwrap_or(value))
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

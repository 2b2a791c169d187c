//! Damping as people know it: a ratio at a frequency, or the β₂ of a scheme at its time step.

use super::json::present;
use crate::spec::{FieldError, Limit, Numerics};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Damping at one frequency, by a damping ratio or by a loss factor, or the damping of the β₂ method at a time step. It gives
/// `numerics.beta_r_s`: damping in proportion to the stiffness, C = `β_R` K, has ζ(f) = `β_R` π f, so at other frequencies it is
/// in proportion to them. The β₂ method has the damping `β_R` = (β₂ − ½) Δt, which depends on the time step, and so on the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Damping {
    /// Damping ratio ζ of a mode at `frequency_hz`, as a fraction of critical damping, 0 ≤ ζ < 1.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub ratio: Option<f64>,
    /// Loss factor η = 2 ζ at `frequency_hz`, 0 ≤ η < 2; instead of `ratio`.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub loss_factor: Option<f64>,
    /// Frequency (Hz) at which the ratio or the loss factor holds.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub frequency_hz: Option<f64>,
    /// β₂ of a scheme whose damping the job has, ½ ≤ β₂ ≤ 1; with `at_time_step_s` instead of a ratio and a frequency.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub beta2: Option<f64>,
    /// Time step (s) at which the scheme has this damping. The job's own time step may be another one.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(with = "f64")]
    pub at_time_step_s: Option<f64>,
}

/// A refused value of a field.
fn refused(field: &str, value: f64, expected: impl Into<String>) -> FieldError {
    FieldError { field: field.to_owned(), value: value.to_string(), expected: expected.into() }
}

impl Damping {
    /// Sets `β_R` \[s\]: ζ / (π f), or (β₂ − ½) Δt.
    ///
    /// # Errors
    /// If a value is missing or out of its range, or if `gives_beta_r` says that `β_R` is given as well. Then nothing is
    /// set.
    pub(super) fn fill(self, numerics: &mut Numerics, gives_beta_r: bool) -> Result<(), FieldError> {
        if gives_beta_r {
            let expected = "either this or damping, not both: each gives β_R";
            return Err(refused("numerics.beta_r_s", numerics.beta_r_s, expected));
        }
        let given = [
            ("damping.ratio", self.ratio),
            ("damping.loss_factor", self.loss_factor),
            ("damping.frequency_hz", self.frequency_hz),
            ("damping.beta2", self.beta2),
            ("damping.at_time_step_s", self.at_time_step_s),
        ];
        let given: Vec<_> = given.into_iter().filter_map(|(field, value)| Some((field, value?))).collect();
        for &(field, value) in &given {
            if let Some(limit) = Limit::of(field).filter(|limit| !limit.holds(value)) {
                return Err(refused(field, value, limit.expected(value)));
            }
        }
        let Some(&(first, value)) = given.first() else {
            let expected =
                "a ratio or a loss_factor, and frequency_hz; or beta2 and at_time_step_s".to_owned();
            return Err(FieldError { field: "damping".to_owned(), value: "{}".to_owned(), expected });
        };
        let expected = match (
            self.ratio.or(self.loss_factor),
            self.frequency_hz,
            self.beta2,
            self.at_time_step_s,
        ) {
            _ if self.ratio.is_some() && self.loss_factor.is_some() => {
                let expected = "either this or damping.ratio, not both: the loss factor is twice the ratio";
                return Err(refused("damping.loss_factor", given[1].1, expected));
            }
            (Some(_), Some(frequency_hz), None, None) => {
                let ratio = self.ratio.or(self.loss_factor.map(|loss| loss / 2.0)).unwrap_or_default();
                numerics.beta_r_s = ratio / (PI * frequency_hz);
                return Ok(());
            }
            (None, None, Some(beta2), Some(time_step_s)) => {
                numerics.beta_r_s = (beta2 - 0.5) * time_step_s;
                return Ok(());
            }
            (Some(_), None, None, None) => "the frequency too at which it holds: damping.frequency_hz",
            (None, Some(_), None, None) => "a damping ratio or a loss factor too: ratio or loss_factor",
            (None, None, Some(_), None) => {
                "the time step too at which the scheme has it: damping.at_time_step_s"
            }
            (None, None, None, Some(_)) => "the scheme's β₂ too: damping.beta2",
            _ => "either this with what belongs to it, or beta2 and at_time_step_s, not both: each gives β_R",
        };
        Err(refused(first, value, expected))
    }
}

//! Damping as it is measured: a ratio at a frequency.

use super::json::present;
use crate::spec::{FieldError, Limit, Numerics};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Damping at one frequency, by a damping ratio or by a loss factor. It gives `numerics.beta_r_s`: damping in proportion to
/// the stiffness, C = `β_R` K, has ζ(f) = `β_R` π f, so at other frequencies it is in proportion to them.
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
}

impl Damping {
    /// Sets `β_R` = ζ / (π f) \[s\].
    ///
    /// # Errors
    /// If a value is missing or out of its range, or if `gives_beta_r` says that `β_R` is given as well. Then nothing is
    /// set.
    pub(super) fn fill(self, numerics: &mut Numerics, gives_beta_r: bool) -> Result<(), FieldError> {
        let refuse = |field: &str, value: String, expected: &str| {
            Err(FieldError { field: field.to_owned(), value, expected: expected.to_owned() })
        };
        if gives_beta_r {
            let value = numerics.beta_r_s.to_string();
            return refuse("numerics.beta_r_s", value, "either this or damping, not both: each gives β_R");
        }
        let ratio = match (self.ratio, self.loss_factor) {
            (Some(_), Some(loss)) => {
                let expected = "either this or damping.ratio, not both: the loss factor is twice the ratio";
                return refuse("damping.loss_factor", loss.to_string(), expected);
            }
            (None, None) => {
                let expected = "a damping ratio or a loss factor too: ratio or loss_factor";
                return match self.frequency_hz {
                    Some(frequency_hz) => refuse("damping.frequency_hz", frequency_hz.to_string(), expected),
                    None => refuse("damping", "{}".to_owned(), "a ratio or a loss_factor, and frequency_hz"),
                };
            }
            (Some(ratio), None) => ratio,
            (None, Some(loss)) => loss / 2.0,
        };
        let given = [
            ("damping.ratio", self.ratio),
            ("damping.loss_factor", self.loss_factor),
            ("damping.frequency_hz", self.frequency_hz),
        ];
        let outside = given.into_iter().find_map(|(field, value)| {
            Some((field, value?, Limit::of(field).filter(|limit| !limit.holds(value.unwrap_or_default()))?))
        });
        if let Some((field, value, limit)) = outside {
            return refuse(field, value.to_string(), &limit.expected(value));
        }
        let Some(frequency_hz) = self.frequency_hz else {
            let expected = "the frequency too at which it holds: damping.frequency_hz";
            return match self.loss_factor {
                Some(loss) => refuse("damping.loss_factor", loss.to_string(), expected),
                None => refuse("damping.ratio", ratio.to_string(), expected),
            };
        };
        numerics.beta_r_s = ratio / (PI * frequency_hz);
        Ok(())
    }
}

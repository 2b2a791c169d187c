//! A range of values of a parameter.

use schemars::JsonSchema;
use serde::Deserialize;

/// Evenly spaced values of a parameter.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Range {
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Number of values including both ends: at least 2, or 1 when `from` equals `to`.
    #[schemars(range(min = 1))]
    pub count: usize,
    /// Equal steps (the default) or equal ratios.
    #[serde(default)]
    pub spacing: Spacing,
}

/// How the values of a range are spaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, serde::Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Spacing {
    /// Equal steps.
    #[default]
    Linear,
    /// Equal ratios; both ends must be > 0.
    Log,
}

impl Range {
    /// The ends exactly as given, and the values between them rounded to 12 significant digits. So the range from 0.1
    /// to 0.6 contains 0.3 and not 0.30000000000000004, and its job is the same job as that of a listed 0.3.
    pub(super) fn values(&self) -> Vec<f64> {
        let last = self.count - 1;
        let between = |step: usize| {
            let share = step as f64 / last as f64;
            let value = match self.spacing {
                Spacing::Linear => self.from * (1.0 - share) + self.to * share,
                Spacing::Log => (self.from.ln() * (1.0 - share) + self.to.ln() * share).exp(),
            };
            format!("{value:.11e}").parse().unwrap_or(value)
        };
        let value = |step| match step {
            0 => self.from,
            step if step == last => self.to,
            step => between(step),
        };
        (0..self.count).map(value).collect()
    }
}

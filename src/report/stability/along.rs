//! The parameter along which sliding becomes unstable.

use crate::report::parameters::{MU, OMEGA};
use std::sync::LazyLock;

/// What thresholds are thresholds of: a number that the study varies, with the parameters that move with it.
#[derive(Debug, Clone, PartialEq)]
pub struct Along {
    /// The parameter.
    pub parameter: String,
    /// The other parameters of its `zip`, whose values move with it.
    pub with: Vec<String>,
}

impl Along {
    /// Along μ alone.
    pub fn mu() -> Self {
        Self { parameter: MU.to_owned(), with: Vec::new() }
    }

    /// Whether a parameter changes along it.
    pub fn moves(&self, name: &str) -> bool {
        self.parameter == name || self.with.iter().any(|with| with == name)
    }

    /// Whether it is μ.
    pub fn is_mu(&self) -> bool {
        self.parameter == MU
    }

    /// The parameter along the other axis of figures and tables: ω, unless the thresholds are those of ω.
    pub fn across(&self) -> &'static str {
        if self.parameter == OMEGA { MU } else { OMEGA }
    }

    /// The name of the threshold in tables.
    pub fn threshold(&self) -> String {
        if self.is_mu() { "mu_c".to_owned() } else { format!("{}_c", self.parameter) }
    }
}

static DEFAULT: LazyLock<Along> = LazyLock::new(Along::mu);

impl Default for &Along {
    fn default() -> Self {
        &DEFAULT
    }
}

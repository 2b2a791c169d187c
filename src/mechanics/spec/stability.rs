//! How a job finds out whether its steady sliding is stable.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use strum::{EnumString, IntoStaticStr, VariantArray};

/// How a job finds out whether its steady sliding is stable.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, JsonSchema, EnumString, IntoStaticStr, VariantArray,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum StabilityMethod {
    /// The run decides: the job is stable if its oscillation decays.
    #[default]
    Simulate,
    /// The eigenvalues of steady sliding decide, if they are far enough from the threshold; the run decides the rest.
    Eigenvalues,
    /// Only the eigenvalues are computed. There is no run, so there is no limit cycle either.
    #[schemars(skip)]
    Modes,
}

impl StabilityMethod {
    /// The methods that a study file can name.
    pub const OF_FILES: [&str; 2] = ["eigenvalues", "simulate"];

    /// The name used in study files, for example `eigenvalues`.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// Messages name only the methods that a study file can name.
impl<'de> Deserialize<'de> for StabilityMethod {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = std::borrow::Cow::<str>::deserialize(deserializer)?;
        name.parse().map_err(|_| serde::de::Error::unknown_variant(&name, &Self::OF_FILES))
    }
}

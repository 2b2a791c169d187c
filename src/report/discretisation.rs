//! The error that mesh, time step and detection of a job make, as far as it was measured.

use crate::publish::value::significant;
use std::fmt::{self, Display, Formatter};
use std::sync::Arc;

/// What is known about the error that mesh, time step and detection of a job make.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Discretisation {
    /// Nothing.
    #[default]
    NotMeasured,
    /// It was measured on the job's own scene.
    Measured(Arc<MeshError>),
    /// It was measured on another scene, at another μ or at other speeds. Here it may be another one.
    Indicative(Arc<MeshError>),
}

/// The error that was measured with a mesh, a time step and a detection that are at most as fine as the job's.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeshError {
    /// Largest error of μ\*, relative to μ\*.
    pub mu_star_relative: f64,
    /// Largest error of the frequency, relative to it.
    pub frequency_relative: f64,
    /// The preset that was measured.
    pub preset: String,
    /// Where it was measured, in words.
    pub measured_at: String,
}

impl Discretisation {
    /// The measured error, whether or not it is of the job's own scene.
    pub fn error(&self) -> Option<&MeshError> {
        match self {
            Self::NotMeasured => None,
            Self::Measured(error) | Self::Indicative(error) => Some(error),
        }
    }
}

/// The words for an error that is not measured.
pub(super) const NOT_MEASURED: &str =
    "the error is not measured. Compare with a finer mesh before you use the numbers.";

impl Display for MeshError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let percent = |share: f64| significant(100.0 * share, 2);
        write!(
            f,
            "up to {} % of μ* and {} % of the frequency, as measured with the preset {} {}.",
            percent(self.mu_star_relative),
            percent(self.frequency_relative),
            self.preset,
            self.measured_at
        )
    }
}

impl Display for Discretisation {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotMeasured => write!(f, "Mesh and time step: {NOT_MEASURED}"),
            Self::Measured(error) => write!(f, "Mesh and time step: {error}"),
            Self::Indicative(error) => write!(
                f,
                "Mesh and time step: {error} This is indicative only: scene, friction or speed are others."
            ),
        }
    }
}

//! The error that the mesh makes, from the same job on a coarser mesh.
//!
//! A result f on elements of the size h and the result c of the coarser mesh, whose elements are r times as large, have the errors e h^p
//! and e (r h)^p if the error is of order p. Then f is off by (f − c)/(r^p − 1). Contact that opens, closes and sticks leaves no clean
//! order, so p is taken as 1, and the whole is multiplied by a factor that covers the errors of many scenes.

use super::outcome::Outcome;
use super::record::JobRecord;
use crate::spec::Accuracy;
use serde::{Deserialize, Serialize};

/// What the mesh adds to the uncertainty of a result. The bounds hold for 95 % of jobs (docs/mesh_errors.md).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MeshError {
    /// Bound of the absolute error of μ\*.
    pub mu_star: f64,
    /// Bound of the absolute error \[Hz\] of the frequency; none if there is no limit cycle.
    pub frequency_hz: Option<f64>,
    /// μ\* extrapolated to fine meshes; none where this is not better than μ\* itself.
    pub mu_star_extrapolated: Option<f64>,
}

/// Why the error of the mesh is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnknownError {
    /// The run has no steady state whose error could be estimated.
    NoSteadyState,
    /// The job did not run on a coarser mesh.
    NoCoarserMesh,
    /// The run on the coarser mesh failed.
    CoarserFailed,
    /// The run on the coarser mesh ended in another way.
    OtherOutcome,
    /// An earlier version did not keep what is needed of the run on the coarser mesh.
    OldRecord,
    /// The clamp has another width on the coarser mesh.
    OtherClamp,
    /// The coarser mesh has another regime.
    OtherRegime,
    /// The frequency on the coarser mesh is another one.
    OtherFrequency,
}

impl UnknownError {
    /// The reason in words.
    pub fn reason(self) -> &'static str {
        match self {
            Self::NoSteadyState => "no steady state",
            Self::NoCoarserMesh => "no run on a coarser mesh",
            Self::CoarserFailed => "the run on the coarser mesh failed",
            Self::OtherOutcome => "another outcome on the coarser mesh",
            Self::OldRecord => "a run on a coarser mesh of which an earlier version kept too little",
            Self::OtherClamp => "another width of the clamp on the coarser mesh",
            Self::OtherRegime => "another regime on the coarser mesh",
            Self::OtherFrequency => "another frequency on the coarser mesh",
        }
    }
}

/// Frequencies that differ by a larger share belong to different limit cycles.
const SAME_FREQUENCY: f64 = 0.01;

/// What a bound is made of: so many times the difference that an error of first order leaves, and a share of the value, below which a
/// difference says nothing.
struct Bound {
    factor: f64,
    least_share: f64,
}

impl Bound {
    /// The bound of the error of `fine`, from the value `coarse` on elements that are `ratio` times as large.
    fn of(&self, fine: f64, coarse: f64, ratio: f64) -> f64 {
        self.factor * (fine - coarse).abs() / (ratio - 1.0) + self.least_share * fine.abs()
    }
}

/// `scripts/mesh_errors.py` finds these numbers, and its page shows what they cover.
const MU_STAR: Bound = Bound { factor: 1.0, least_share: 0.005 };
const FREQUENCY: Bound = Bound { factor: 1.0, least_share: 0.002 };

impl JobRecord {
    /// The record with whether its error is as small as a job asks for.
    #[must_use]
    pub(super) fn judged_by(mut self, accuracy: Option<Accuracy>) -> Self {
        let reaches = |asked: Accuracy| {
            self.mesh_error().is_ok_and(|error| error.mu_star <= asked.mu_star * self.mu_star.abs())
        };
        self.accuracy_reached = accuracy.map(reaches);
        self
    }

    /// The error that the mesh makes.
    ///
    /// # Errors
    /// Why it is not known.
    pub fn mesh_error(&self) -> Result<MeshError, UnknownError> {
        if !matches!(self.outcome, Outcome::Periodic | Outcome::Decayed) {
            return Err(UnknownError::NoSteadyState);
        }
        let coarser = self.start.as_ref().ok_or(UnknownError::NoCoarserMesh)?;
        let outcome = coarser.outcome.ok_or(UnknownError::CoarserFailed)?;
        if outcome != self.outcome {
            return Err(UnknownError::OtherOutcome);
        }
        let known = (self.elements, coarser.regime, coarser.same_clamp, coarser.mu_star);
        let (Some(elements), Some(regime), Some(same_clamp), Some(mu_star)) = known else {
            return Err(UnknownError::OldRecord);
        };
        if !same_clamp {
            return Err(UnknownError::OtherClamp);
        }
        if regime != self.regime {
            return Err(UnknownError::OtherRegime);
        }
        let ratio = ratio(elements, coarser.elements);
        let frequency_hz = match (self.frequency_hz, coarser.frequency_hz) {
            (Some(fine), Some(coarse)) => {
                if (coarse - fine).abs() > SAME_FREQUENCY * fine {
                    return Err(UnknownError::OtherFrequency);
                }
                Some(FREQUENCY.of(fine, coarse, ratio))
            }
            _ => None,
        };
        Ok(MeshError {
            mu_star: MU_STAR.of(self.mu_star, mu_star, ratio),
            frequency_hz,
            mu_star_extrapolated: None,
        })
    }
}

/// The ratio of the sizes of elements of a coarser mesh and of the job's own.
fn ratio(own: [usize; 3], coarser: [usize; 3]) -> f64 {
    let count = |elements: [usize; 3]| elements.map(|n| n as f64).iter().product::<f64>();
    libm::cbrt(count(own) / count(coarser))
}

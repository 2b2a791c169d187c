//! The error that the mesh makes, from the same job on a coarser mesh.
//!
//! A result f on elements of the size h and the result c of the coarser mesh, whose elements are r times as large, have the errors e h^p
//! and e (r h)^p if the error is of order p. Then f is off by (f − c)/(r^p − 1). Contact that opens, closes and sticks leaves no clean
//! order: some differences are small by chance. So the bound takes p = 1 and adds a share of the value that falls with the mesh. Its
//! numbers are those that cover the errors of many scenes (docs/mesh_errors.md).

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

/// What a bound is made of: the difference that an error of first order leaves, and a share of the value that covers differences which are
/// small by chance.
struct Bound {
    /// The share on a mesh of [`Self::MESH`] elements in the mean direction. It falls with the third power of this number.
    share: f64,
}

impl Bound {
    /// Elements of the mean direction, which is the cube root of their number, of a mesh on which the share is as given.
    const MESH: f64 = 24.0;

    /// The bound of the error of `fine`, from the value `coarse` on elements that are `ratio` times as large.
    fn of(&self, fine: f64, coarse: f64, ratio: f64, elements: [usize; 3]) -> f64 {
        let share = self.share * Self::MESH.powi(3) / count(elements);
        (fine - coarse).abs() / (ratio - 1.0) + share * fine.abs()
    }
}

/// `scripts/mesh_errors.py` checks these numbers, and its page shows what they cover.
const MU_STAR: Bound = Bound { share: 0.023 };
const FREQUENCY: Bound = Bound { share: 0.004 };

/// Error of μ\* of steady sliding, relative to μ\*. It depends on the mesh only by where along the curved track the pressure is.
const STEADY_SLIDING: f64 = 2.0e-4;

/// μ\* is extrapolated as if its error had the order 2, where this is better for most jobs: where the two meshes differ by at most
/// this share.
const EXTRAPOLATED_SHARE: f64 = 0.04;

impl JobRecord {
    /// The record with whether its error is as small as a job asks for.
    #[must_use]
    pub(super) fn judged_by(mut self, accuracy: Option<Accuracy>) -> Self {
        // One mesh alone says nothing of its error, also not whether sliding is stable on finer ones.
        let reaches = |asked: Accuracy| {
            let is_small = |error: MeshError| error.mu_star <= asked.mu_star * self.mu_star.abs();
            self.start.is_some() && self.mesh_error().is_ok_and(is_small)
        };
        self.accuracy_reached = accuracy.map(reaches);
        self
    }

    /// The error that the mesh makes.
    ///
    /// # Errors
    /// Why it is not known.
    pub fn mesh_error(&self) -> Result<MeshError, UnknownError> {
        match self.outcome {
            Outcome::Periodic => {}
            Outcome::Decayed => return self.error_of_sliding(),
            _ => return Err(UnknownError::NoSteadyState),
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
        let ratio = libm::cbrt(count(elements) / count(coarser.elements));
        let (Some(fine), Some(coarse)) = (self.frequency_hz, coarser.frequency_hz) else {
            return Err(UnknownError::OtherFrequency);
        };
        if (coarse - fine).abs() > SAME_FREQUENCY * fine {
            return Err(UnknownError::OtherFrequency);
        }
        let difference = self.mu_star - mu_star;
        let is_small = difference.abs() <= EXTRAPOLATED_SHARE * self.mu_star.abs();
        Ok(MeshError {
            mu_star: MU_STAR.of(self.mu_star, mu_star, ratio, elements),
            frequency_hz: Some(FREQUENCY.of(fine, coarse, ratio, elements)),
            mu_star_extrapolated: is_small.then(|| self.mu_star + difference / (ratio * ratio - 1.0)),
        })
    }

    /// The error of steady sliding, which the coarser mesh must not contradict.
    fn error_of_sliding(&self) -> Result<MeshError, UnknownError> {
        match self.start.as_ref().and_then(|coarser| coarser.outcome) {
            Some(Outcome::Periodic) => Err(UnknownError::OtherOutcome),
            _ => Ok(MeshError {
                mu_star: STEADY_SLIDING * self.mu_star.abs(),
                frequency_hz: None,
                mu_star_extrapolated: None,
            }),
        }
    }
}

fn count(elements: [usize; 3]) -> f64 {
    elements.map(|n| n as f64).iter().product()
}

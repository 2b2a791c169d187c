//! The error that the mesh makes, from the same job on a coarser mesh.
//!
//! A result f on elements of the size h and the result c of the coarser mesh, whose elements are r times as large, have the errors e h^p
//! and e (r h)^p if the error is of order p. Then f is off by (f − c)/(r^p − 1). Contact that opens, closes and sticks leaves no clean
//! order: some differences are small by chance. So the bound takes p = 1 and adds a share of the value that falls with the mesh. Its
//! numbers are those that cover the errors of many scenes (docs/evidence/mesh_errors.md).

use super::drive::drive;
use super::mode::ComplexMode;
use super::outcome::Outcome;
use super::record::JobRecord;
use crate::solver::Model;
use crate::spec::{Accuracy, DiskKind, JobSpec};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// What the mesh adds to the uncertainty of a result. The bounds are chosen to hold for 95 % of jobs (docs/evidence/mesh_errors.md).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MeshError {
    /// Bound of the absolute error of μ\*.
    pub mu_star: f64,
    /// Bound of the absolute error \[Hz\] of the frequency; none if there is no limit cycle.
    pub frequency_hz: Option<f64>,
    /// μ\* extrapolated to fine meshes; none where this is not better than μ\* itself.
    pub mu_star_extrapolated: Option<f64>,
}

/// Why the mesh error is not known.
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
    /// An earlier version did not keep what is needed.
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
            Self::OldRecord => "a result of an earlier version, which kept too little",
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
        first_order(fine - coarse, ratio) + share * fine.abs()
    }
}

/// `scripts/mesh_errors.py` checks these numbers, and its page shows what they cover.
const MU_STAR: Bound = Bound { share: 0.04 };
const FREQUENCY: Bound = Bound { share: 0.004 };

/// The share of the angular frequency of a mode of steady sliding in the bounds of its frequency and its growth rate. It does not fall with
/// the mesh: where nodes lift off changes from mesh to mesh.
const MODE_SHARE: f64 = 0.0015;

/// Modes whose frequencies differ by a larger share are different ones.
const SAME_MODE: f64 = 0.03;

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
            // The modes alone have μ* of steady sliding, whether it is stable or not.
            Outcome::Decayed | Outcome::Unstable => return self.error_of_sliding(),
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

    /// Why the modes could not be compared with those of a coarser mesh; `None` if they were.
    pub fn why_modes_stand_alone(&self) -> Option<UnknownError> {
        match &self.start {
            Some(coarser) if coarser.same_clamp == Some(false) => Some(UnknownError::OtherClamp),
            Some(coarser) if coarser.same_clamp == Some(true) && !coarser.modes.is_empty() => None,
            _ => Some(UnknownError::NoCoarserMesh),
        }
    }

    /// The record of modes with their errors, from those of the coarser mesh. The error of a mode that is not clearly the same one there
    /// stays unknown.
    #[must_use]
    pub(super) fn with_errors_of_modes(mut self) -> Self {
        if self.why_modes_stand_alone().is_some() {
            return self;
        }
        let (Some(elements), Some(coarser), Some(stability)) =
            (self.elements, &self.start, &mut self.stability)
        else {
            return self;
        };
        let ratio = libm::cbrt(count(elements) / count(coarser.elements));
        let own = stability.modes.clone();
        for mode in &mut stability.modes {
            let Some(coarse) = same_mode(mode, &coarser.modes) else { continue };
            if same_mode(coarse, &own) != Some(&*mode) {
                continue;
            }
            let share_hz = MODE_SHARE * mode.frequency_hz;
            let difference_hz = mode.frequency_hz - coarse.frequency_hz;
            let difference_per_s = mode.growth_rate_per_s - coarse.growth_rate_per_s;
            mode.frequency_mesh_error_hz = Some(first_order(difference_hz, ratio) + share_hz);
            mode.growth_rate_mesh_error_per_s = Some(first_order(difference_per_s, ratio) + TAU * share_hz);
        }
        self
    }

    /// The error of steady sliding, which the coarser mesh must not contradict.
    fn error_of_sliding(&self) -> Result<MeshError, UnknownError> {
        match self.start.as_ref().and_then(|coarser| coarser.outcome) {
            Some(Outcome::Periodic) => Err(UnknownError::OtherOutcome),
            _ => Ok(MeshError {
                mu_star: self.sliding_mesh_error.ok_or(UnknownError::OldRecord)?,
                frequency_hz: None,
                mu_star_extrapolated: None,
            }),
        }
    }
}

/// Places in each direction of the face at which friction is evaluated. The number is odd, so that the middle of the track is one of them.
const PLACES: usize = 33;

/// Bound of the error that the mesh makes in μ\* of steady sliding. All nodes in contact slip, so μ\* is a mean of the friction along the
/// track, weighted with the pressure, and cannot be off by more than the range of this friction over the face. A mesh has the pressure of a
/// flat base in the wrong place by less than an element, so there the bound is the range over the smaller number of elements across the face.
/// A base with waves may bear on other crests on another mesh, an elastic disk has a mesh of its own, and a mesh from a file may have elements
/// of any size: there it is the whole range.
pub(super) fn error_of_sliding(spec: &JobSpec, model: &Model) -> f64 {
    let drive = drive(spec);
    let along_track = |[x, y]: [f64; 2]| {
        let motion = libm::hypot(x, y);
        let mu = drive.law.steady(motion * drive.rate.abs()).map_or(drive.law.mu(), |[mu, _]| mu);
        if motion == 0.0 { mu } else { mu * y / motion }
    };
    // The motion of the target is linear over the face, so that its places are those of a box of motions.
    let axis = |axis: usize| {
        let ends = range(model.slaves().iter().map(move |node| node.surface_motion[axis]));
        (0..PLACES).map(move |k| ends[0] + (ends[1] - ends[0]) * (k as f64 / (PLACES - 1) as f64))
    };
    let [least, most] = range(axis(0).flat_map(|x| axis(1).map(move |y| [x, y])).map(along_track));
    let pin = &spec.scene.pin;
    let is_resolved = pin.base.is_flat() && spec.scene.disk.kind == DiskKind::Rigid;
    let elements = pin.own_elements().filter(|_| is_resolved).map_or(1, |[nx, ny, _]| nx.min(ny));
    (most - least) / elements as f64
}

/// The smallest and the largest of some numbers.
fn range(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], own| [least.min(own), most.max(own)])
}

/// The mode of `modes` that is nearest to a mode, if its frequency is near enough.
fn same_mode<'a>(mode: &ComplexMode, modes: &'a [ComplexMode]) -> Option<&'a ComplexMode> {
    let distance = |other: &ComplexMode| {
        let angular_per_s = TAU * (other.frequency_hz - mode.frequency_hz);
        libm::hypot(angular_per_s, other.growth_rate_per_s - mode.growth_rate_per_s)
    };
    let is_near = |other: &&ComplexMode| {
        (other.frequency_hz - mode.frequency_hz).abs()
            <= SAME_MODE * mode.frequency_hz.min(other.frequency_hz)
    };
    let is_vibration = |mode: &&ComplexMode| mode.frequency_hz > 0.0;
    let near = modes.iter().filter(is_vibration).filter(is_near);
    near.min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// The error that a difference of two meshes leaves if it is of first order.
fn first_order(difference: f64, ratio: f64) -> f64 {
    difference.abs() / (ratio - 1.0)
}

fn count(elements: [usize; 3]) -> f64 {
    elements.map(|n| n as f64).iter().product()
}

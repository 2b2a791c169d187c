//! Targets: the surfaces on which the pin slides.
//!
//! * [`rotating_disk`], [`straight_plane`] – rigid surfaces with a given velocity.
//! * `patch` – the surface of an elastic disk between its nodes.

pub mod patch;
mod rigid;

pub use rigid::{SurfaceMotion, rotating_disk, straight_plane};

use crate::solver::body::ring::{RingBody, RingDefinition, UnsteppedRing};
use std::sync::Arc;

/// A target in the definition of a model.
#[derive(Debug, Clone)]
pub enum TargetDefinition {
    /// A rigid surface with this velocity under each slave node, per unit of the drive's rate.
    Rigid(SurfaceMotion),
    /// An elastic disk that rotates about its axis.
    Ring(RingDefinition),
}

/// The immutable part of a target.
#[derive(Debug, Clone)]
pub enum Target {
    /// A rigid surface.
    Rigid,
    /// An elastic disk.
    Ring(Arc<RingBody>),
}

impl Target {
    /// The elastic disk, if the target is one.
    pub fn ring(&self) -> Option<&RingBody> {
        match self {
            Self::Rigid => None,
            Self::Ring(ring) => Some(ring),
        }
    }
}

/// A target that has no time step yet.
pub(in crate::solver) enum UnsteppedTarget {
    Rigid,
    Ring(Box<UnsteppedRing>),
}

impl UnsteppedTarget {
    /// The longest stable step \[s\], and the upper bound of the largest angular frequency \[rad/s\]. `None` for a
    /// rigid target, which allows any step.
    pub fn longest_step_s(&self, beta_r_s: f64) -> Option<(f64, f64)> {
        match self {
            Self::Rigid => None,
            Self::Ring(ring) => Some((ring.longest_step_s(beta_r_s), ring.omega_max())),
        }
    }

    /// The target with a time step; `None` if the step is too long.
    pub fn with_step(self, time_step_s: f64, beta_r_s: f64) -> Option<Target> {
        match self {
            Self::Rigid => Some(Target::Rigid),
            Self::Ring(ring) => Some(Target::Ring(Arc::new(ring.with_step(time_step_s, beta_r_s)?))),
        }
    }
}

//! The evaluation of a run: cycles, periodic state, decay, regime, μ*, identities.
//!
//! ```text
//! solver state ─► sample ─► cycles ─► steady (periodic?) ─┐
//!                     ├───► decay (stable?) ──────────────┼─► lane ─► record
//!                     ├───► sums (means, extremes) ───────┤
//!                     └───► program (windows, hysteresis) ┘
//! ```
//!
//! Before a run, [`stability`] may decide the job by the eigenvalues of steady sliding. Then there is no run.
//! A run starts from rest, in [`nested`] from the limit cycle of a coarser mesh, or in [`continuation`] from the last motion of
//! another job.
//!
//! # Definitions
//! * **μ*** = ⟨T⟩/⟨F⟩ over whole limit cycles. T is the tangential force in y that the clamp carries, F the
//!   normal load.
//! * The macroscopic identity is μ − μ* = (1/F)⟨Σ_stick(μN − t_y) + Σ_slip μN(1 − cos φ)⟩. φ is the angle of
//!   friction from +y, the direction in which T is measured.
//! * The energy identity is: work of drive and load = friction + damping + contact loss + change of stored
//!   energy.
//! * Stresses and the extremes of N are taken after a short low-pass filter ([`sample::STRESS_SMOOTHING`]).

#![warn(clippy::disallowed_methods)]

mod above_band;
pub mod batch;
pub mod branches;
mod build;
mod checkpoint;
pub mod continuation;
pub mod cycles;
pub mod decay;
mod drive;
mod error;
mod example;
mod job;
pub mod lane;
pub mod lanes;
pub mod lines;
mod mesh_error;
mod mode;
pub mod nested;
mod noted;
mod outcome;
mod plastic;
pub mod program;
pub mod quantity;
pub mod record;
pub mod sample;
pub mod stability;
pub mod steady;
pub mod sums;
mod window;
mod workload;

pub use above_band::AboveBand;
pub use build::Build;
pub use checkpoint::Unreadable;
pub use drive::{drive, drive_at};
pub use error::JobError;
pub use job::{JobObserver, Unobserved, on_final_mesh, solve};
pub use lanes::Moment;
pub use mesh_error::{MeshError, UnknownError};
pub use mode::ComplexMode;
pub use nested::{ClampWidths, CoarseStart, earliest_end};
pub use noted::Noted;
pub use record::{
    ElasticDisk, EnergyTotals, HolderMotion, JobRecord, ObservedNode, Outcome, PlasticFlow, Regime,
    SlidingStability,
};
pub use stability::Structures;
pub use steady::Obstacle;
pub use workload::{Ending, Workload};

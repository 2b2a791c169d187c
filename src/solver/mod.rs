//! Explicit dynamics of an elastic pin in unilateral frictional contact with a moving target.
//!
//! Knows nothing of files, queue or command line. What each module owns:
//!
//! ```text
//! mesh ─► element ─► operator ─┐
//! material                     ├─► model (immutable) ─┐
//! constraints ─► stability ────┤                      ├─► step (bare) ─► energy, guard, observers
//! boundary, disk ──────────────┘                      │
//! field ─► state (per lane) ──────────────────────────┤
//! integrate (moves the nodes as the product passes) ──┤
//! contact (the law and the forward-increment solves) ─┘
//! ```
//!
//! # Conventions
//! * A node's index runs x fastest, then y, then z; components are x = 0, y = 1, z = 2.
//! * **Fields are indexed node → component → lane**, `u[(3·node + component)·L + lane]`, and stored in
//!   blocks for vectors ([`field`]). The `L` lanes are independent jobs that share one [`Model`] (mesh,
//!   material, clamp, damping, time step) and differ in their [`Drive`] (μ, ω, load). One lane is the plain
//!   case; every lane goes through the same operations in the same order, so its bits do not depend on its
//!   companions.
//! * Plain multiply and add in f64, never fused, summed in a fixed order: the same bits on every path.
//! * The gap is positive when open; the normal contact force N on the pin is ≥ 0 (N = −λ_n).
//!
//! # Two bodies
//! The pin is always there. An elastic disk ([`disk`]) is a second body with a model and a state of its own; the step
//! hands both to [`contact::elastic`], which predicts and corrects them. Without it [`contact::rigid`] does that for
//! the pin alone, and nothing of the disk is made or read.

pub mod boundary;
pub mod constraints;
pub mod contact;
pub mod disk;
pub mod element;
pub mod energy;
mod error;
pub mod field;
pub mod guard;
mod integrate;
mod line_table;
pub mod material;
pub mod mesh;
pub mod model;
pub mod operator;
pub mod stability;
pub mod state;
pub mod step;
pub mod stress;
mod supports;

pub use error::SolverError;
pub use model::{Model, ModelDefinition, Stiffness, TimeStep};
pub use state::{Drive, State};
pub use step::step;

/// Version of everything that can change a result's bits; part of every job's key. Raise it with
/// any change of the scheme, the operator's rounding or the analysis.
pub const VERSION: &str = "3";

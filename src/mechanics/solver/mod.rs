//! Explicit dynamics of an elastic pin in unilateral frictional contact with a moving target.
//!
//! The solver knows nothing of files, the queue or the command line. Its parts:
//!
//! ```text
//! body ◄─┬─ support           what deforms; what holds and loads it
//!        └─ interface         where the pin touches its target: pairs, law, target, solve
//!   scene ─► model (immutable) ─► state (per lane) ─► step (bare) ─► energy, guard, observers
//! ```
//!
//! * [`body`] – the block of the pin and the ring of an elastic disk: internal forces, masses, energies, bound of
//!   ω.
//! * [`support`] – what holds and loads the pin.
//! * [`interface`] – contact: slave nodes, friction laws, targets, and the two contact solves.
//! * [`scheme`] – the β₂ method and its stability limit, from which the time step follows.
//! * [`energy`] – the balance, a sum over bodies, supports and the interface. [`guard`] stops a run that diverges.
//! * [`PinMotion`] – the motion of a pin on another mesh, with which a run can begin.
//! * [`field`] and [`lane`] – nodal vectors of all lanes; a lane as a list of numbers.
//!
//! # Conventions
//! * In the block, node indices run x fastest, then y, then z. Components are x = 0, y = 1, z = 2.
//! * **Fields are indexed node → component → lane**, `u[(3·node + component)·L + lane]`. They are stored in blocks
//!   of 64 bytes for SIMD ([`field`]).
//! * The `L` lanes are independent jobs. They share one [`Model`] (mesh, material, supports, damping, time step)
//!   and differ in their [`Drive`] (friction law, ω, load). Every lane goes through the same operations in the same
//!   order, so its bits do not depend on the other lanes.
//! * Fields are f64, or f32 in single precision ([`Number`]). Totals of a step, energies and works are f64. Multiply
//!   and add are never fused, and every sum has a fixed order. So the bits do
//!   not depend on the vector width.
//! * The gap is positive when open. The normal contact force N on the pin is ≥ 0 (N = −λ_n, with the multiplier
//!   λ_n).

#![warn(clippy::disallowed_methods)]

pub mod body;
mod compiled;
mod drive;
pub mod energy;
mod error;
pub mod field;
pub mod guard;
pub mod interface;
pub mod lane;
pub mod material;
pub mod model;
mod number;
mod real;
mod scene;
pub mod scheme;
pub(crate) mod simd;
mod state;
mod step;
pub mod support;
mod transfer;

pub use compiled::{InLanes, step};
pub use drive::Drive;
pub use error::SolverError;
pub use interface::solve::RunNumber;
pub use model::{Model, ModelDefinition};
pub use number::Number;
pub use scheme::TimeStep;
pub use state::{State, StateOf};
pub(crate) use step::step_of_lanes;
pub use transfer::PinMotion;

/// Version of everything that can change the bits of a result. It is part of every job's key. Raise it with any
/// change of the scheme, of the operator's rounding, of the analysis, or of the eigenvalues of steady sliding.
pub const VERSION: &str = "10";

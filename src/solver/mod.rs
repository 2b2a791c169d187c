//! Explicit dynamics of an elastic pin in unilateral frictional contact with a moving target.
//!
//! Knows nothing of files, queue or command line. The rooms:
//!
//! ```text
//! body ◄── support          what deforms; what holds and loads it
//!   ▲         ▲
//!   └──── interface         where the pin touches its target: pairs, law, target, solve
//!             ▲
//!   scene ─► model (immutable) ─► state (per lane) ─► step (bare) ─► energy, guard, observers
//! ```
//!
//! * [`body`] – the block of the pin and the ring of an elastic disk: internal forces, masses, energies, bound of ω.
//! * [`support`] – what holds and loads the pin.
//! * [`interface`] – contact: slave nodes, friction laws, targets, and the two ways of solving.
//! * [`scheme`] – the β₂ method and its stability limit, from which the time step follows.
//! * [`energy`] – the balance, a sum over bodies, supports and the interface. [`guard`] stops a run that diverges.
//! * [`field`] and [`lane`] – nodal vectors of all lanes; a lane as a list of numbers.
//!
//! # Conventions
//! * A node's index runs x fastest, then y, then z; components are x = 0, y = 1, z = 2.
//! * **Fields are indexed node → component → lane**, `u[(3·node + component)·L + lane]`, and stored in
//!   blocks for vectors ([`field`]). The `L` lanes are independent jobs that share one [`Model`] (mesh,
//!   material, clamp, damping, time step) and differ in their [`Drive`] (μ, ω, load). One lane is the plain
//!   case. Every lane goes through the same operations in the same order, so its bits do not depend on its
//!   companions.
//! * Plain multiply and add in f64, never fused, summed in a fixed order: the same bits on every path.
//! * The gap is positive when open; the normal contact force N on the pin is ≥ 0 (N = −λ_n).

pub mod body;
mod drive;
pub mod energy;
mod error;
pub mod field;
pub mod guard;
pub mod interface;
pub mod lane;
pub mod material;
pub mod model;
mod scene;
pub mod scheme;
mod state;
mod step;
pub mod support;

pub use drive::Drive;
pub use error::SolverError;
pub use model::{Model, ModelDefinition};
pub use scheme::TimeStep;
pub use state::State;
pub use step::step;

/// Version of everything that can change a result's bits; part of every job's key. Raise it with
/// any change of the scheme, the operator's rounding or the analysis.
pub const VERSION: &str = "3";

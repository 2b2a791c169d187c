//! The elastic disk: a ring of hexahedra.
//!
//! ```text
//! grading ─► mesh ─► sector (element matrices) ─► operator ─┐
//!                                                bound ─► stages ─► body (immutable) ─► motion (per lane), audit
//!                                                           └► response (to contact forces)
//! ```
//!
//! # The rotating frame
//! The ring is formulated in the frame that rotates with it. Nodal vectors have the node's own radial, tangential
//! and axial directions. In this frame the stiffness is constant, the same for all sectors of equal angle, and the
//! same for all lanes whatever their ω.
//!
//! The forces due to the rotation, −2MΩ×u̇ and MΩ²r, are neglected. At 100 rpm, Ω = 10.5 rad/s:
//! * The Coriolis forces are 2Ω/ω = 2·10⁻⁴ of the inertia forces at the squeal frequency of 15 kHz.
//! * The centrifugal softening is (Ω/ω)² = 10⁻⁸ of them.
//! * The centrifugal load stretches the ring by a constant ρΩ²r³/E ≈ 7 nm. The pin touches only the top face, which
//!   moves uniformly in z by a fraction of this.

mod audit;
mod body;
mod bound;
mod grading;
pub mod mesh;
mod motion;
pub mod operator;
mod response;
mod sector;
pub mod stages;

pub(in crate::solver) use audit::RingAudit;
pub(in crate::solver) use body::UnsteppedRing;
pub use body::{RingBody, RingDefinition};
pub use mesh::RingMesh;
pub use motion::RingState;
pub(in crate::solver) use motion::{TrackForce, rows_of, times};

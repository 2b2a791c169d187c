//! The elastic disk: a ring of hexahedra.
//!
//! ```text
//! grading ─► mesh ─► sector (element matrices) ─► operator ─┐
//!                                                bound ─► stages ─► body (immutable) ─► motion (per lane), audit
//!                                                           └► response (to contact forces)
//! ```
//!
//! # The rotating frame
//! The ring is formulated in the frame that turns with it, with nodal vectors along the node's own radial,
//! tangential and axial directions. There its stiffness is constant, the same for all sectors of equal angle, and
//! the same for all lanes whatever their ω. Left out are the forces that the rotation itself brings, −2MΩ×u̇ and
//! MΩ²r: at 100 rpm, Ω = 10.5 rad/s, Coriolis forces are 2Ω/ω = 2·10⁻⁴ of the inertia at the squeal's 15 kHz, the
//! centrifugal softening (Ω/ω)² = 10⁻⁸ of it, and the centrifugal load stretches the ring by a constant
//! ρΩ²r³/E ≈ 7 nm, of which the top face, which is all that matters to the pin, sees a uniform fraction in z.

mod audit;
mod body;
mod bound;
pub mod grading;
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

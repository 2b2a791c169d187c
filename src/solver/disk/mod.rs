//! The disk under the pin: how a rigid target moves, and the body of an elastic one.
//!
//! ```text
//! grading ─► mesh ─► sector (element matrices) ─► operator ─┐
//!                                                bound ─► stages ─► body (immutable) ─► motion (per lane)
//!                                                           └► response (to contact forces)
//! ```
//!
//! # The rotating frame
//! The elastic disk is formulated in the frame that turns with it, with nodal vectors along the node's own radial,
//! tangential and axial directions. There its stiffness is constant, the same for all sectors of equal angle, and
//! the same for all lanes whatever their ω. Left out are the forces that the rotation itself brings, −2MΩ×u̇ and
//! MΩ²r: at 100 rpm, Ω = 10.5 rad/s, Coriolis forces are 2Ω/ω = 2·10⁻⁴ of the inertia at the squeal's 15 kHz, the
//! centrifugal softening (Ω/ω)² = 10⁻⁸ of it, and the centrifugal load stretches the ring by a constant
//! ρΩ²r³/E ≈ 7 nm, of which the top face, which is all that matters to the pin, sees a uniform fraction in z.

pub(in crate::solver) mod body;
mod bound;
pub mod grading;
pub mod mesh;
mod motion;
pub mod operator;
pub(in crate::solver) mod response;
mod sector;
pub mod stages;
mod target;

pub use body::{DiskBody, DiskDefinition};
pub use mesh::RingMesh;
pub use motion::DiskState;
pub(in crate::solver) use motion::rows_of;
pub use target::{SurfaceMotion, rotating_disk, straight_plane};

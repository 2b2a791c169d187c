//! The interface: contact of the pin with its target.
//!
//! A contact force is found in this order:
//!
//! ```text
//! pair (slave node, initial gap) ─► gap and slip of the prediction ─► solve: normal force, then friction
//!                                       ▲ target (how it moves)                └► law: limit, projection
//! ```
//!
//! The method is that of forward increment Lagrange multipliers (Carpenter, Taylor and Katona, 1991). The
//! displacements u* are predicted without contact. Every slave node that would be below its target at t_{n+1} gets
//! a constraint. The multipliers that put it back act at t_n.
//!
//! * [`Interface`] – the slave nodes with their initial gaps and the velocity of the target under them.
//! * `profile` – the height of a base that is not a plane; `roughness` – its rough part.
//! * [`Relief`] – the heights of a rigid target that is not a plane.
//! * [`Layer`] – a compliant layer between the slave nodes and a rigid target.
//! * [`law`] – friction laws, and the projection that all of them share.
//! * [`target`] – rigid surfaces, and the surface of an elastic disk between its nodes.
//! * [`solve`] – the two contact solves: node by node on a rigid target, by sweeps on an elastic one.
//! * [`Contacts`] – the results: forces, friction limits, increments, gaps and states.

mod contacts;
pub mod law;
mod layer;
mod pair;
mod profile;
mod relief;
mod roughness;
pub mod solve;
pub mod target;
#[cfg(test)]
mod tests;
mod work;

pub(crate) use contacts::LIMIT;
pub use contacts::{ContactState, Contacts, Status};
pub use layer::Layer;
use layer::NodesOnLayer;
pub use pair::{Interface, SlaveNode};
pub(in crate::solver) use profile::BaseHeights;
use relief::MovingRelief;
pub use relief::{Relief, Wave};
pub(in crate::solver) use work::InterfaceWork;

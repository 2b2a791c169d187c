//! Verification against exact answers and independent values; one file per topic. Those that compute much themselves are in the
//! program `references`.
//!
//! Two things are not verified, because the program does not have them. The first is a static friction
//! coefficient above the kinetic one (the stick–slip cycle on a belt). The second is partial slip of two
//! elastic bodies (Cattaneo and Mindlin), which needs a curved, deformable target. `hysteresis` is its
//! one-dimensional counterpart.

mod bar;
mod belt;
mod block;
mod bouncing_bar;
mod clamped_bar;
mod clocks;
mod common;
mod criteria;
mod cycle_identities;
mod dissipation;
mod elastic;
mod elements;
mod energy;
mod evidence;
mod frequency;
mod friction_bar;
mod friction_chain;
mod friction_laws;
mod held;
mod hertz;
mod holder;
mod hysteresis;
mod integrator;
mod invariance;
mod layer;
mod locking;
mod mode_coupling;
mod particles;
mod patch;
mod plasticity;
mod programs;
mod reference;
mod rig;
mod roughness;
mod runout;
mod saturated_flutter;
mod shapes;
mod shear;
mod sideways;
mod strains;
mod two_bodies;
mod wedge;

//! Verification against exact answers and independent values; one file per topic.
//!
//! Two things are not verified, because the program does not have them. The first is a static friction
//! coefficient above the kinetic one (the stick–slip cycle on a belt). The second is partial slip of two
//! elastic bodies (Cattaneo and Mindlin), which needs a curved, deformable target. `hysteresis` is its
//! one-dimensional counterpart.

mod bar;
mod bar_spectrum;
mod belt;
mod block;
mod bouncing_bar;
mod clamped_bar;
mod clocks;
mod common;
mod cycle_identities;
mod dissipation;
mod elastic;
mod elements;
mod energy;
mod evidence;
mod flutter;
mod free_block;
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
mod modes;
mod on_elastic_disk;
mod particles;
mod patch;
mod plasticity;
mod programs;
mod reference;
mod rig;
mod ring_modes;
mod ring_ritz;
mod ring_rotation;
mod ring_settlement;
mod ring_statics;
mod ring_tools;
mod ritz;
mod roughness;
mod runout;
mod saturated_flutter;
mod shapes;
mod shear;
mod sideways;
mod sliding_in_time;
mod sliding_modes;
mod sliding_scenes;
mod sliding_sparse;
mod strains;
mod two_bodies;
mod wedge;

//! Verification against exact answers and independent values; one file a topic.
//!
//! Not verified, for the program does not have it: a static friction coefficient above the kinetic one (the
//! stick–slip cycle on a belt), and partial slip of two elastic bodies (Cattaneo and Mindlin), which needs
//! a curved, deformable target; `hysteresis` is its one-dimensional counterpart.

mod bar;
mod belt;
mod block;
mod common;
mod energy;
mod evidence;
mod friction_bar;
mod friction_chain;
mod held;
mod hysteresis;
mod integrator;
mod invariance;
mod mode_coupling;
mod particles;
mod patch;
mod reference;
mod saturated_flutter;
mod shear;
mod sideways;
mod wedge;

//! Verification against exact answers and independent values; one file a topic.

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
mod shear;
mod sideways;
mod wedge;

//! Verification against exact answers and independent values; one file a topic.

mod bar;
mod block;
mod common;
mod energy;
mod evidence;
mod flutter;
mod integrator;
mod invariance;
mod patch;
mod reference;
mod shear;

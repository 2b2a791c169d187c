//! Verification against exact answers and independent values; one file a topic.

mod bar;
mod bar_spectrum;
mod block;
mod bouncing_bar;
mod clamped_bar;
mod common;
mod cycle_identities;
mod energy;
mod evidence;
mod free_block;
mod frequency;
mod integrator;
mod invariance;
mod modes;
mod patch;
mod reference;
mod ritz;
mod shear;

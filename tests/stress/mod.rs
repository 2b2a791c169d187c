//! Stability under stress: hostile but legal scenes, time steps on both sides of the limit, very long runs.
//!
//! The ordinary suite runs a fixed number of cases. `scripts/stability.py` runs ten thousand cases, the long
//! runs and the rest, and writes docs/evidence/stability.md from the lines that [`summary`] collects. Environment
//! variables:
//! * `TRIBOSWEEP_STRESS_SEED`, `TRIBOSWEEP_STRESS_CASES`: which cases, and how many of them;
//! * `TRIBOSWEEP_STRESS_ONLY`: one case of the seed, with all its details;
//! * `TRIBOSWEEP_STRESS_SUMMARY`: a folder for the lines.

mod audited;
mod beyond;
mod cases;
mod corners;
mod ending;
mod generator;
mod long;
mod modes;
mod scenes;
mod simplify;
mod summary;

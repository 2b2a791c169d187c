//! The mechanics: what a job is, how it is solved, and what its run means. It knows no studies, databases and pages.
//!
//! The rooms are the folders beside this one.

#[path = "../analysis/mod.rs"]
pub mod analysis;
#[path = "../random.rs"]
pub mod random;
#[path = "../solver/mod.rs"]
pub mod solver;
#[path = "../spec/mod.rs"]
pub mod spec;
#[path = "../stability/mod.rs"]
pub mod stability;
#[path = "../units.rs"]
pub mod units;

//! The mechanics: what a job is, how it is solved, and what its run means. It knows no studies, databases and pages.

pub mod analysis;
pub mod random;
pub mod solver;
pub mod spec;
pub mod stability;
pub mod units;

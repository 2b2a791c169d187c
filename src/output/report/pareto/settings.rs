//! The numerics of a job, and the physical case in words.

use crate::publish::table::Column;
use crate::report::parameters::assignments;
use crate::report::row::{JobNumerics, JobRow};

/// The physical parameters of a job in words, ω and μ first.
pub(super) fn physics_in_words(row: &JobRow, is_numerics: fn(&str) -> bool) -> String {
    assignments(row.parameters.iter().filter(|(name, _)| !is_numerics(name)))
}

/// The settings of a job that the comparison is about.
#[rustfmt::skip]
pub(super) static SETTINGS: [Column<JobNumerics>; 14] = [
    Column::new("elements", "", "elements in x, y and z", |of| of.elements.to_vec().into()),
    Column::new("element_size_m", "m", "cube root of the volume of an element", |of| of.element_size_m.into()),
    Column::new("nodes", "", "nodes of the pin", |of| of.nodes.into()),
    Column::new("safety_factor", "", "time step over its limit; empty where the step is given", |of| of.safety_factor.into()),
    Column::new("beta2", "", "β₂ of the time scheme", |of| of.beta2.into()),
    Column::new("beta_r_s", "s", "damping β_R", |of| of.beta_r_s.into()),
    Column::new("stop_early", "", "whether the run stops when its state is known", |of| of.stop_early.into()),
    Column::new("limit_s", "s", "largest simulated time", |of| of.limit_s.into()),
    Column::new("average_last_fraction", "", "last fraction of a run up to its limit that is averaged", |of| of.average_last_fraction.into()),
    Column::new("cycles", "", "limit cycles that must repeat", |of| of.cycles.into()),
    Column::new("tolerance", "", "largest spread of a figure over these cycles", |of| of.tolerance.into()),
    Column::new("drift_tolerance", "", "largest drift of its mean", |of| of.drift_tolerance.into()),
    Column::new("precision", "", "precision of the run", |of| of.precision.as_str().into()),
    Column::new("start", "", "what state the run starts from", |of| of.start.as_str().into()),
];

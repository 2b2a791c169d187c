//! The numerics of a job in words, and the parameters of a grid that belong to them.

use crate::publish::value;
use crate::report::parameters::{MU, OMEGA, assignments};
use crate::report::row::{JobNumerics, JobRow};

/// Grid parameters that change the numerics and not the physical case.
const NUMERICS: [&str; 19] = [
    "elements",
    "nx",
    "ny",
    "nz",
    "beta2",
    "beta_r_s",
    "safety_factor",
    "time_step_s",
    "precision",
    "limit_s",
    "stop_early",
    "average_last_fraction",
    "cycles",
    "tolerance",
    "drift_tolerance",
    "regime_threshold",
    "decay_observation_s",
    "start",
    "stability",
];

/// The physical parameters of a job in words, ω and μ first.
pub(super) fn physics_in_words(row: &JobRow) -> String {
    let further = row.further().filter(|(name, _)| !NUMERICS.contains(name));
    let further = further.map(|(name, value)| (name, value.clone()));
    let own = [OMEGA, MU].map(|name| (name, row.parameter(name)));
    assignments(own.into_iter().chain(further))
}

/// Names of the settings, in the order of [`texts`].
pub(super) const NAMES: [&str; 12] = [
    "elements",
    "safety factor",
    "β₂",
    "β_R [s]",
    "stop early",
    "limit [s]",
    "averaged",
    "cycles",
    "tolerance",
    "drift tolerance",
    "precision",
    "start",
];

/// The settings of a job as text.
pub(super) fn texts(numerics: &JobNumerics) -> [String; 12] {
    let [nx, ny, nz] = numerics.elements;
    [
        format!("{nx}×{ny}×{nz}"),
        numerics.safety_factor.map_or_else(|| "step given".to_owned(), value::rounded),
        value::rounded(numerics.beta2),
        value::rounded(numerics.beta_r_s),
        if numerics.stop_early { "yes" } else { "no" }.to_owned(),
        value::rounded(numerics.limit_s),
        value::rounded(numerics.average_last_fraction),
        numerics.cycles.to_string(),
        value::rounded(numerics.tolerance),
        value::rounded(numerics.drift_tolerance),
        numerics.precision.clone(),
        numerics.start.clone(),
    ]
}

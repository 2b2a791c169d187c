//! The physics and the numerics of a job in words.

use crate::publish::table::Column;
use crate::publish::value;
use crate::report::parameters::{MU, OMEGA, assignments};
use crate::report::row::{JobNumerics, JobRow};

/// The physical parameters of a job in words, ω and μ first.
pub(super) fn physics_in_words(row: &JobRow, is_numerics: fn(&str) -> bool) -> String {
    let further = row.further().filter(|(name, _)| !is_numerics(name));
    let further = further.map(|(name, value)| (name, value.clone()));
    let own = [OMEGA, MU].map(|name| (name, row.parameter(name)));
    assignments(own.into_iter().chain(further))
}

/// The settings of a job in words.
pub(super) const SETTINGS: [Column<JobNumerics>; 12] = [
    Column::new("elements", "", "", |of| of.elements.map(|count| count.to_string()).join("×").into()),
    Column::new("safety factor", "", "", |of| {
        of.safety_factor.map_or_else(|| "step given".to_owned(), value::rounded).into()
    }),
    Column::new("β₂", "", "", |of| of.beta2.into()),
    Column::new("β_R [s]", "", "", |of| of.beta_r_s.into()),
    Column::new("stop early", "", "", |of| if of.stop_early { "yes" } else { "no" }.into()),
    Column::new("limit [s]", "", "", |of| of.limit_s.into()),
    Column::new("averaged", "", "", |of| of.average_last_fraction.into()),
    Column::new("cycles", "", "", |of| of.cycles.into()),
    Column::new("tolerance", "", "", |of| of.tolerance.into()),
    Column::new("drift tolerance", "", "", |of| of.drift_tolerance.into()),
    Column::new("precision", "", "", |of| of.precision.as_str().into()),
    Column::new("start", "", "", |of| of.start.as_str().into()),
];

/// The settings of a job as text.
pub(super) fn texts(numerics: &JobNumerics) -> Vec<String> {
    SETTINGS.iter().map(|setting| value::rounded_text(&setting.value(numerics))).collect()
}

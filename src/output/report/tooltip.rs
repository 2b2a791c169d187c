//! The text of the tooltip of a job.

use super::digits;
use super::layout::parameters_in_words;
use super::measurement::MeasuredValue;
use super::row::{JobRow, RowState};
use super::scalar::{FREQUENCY, MU_STAR};
use crate::analysis::JobRecord;
use crate::publish::value::{fixed, number, short, significant};
use crate::units::name_and_unit;

/// Number of characters of a job's key that are shown. They are unique in practice, and `show` accepts them.
const KEY_LENGTH: usize = 12;
/// Largest number of characters of an error message.
const MAX_ERROR_LENGTH: usize = 240;

/// A job in a few lines, its parameters first.
pub(super) fn tooltip_text(row: &JobRow) -> String {
    let mut lines = vec![parameters_in_words(row)];
    match &row.state {
        RowState::Done(record) => lines.extend(results(row, record)),
        RowState::Failed { error } => {
            let reason: String = error.chars().take(MAX_ERROR_LENGTH).collect();
            lines.push(format!("failed: {reason}"));
        }
        RowState::Unreadable { reason } => {
            let reason: String = reason.chars().take(MAX_ERROR_LENGTH).collect();
            lines.push(format!("unreadable: {reason}"));
        }
        RowState::Pending | RowState::Running | RowState::Cancelled => lines.push(row.status().to_owned()),
        RowState::Measured(measured) => {
            lines.extend(measured.values.iter().map(in_words));
            lines.push(format!("measured: {}", row.job));
            return lines.join("\n");
        }
    }
    lines.push(format!("job {}", short_key(row)));
    lines.join("\n")
}

fn in_words(measured: &MeasuredValue) -> String {
    let (name, unit) = name_and_unit(&measured.name);
    let error = measured.error.map_or_else(String::new, |error| format!(" ± {}", short(error)));
    format!("{name} = {}{error} {unit}", short(measured.value)).trim_end().to_owned()
}

/// The beginning of a job's key.
pub(super) fn short_key(row: &JobRow) -> String {
    row.job.chars().take(KEY_LENGTH).collect()
}

fn results(row: &JobRow, record: &JobRecord) -> Vec<String> {
    let percent = |share: f64| fixed(100.0 * share, 1);
    let mut lines = vec![
        format!("{} = {}", MU_STAR.symbol(), digits::with_error(MU_STAR, row)),
        format!("{}, {}", record.regime.label(), record.outcome.label()),
        format!(
            "stick {} %, slip {} %, separated {} %",
            percent(record.stick_share),
            percent(record.slip_share),
            percent(record.separated_share)
        ),
    ];
    if record.frequency_hz.is_some() {
        lines.insert(1, format!("{} {}", digits::by_error(FREQUENCY, row), FREQUENCY.unit()));
    }
    lines.push(errors(record));
    lines.push(format!(
        "residuals: energy {}, identities {}",
        residual_text(record.energy_residual),
        residual_text(record.identity_residual())
    ));
    lines
}

/// Both errors of μ\*.
fn errors(record: &JobRecord) -> String {
    let mesh = match record.mesh_error() {
        Ok(error) => significant(error.mu_star, 2),
        Err(unknown) => format!("unknown ({})", unknown.reason()),
    };
    format!("errors of μ*: statistics {}, mesh {mesh}", significant(record.mu_star_se, 2))
}

/// A residual with two digits. More digits say nothing about a number that should be zero.
pub(super) fn residual_text(residual: f64) -> String {
    format!("{residual:.1e}").parse().map_or_else(
        |_| number(residual),
        |rounded: f64| {
            if rounded == 0.0 { "0".to_owned() } else { format!("{rounded:.1e}") }
        },
    )
}

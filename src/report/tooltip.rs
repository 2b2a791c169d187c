//! The text of the tooltip of a job.

use super::glyph::regime_label;
use super::layout::parameters_in_words;
use super::row::{JobRow, RowState};
use crate::analysis::{JobRecord, Outcome};
use crate::publish::value::{fixed, number};

/// Number of characters of a job's key that are shown. They are unique in practice, and `show` accepts them.
const KEY_LENGTH: usize = 12;
/// Largest number of characters of an error message.
const MAX_ERROR_LENGTH: usize = 240;

/// A job in a few lines, its parameters first.
pub(super) fn tooltip_text(row: &JobRow) -> String {
    let mut lines = vec![parameters_in_words(row)];
    match &row.state {
        RowState::Done(record) => lines.extend(results(record)),
        RowState::Failed { error } => {
            let reason: String = error.chars().take(MAX_ERROR_LENGTH).collect();
            lines.push(format!("failed: {reason}"));
        }
        RowState::Pending | RowState::Running | RowState::Cancelled => lines.push(row.status().to_owned()),
    }
    lines.push(format!("job {}", short_key(row)));
    lines.join("\n")
}

/// The beginning of a job's key.
pub(super) fn short_key(row: &JobRow) -> String {
    row.job.chars().take(KEY_LENGTH).collect()
}

/// The name of an outcome for a reader.
pub(super) fn outcome_label(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Periodic => "periodic",
        Outcome::Decayed => "decayed",
        Outcome::NotPeriodic => "not periodic",
    }
}

fn results(record: &JobRecord) -> Vec<String> {
    let percent = |share: f64| fixed(100.0 * share, 1);
    let mut lines = vec![
        format!("μ* = {} ± {}", fixed(record.mu_star, 4), fixed(record.mu_star_se, 4)),
        format!("{}, {}", regime_label(record.regime), outcome_label(record.outcome)),
        format!(
            "stick {} %, slip {} %, separated {} %",
            percent(record.stick_share),
            percent(record.slip_share),
            percent(record.separated_share)
        ),
    ];
    if let Some(frequency) = record.frequency_hz {
        lines.insert(1, format!("{} Hz", fixed(frequency, 0)));
    }
    lines.push(format!(
        "residuals: energy {}, identities {}",
        residual_text(record.energy_residual),
        residual_text(record.identity_residual())
    ));
    lines
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

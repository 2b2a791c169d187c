//! The status of a job as a letter, as text and as colours.

use super::row::{JobRow, RowState};
use crate::analysis::{Outcome, Regime};
use crate::publish::chart::{Rgb, palette};
use anstyle::AnsiColor;

/// The status of a job as a letter, its meaning, and colours. The colours say nothing that the letter does not say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StatusGlyph {
    pub letter: char,
    pub meaning: &'static str,
    /// Colour of the letter on a terminal.
    pub terminal_colour: AnsiColor,
    /// Colour of a cell in a figure.
    pub fill: Rgb,
}

const GREY: Rgb = Rgb(0xDD, 0xDD, 0xDD);
const LIGHT: Rgb = Rgb(0xF2, 0xF2, 0xF2);

/// Stands for several jobs.
pub(super) const SEVERAL_JOBS: StatusGlyph =
    StatusGlyph { letter: '+', meaning: "several jobs", terminal_colour: AnsiColor::White, fill: GREY };

/// The glyph of a job.
pub(super) fn status_glyph(row: &JobRow) -> StatusGlyph {
    let glyph =
        |letter, meaning, terminal_colour, fill| StatusGlyph { letter, meaning, terminal_colour, fill };
    let record = match &row.state {
        RowState::Pending => return glyph('.', "pending", AnsiColor::BrightBlack, LIGHT),
        RowState::Running => return glyph('>', "running", AnsiColor::Cyan, GREY),
        RowState::Cancelled => return glyph('-', "cancelled", AnsiColor::BrightBlack, LIGHT),
        RowState::Failed { .. } => return glyph('!', "failed", AnsiColor::Red, palette::VERMILLION),
        RowState::Unreadable { .. } => {
            return glyph('?', "unreadable", AnsiColor::Red, palette::VERMILLION);
        }
        RowState::Done(record) => record,
        RowState::Measured(_) => return glyph('M', "measured", AnsiColor::White, GREY),
    };
    if record.outcome == Outcome::Unstable {
        return glyph('U', record.outcome.label(), AnsiColor::Red, palette::YELLOW);
    }
    if record.outcome == Outcome::Completed {
        return glyph('C', "completed program", AnsiColor::White, GREY);
    }
    let is_settled = record.outcome != Outcome::NotPeriodic;
    let (letter, colour, fill) = match record.regime {
        Regime::Stable => ('S', AnsiColor::Blue, palette::SKY),
        Regime::StickSlip => ('K', AnsiColor::Yellow, palette::ORANGE),
        Regime::StickSlipSeparation => ('X', AnsiColor::Magenta, palette::PURPLE),
        Regime::SlipSeparation => ('P', AnsiColor::Green, palette::GREEN),
        Regime::Undecided => ('?', AnsiColor::Red, palette::YELLOW),
    };
    match (record.regime, is_settled) {
        (regime @ (Regime::Stable | Regime::Undecided), _) | (regime, true) => {
            glyph(letter, regime.label(), colour, fill)
        }
        (regime, false) => {
            let meaning = match regime {
                Regime::StickSlip => "stick–slip, not periodic",
                Regime::StickSlipSeparation => "stick–slip–separation, not periodic",
                _ => "slip–separation, not periodic",
            };
            glyph(
                letter.to_ascii_lowercase(),
                meaning,
                colour,
                palette::mix(fill, Rgb(0xFF, 0xFF, 0xFF), 0.5),
            )
        }
    }
}

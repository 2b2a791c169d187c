//! What kind of job it is in a letter, in words and in colours.

use super::row::{JobRow, RowState};
use crate::analysis::{Outcome, Regime};
use crate::publish::plot::palette;
use anstyle::AnsiColor;
use plotters::style::{RGBColor, WHITE};

/// A kind of job: its letter, what that means, and its colours, which say nothing that the letter does not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StatusGlyph {
    pub letter: char,
    pub meaning: &'static str,
    /// On a terminal.
    pub colour: AnsiColor,
    /// On paper, as a ground.
    pub fill: RGBColor,
}

const GREY: RGBColor = RGBColor(0xDD, 0xDD, 0xDD);
const LIGHT: RGBColor = RGBColor(0xF2, 0xF2, 0xF2);

/// In place of a job's sign where there are several.
pub(super) const SEVERAL_JOBS: StatusGlyph =
    StatusGlyph { letter: '+', meaning: "several jobs", colour: AnsiColor::White, fill: GREY };

/// The regime as a reader's text.
pub(super) fn regime_label(regime: Regime) -> &'static str {
    match regime {
        Regime::Stable => "stable",
        Regime::StickSlip => "stick–slip",
        Regime::StickSlipSeparation => "stick–slip–separation",
        Regime::SlipSeparation => "slip–separation",
        Regime::Undecided => "undecided",
    }
}

/// The sign of a row's job.
pub(super) fn status_glyph(row: &JobRow) -> StatusGlyph {
    let sign = |letter, meaning, colour, fill| StatusGlyph { letter, meaning, colour, fill };
    let record = match &row.state {
        RowState::Pending => return sign('.', "pending", AnsiColor::BrightBlack, LIGHT),
        RowState::Running => return sign('>', "running", AnsiColor::Cyan, GREY),
        RowState::Cancelled => return sign('-', "cancelled", AnsiColor::BrightBlack, LIGHT),
        RowState::Failed { .. } => return sign('!', "failed", AnsiColor::Red, palette::VERMILLION),
        RowState::Done(record) => record,
    };
    let settled = record.outcome != Outcome::NotPeriodic;
    let (letter, colour, fill) = match record.regime {
        Regime::Stable => ('S', AnsiColor::Blue, palette::SKY),
        Regime::StickSlip => ('K', AnsiColor::Yellow, palette::ORANGE),
        Regime::StickSlipSeparation => ('X', AnsiColor::Magenta, palette::PURPLE),
        Regime::SlipSeparation => ('P', AnsiColor::Green, palette::GREEN),
        Regime::Undecided => ('?', AnsiColor::Red, palette::YELLOW),
    };
    match (record.regime, settled) {
        (regime @ (Regime::Stable | Regime::Undecided), _) => {
            sign(letter, regime_label(regime), colour, fill)
        }
        (regime, true) => sign(letter, regime_label(regime), colour, fill),
        (regime, false) => {
            let meaning = match regime {
                Regime::StickSlip => "stick–slip, not periodic",
                Regime::StickSlipSeparation => "stick–slip–separation, not periodic",
                _ => "slip–separation, not periodic",
            };
            sign(letter.to_ascii_lowercase(), meaning, colour, palette::mix(fill, WHITE, 0.5))
        }
    }
}

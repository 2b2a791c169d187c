//! Figures of the linear stability of steady sliding.

pub(super) mod boundary;
mod key;
mod lock_in;
mod map;
mod thresholds;

use super::Figure;
use super::panels::MAX_PANELS;
use crate::publish::FigureError;
use crate::report::stability::Analysis;
use plotters::prelude::RGBColor;

/// The colour of a mode that never grows, and of one that is not converged.
const GREY: RGBColor = RGBColor(0x9A, 0x9A, 0x9A);

/// A figure of the stability of steady sliding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::report) enum StabilityPlot {
    /// The growth rate of the leading mode over ω and μ.
    Map,
    /// Frequencies and growth rates of the modes over μ.
    LockIn,
    /// Thresholds of the modes over ω.
    Thresholds,
}

impl StabilityPlot {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Map, Self::LockIn, Self::Thresholds];

    /// The name of its files without the ending.
    pub fn stem(self) -> &'static str {
        match self {
            Self::Map => "stability_map",
            Self::LockIn => "lock_in",
            Self::Thresholds => "thresholds",
        }
    }

    /// What it shows, in words.
    pub fn title(self) -> &'static str {
        match self {
            Self::Map => "growth rate of the leading mode",
            Self::LockIn => "frequencies and growth rates of the modes over μ",
            Self::Thresholds => "thresholds of the modes",
        }
    }
}

/// Draws the figures of one kind, one sheet for each combination of the further parameters; thresholds have panels.
pub(in crate::report) fn figures(
    analysis: &Analysis,
    plot: StabilityPlot,
) -> Result<Vec<Figure>, FigureError> {
    let layout = &analysis.layout;
    let of_sheet = if plot == StabilityPlot::Thresholds { MAX_PANELS } else { 1 };
    let sheets = layout.groups.chunks(of_sheet).zip(analysis.groups.chunks(of_sheet)).enumerate();
    let draw = |(number, (groups, modes))| {
        let groups: &[crate::report::layout::Group] = groups;
        let modes: &[crate::report::stability::GroupModes] = modes;
        let svg = match plot {
            StabilityPlot::Map => map::draw(analysis, &groups[0]),
            StabilityPlot::LockIn => lock_in::draw(layout, &groups[0], &modes[0]),
            StabilityPlot::Thresholds => thresholds::draw(layout, groups, modes),
        }?;
        Ok(Figure::of_sheet(layout, number, of_sheet, plot.title(), svg))
    };
    sheets.map(draw).collect()
}

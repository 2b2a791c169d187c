//! Figures of the linear stability of steady sliding.

mod lock_in;
mod map;
mod thresholds;

use super::Figure;
use super::MAX_PANELS;
use crate::publish::chart::Rgb;
use crate::report::stability::{Along, Analysis, rows};
use crate::report::stability_point::StabilityPoint;
use crate::report::view::View;

/// The colour of a mode that never grows, and of one that is not converged.
const GREY: Rgb = Rgb(0x9A, 0x9A, 0x9A);

/// A figure of the stability of steady sliding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StabilityPlot {
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

/// The figures of one kind from the points of a study.
pub fn stability_figures(
    points: &[StabilityPoint],
    along: &Along,
    view: &View,
    plot: StabilityPlot,
) -> Vec<Figure> {
    let rows = rows(points, along);
    figures(&Analysis::of(points, &rows, along, view), plot)
}

/// The figures of one kind, one sheet for each combination of the further parameters; thresholds have panels.
pub(in crate::report) fn figures(analysis: &Analysis, plot: StabilityPlot) -> Vec<Figure> {
    let layout = &analysis.layout;
    if !analysis.has_series() && (plot != StabilityPlot::Map || !layout.scattered.is_empty()) {
        return Vec::new();
    }
    let of_sheet = if plot == StabilityPlot::Thresholds { MAX_PANELS } else { 1 };
    let modes_of = |sheet: usize| &analysis.groups[sheet * of_sheet..];
    let figure = |(number, groups): (usize, &[_])| {
        let chart = match plot {
            StabilityPlot::Map => map::chart(analysis, &groups[0]),
            StabilityPlot::LockIn => lock_in::chart(layout, &groups[0], &modes_of(number)[0]),
            StabilityPlot::Thresholds => thresholds::chart(layout, groups, &modes_of(number)[..groups.len()]),
        };
        Figure::of_sheet(layout, number, of_sheet, plot.title(), chart)
    };
    layout.groups.chunks(of_sheet).enumerate().map(figure).collect()
}

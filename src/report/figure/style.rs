//! Colours of series, and lines and marks of sources.

use crate::publish::plot::palette;
use crate::report::layout::{Layout, Series};
use plotters::prelude::{BLACK, RGBColor};

/// How the results of a source are drawn: lines of a study, marks of measured points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SourceStyle {
    /// The number of a study among the studies.
    Line(usize),
    /// The number of a file of measured points among these files.
    Mark(usize),
}

/// Dashes of the studies' lines: lengths of line and gap [px]; none for the first study, whose lines are solid.
const DASHES: [Option<(u32, u32)>; 4] = [None, Some((28, 10)), Some((6, 8)), Some((44, 16))];

/// Strokes of the marks of measured points, from the middle to one end, for a radius of 1.
const STROKES: [&[(f64, f64)]; 3] =
    [&[(0.8, 0.8), (0.8, -0.8)], &[(1.0, 0.0), (0.0, 1.0)], &[(1.0, 0.0), (0.5, 0.87), (0.5, -0.87)]];

impl SourceStyle {
    pub fn of(layout: &Layout, source: usize) -> Self {
        let is_measured = |index: usize| layout.sources.get(index).is_some_and(|source| source.is_measured);
        let number = (0..source).filter(|&other| is_measured(other) == is_measured(source)).count();
        if is_measured(source) { Self::Mark(number) } else { Self::Line(number) }
    }

    /// Lengths of dash and gap [px]; none for a solid line.
    pub fn dash(self) -> Option<(u32, u32)> {
        match self {
            Self::Line(number) => DASHES[number % DASHES.len()],
            Self::Mark(_) => None,
        }
    }

    pub fn strokes(self) -> &'static [(f64, f64)] {
        match self {
            Self::Line(_) => &[],
            Self::Mark(number) => STROKES[number % STROKES.len()],
        }
    }
}

/// The colour of a series: one for each value of the curves' parameter, and black where it is not known.
pub(super) fn colour(layout: &Layout, series: &Series) -> RGBColor {
    let known =
        layout.series.iter().filter(|series| !series.value.is_null()).map(|series| series.value_index);
    let count = known.max().map_or(1, |last| last + 1);
    if series.value.is_null() { BLACK } else { palette::colour(series.value_index, count) }
}

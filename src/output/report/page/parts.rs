//! What the page is made from.

use crate::report::comparison::Comparison;
use crate::report::figure::{Figure, Plot};
use crate::report::input::Report;
use crate::report::layout::Layout;
use crate::report::program::Programs;
use crate::report::stability::{Analysis, Files};
use std::collections::HashMap;

/// What the page is made from.
pub(in crate::report) struct Parts<'a> {
    pub report: &'a Report<'a>,
    pub layouts: Layouts<'a>,
    /// The figures of every kind.
    pub figures: &'a [(Plot, Vec<Figure>)],
    /// The differences between several sources.
    pub comparison: Option<&'a Comparison>,
    /// The figure of residuals, as SVG.
    pub residuals: &'a str,
    /// The jobs whose speed or load changes in time, if there are some.
    pub programs: Option<&'a Programs<'a>>,
    /// The linear stability of steady sliding with its figures, if it is known.
    pub stability: Option<(&'a Analysis<'a>, &'a Files)>,
    /// The names of all files of the report.
    pub files: Vec<String>,
    /// For jobs that were inspected, the address of the page, relative to the folder of the report.
    pub pages: HashMap<String, String>,
}

/// Which rows tables and figures show.
#[derive(Clone, Copy)]
pub(in crate::report) struct Layouts<'a> {
    /// Jobs and measured points.
    pub all: &'a Layout<'a>,
    /// The jobs alone, for figures that cannot show measured points.
    pub jobs: &'a Layout<'a>,
    /// The jobs with those at boundaries, for maps on true axes.
    pub whole: &'a Layout<'a>,
}

impl<'a> Layouts<'a> {
    /// The rows that the figures of a kind show.
    pub fn of(&self, plot: Plot) -> &'a Layout<'a> {
        match plot {
            Plot::RegimePlane | Plot::GrowthRate => self.whole,
            plot if plot.shows_measured() => self.all,
            _ => self.jobs,
        }
    }
}

//! What the page is made from.

use crate::report::figure::{Figure, Plot};
use crate::report::input::Report;
use crate::report::layout::Layout;

/// What the page is made from.
pub(in crate::report) struct Parts<'a> {
    pub report: &'a Report<'a>,
    pub layout: &'a Layout<'a>,
    /// The figures of every kind, one for each group.
    pub figures: &'a [(Plot, Vec<Figure>)],
    /// The figure of residuals, as SVG.
    pub residuals: &'a str,
}

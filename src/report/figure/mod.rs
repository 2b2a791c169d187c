//! Figure 7 and its companion: μ* and frequency against disk speed, one curve per μ, as SVG.

#![expect(clippy::cast_possible_wrap, reason = "pixels and legend lines: thousands, not billions")]

mod chart;
mod data;
mod legend;
mod marker;

use super::layout::{Group, Layout};
use super::row::Row;
use crate::publish::plot::FigureError;
use crate::publish::value;
use std::collections::HashSet;

/// What a figure shows over the disk speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plot {
    /// Macroscopic friction coefficient μ*, with μ itself as a guide.
    MuStar,
    /// Frequency of the limit cycle.
    Frequency,
}

/// One figure: the jobs with one combination of the further parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// What tells its file from those of the other combinations, e.g. `-clamp_side-inner_side`; may be empty.
    pub suffix: String,
    /// The combination in words; may be empty.
    pub caption: String,
    /// The drawing.
    pub svg: String,
}

/// Draws one figure per combination of the further parameters.
///
/// # Errors
/// The drawing library's; drawing into a string gives it no reason to fail.
pub fn figures(rows: &[Row], plot: Plot) -> Result<Vec<Figure>, FigureError> {
    figures_of(&Layout::new(rows), plot)
}

pub(super) fn figures_of(layout: &Layout, plot: Plot) -> Result<Vec<Figure>, FigureError> {
    let mut taken = HashSet::new();
    let draw = |group: &Group| {
        let svg = chart::draw(layout, group, plot)?;
        Ok(Figure { suffix: free_suffix(group, &mut taken), caption: group.caption(), svg })
    };
    layout.groups.iter().map(draw).collect()
}

/// Longest part of a file name that comes from parameters; file systems end at 255 bytes.
const MAX_SUFFIX: usize = 120;

/// The combination as a part of a file name that no other combination has.
fn free_suffix(group: &Group, taken: &mut HashSet<String>) -> String {
    let words: Vec<String> =
        group.key.iter().map(|(name, value)| format!("-{name}-{}", value::text(value))).collect();
    let slug: String = value::in_file_name(&words.concat()).chars().take(MAX_SUFFIX).collect();
    let numbered = (2..).map(|n| format!("{slug}-{n}"));
    std::iter::once(slug.clone())
        .chain(numbered)
        .find(|candidate| taken.insert(candidate.to_lowercase()))
        .unwrap_or(slug)
}

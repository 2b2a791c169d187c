//! Figure 7 and its companions, as SVG: curves against disk speed, maps over speed and friction, shares, residuals.

#![expect(clippy::cast_possible_wrap, reason = "pixels and legend lines: thousands, not billions")]

mod chart;
mod colour_key;
mod data;
mod legend;
mod map;
mod marker;
pub(super) mod residuals;
mod shares;

use super::layout::{Group, Layout};
use super::row::JobRow;
use crate::publish::FigureError;
use crate::publish::value;
use data::Ordinate;
use std::collections::HashSet;

/// What a figure shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plot {
    /// Macroscopic friction coefficient μ* over the disk speed, with μ itself as a guide.
    MuStar,
    /// Frequency of the limit cycle over the disk speed.
    Frequency,
    /// Contact regimes over disk speed and friction coefficient.
    RegimeMap,
    /// Frequencies over disk speed and friction coefficient.
    FrequencyMap,
    /// Shares of stick, slip and separation over the disk speed, for each friction coefficient.
    Shares,
}

/// A file with the data behind a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct DataFile {
    /// Its name without the ending.
    pub stem: &'static str,
    /// The fields of the export that it has, besides the parameters and the status.
    pub columns: &'static [&'static str],
}

/// The data behind the figure of residuals.
pub(super) const RESIDUALS: DataFile =
    DataFile { stem: "residuals", columns: &["energy_residual", "identity_residual"] };
/// The data behind the statistics of run times.
pub(super) const RUN_TIMES: DataFile =
    DataFile { stem: "run_times", columns: &["wall_s", "steps", "simulated_s", "time_step_s"] };

impl Plot {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::MuStar, Self::Frequency, Self::RegimeMap, Self::FrequencyMap, Self::Shares];

    /// The name of its files without the ending.
    pub fn stem(self) -> &'static str {
        match self {
            Self::MuStar => "figure7",
            Self::Frequency => "frequency",
            Self::RegimeMap => "regime_map",
            Self::FrequencyMap => "frequency_map",
            Self::Shares => "shares",
        }
    }

    /// The file with the data behind it.
    pub(super) fn data(self) -> DataFile {
        match self {
            Self::MuStar => {
                DataFile { stem: "figure7", columns: &["mu_star", "mu_star_se", "mu_star_contact", "regime"] }
            }
            Self::Frequency | Self::FrequencyMap => {
                DataFile { stem: "frequency_map", columns: &["frequency_hz", "regime"] }
            }
            Self::RegimeMap => DataFile { stem: "regime_map", columns: &["regime", "error"] },
            Self::Shares => DataFile {
                stem: "shares",
                columns: &["stick_share", "slip_share", "separated_share", "regime"],
            },
        }
    }

    /// What it shows, in words.
    pub fn title(self) -> &'static str {
        match self {
            Self::MuStar => "macroscopic friction coefficient μ*",
            Self::Frequency => "frequency",
            Self::RegimeMap => "contact regimes",
            Self::FrequencyMap => "map of frequencies",
            Self::Shares => "shares of stick, slip and separation",
        }
    }
}

/// One figure: the jobs with one combination of the further parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// The part of its file name that is unique to this combination, e.g. `-clamp_side-inner_side`; may be empty.
    pub suffix: String,
    /// The combination in words; may be empty.
    pub caption: String,
    /// The drawing as SVG.
    pub svg: String,
}

/// Draws one figure per combination of the further parameters.
///
/// # Errors
/// [`FigureError`].
pub fn figures(rows: &[JobRow], plot: Plot) -> Result<Vec<Figure>, FigureError> {
    figures_of(&Layout::new(rows), plot)
}

pub(super) fn figures_of(layout: &Layout, plot: Plot) -> Result<Vec<Figure>, FigureError> {
    let mut taken = HashSet::new();
    let draw = |group: &Group| {
        let svg = match plot {
            Plot::MuStar => chart::draw(layout, group, Ordinate::MuStar),
            Plot::Frequency => chart::draw(layout, group, Ordinate::Frequency),
            Plot::RegimeMap => map::regimes(layout, group),
            Plot::FrequencyMap => map::frequencies(layout, group),
            Plot::Shares => shares::draw(layout, group),
        }?;
        Ok(Figure { suffix: unique_suffix(group, &mut taken), caption: group.caption(), svg })
    };
    layout.groups.iter().map(draw).collect()
}

/// Largest length of the part of a file name that comes from parameters. File systems allow 255 bytes in all.
const MAX_SUFFIX: usize = 120;

/// The combination as a part of a file name that is unique.
fn unique_suffix(group: &Group, taken: &mut HashSet<String>) -> String {
    let words: Vec<String> =
        group.key.iter().map(|(name, value)| format!("-{name}-{}", value::text(value))).collect();
    let slug: String = value::file_name_part(&words.concat()).chars().take(MAX_SUFFIX).collect();
    let numbered = (2..).map(|n| format!("{slug}-{n}"));
    std::iter::once(slug.clone())
        .chain(numbered)
        .find(|candidate| taken.insert(candidate.to_lowercase()))
        .unwrap_or(slug)
}

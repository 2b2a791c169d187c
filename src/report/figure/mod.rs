//! Figure 7 and its companions, as SVG: curves against disk speed, maps over speed and friction, shares, residuals.

#![expect(clippy::cast_possible_wrap, reason = "pixels and legend lines: thousands, not billions")]

mod band;
mod bifurcation;
mod cells;
mod chart;
mod colour_key;
mod data;
mod legend;
mod marker;
mod panels;
mod places;
pub(super) mod residuals;
mod shares;
pub(super) mod stability;
mod style;
pub(super) mod waterfall;

use super::layout::{Layout, MAX_TOOLTIPS};
use super::row::JobRow;
use super::scalar::{FREQUENCY, MU_STAR, Scalar};
use super::spectra::Spectra;
use super::stability_point::StabilityPoint;
use super::view::View;
use crate::publish::FigureError;
use crate::publish::chart::Chart;
use panels::MAX_PANELS;
pub use stability::{StabilityPlot, stability_figures};
use std::borrow::Cow;
use std::ops::Range;

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
    /// Range of the normal force and amplitudes of nodes over the disk speed.
    Bifurcation,
    /// Contact regimes on true axes of disk speed and friction coefficient.
    RegimePlane,
    /// Growth rates of steady sliding on the same axes.
    GrowthRate,
    /// Stored spectra of the normal force over the disk speed.
    Waterfall,
    /// Another number of the record, over the disk speed.
    Of(&'static Scalar),
}

/// A file with the data behind a figure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct DataFile {
    /// Its name without the ending.
    pub stem: Cow<'static, str>,
    /// The fields of the export that it has, besides the parameters and the status.
    pub columns: Cow<'static, [&'static str]>,
}

impl DataFile {
    const fn new(stem: &'static str, columns: &'static [&'static str]) -> Self {
        Self { stem: Cow::Borrowed(stem), columns: Cow::Borrowed(columns) }
    }
}

/// The data behind the figure of residuals.
pub(super) const RESIDUALS: DataFile = DataFile::new("residuals", &["energy_residual", "identity_residual"]);
/// The data behind the statistics of run times.
pub(super) const RUN_TIMES: DataFile =
    DataFile::new("run_times", &["wall_s", "steps", "simulated_s", "time_step_s"]);

/// The columns behind the bifurcation diagram.
const BIFURCATION: [&str; 6] = [
    "n_over_f_min",
    "n_over_f_max",
    "front_centre_y_peak_to_peak_m",
    "rear_centre_y_peak_to_peak_m",
    "lift_max_m",
    "regime",
];

impl Plot {
    /// Those of every report.
    pub const ALL: [Self; 9] = [
        Self::MuStar,
        Self::Frequency,
        Self::RegimeMap,
        Self::FrequencyMap,
        Self::Shares,
        Self::Bifurcation,
        Self::RegimePlane,
        Self::GrowthRate,
        Self::Waterfall,
    ];

    /// The name of its files without the ending.
    pub fn stem(self) -> &'static str {
        match self {
            Self::MuStar => "mu_star",
            Self::Frequency => "frequency",
            Self::RegimeMap => "regime_map",
            Self::FrequencyMap => "frequency_map",
            Self::Shares => "shares",
            Self::Bifurcation => "bifurcation",
            Self::RegimePlane => "regime_plane",
            Self::GrowthRate => "growth_rate",
            Self::Waterfall => "waterfall",
            Self::Of(scalar) => scalar.name,
        }
    }

    /// The file with the data behind it.
    pub(super) fn data(self) -> DataFile {
        match self {
            Self::MuStar => {
                DataFile::new("mu_star_points", &["mu_star", "mu_star_se", "mu_star_contact", "regime"])
            }
            Self::Frequency | Self::FrequencyMap => {
                DataFile::new("frequency_map", &["frequency_hz", "regime"])
            }
            Self::RegimeMap | Self::RegimePlane => DataFile::new("regime_map", &["regime", "error"]),
            Self::Shares => {
                DataFile::new("shares", &["stick_share", "slip_share", "separated_share", "regime"])
            }
            Self::Bifurcation => DataFile::new("bifurcation", &BIFURCATION),
            Self::GrowthRate => DataFile::new("growth_rate", &["growth_rate_per_s", "regime"]),
            // The lines of the spectra are in a file of their own; these columns are those of the dots.
            Self::Waterfall => DataFile::new("frequency_map", &["frequency_hz", "regime"]),
            Self::Of(scalar) => DataFile {
                stem: format!("{}_points", scalar.name).into(),
                columns: vec![scalar.name, "regime"].into(),
            },
        }
    }

    /// What it shows, in words.
    pub fn title(self) -> Cow<'static, str> {
        match self {
            Self::MuStar => "macroscopic friction coefficient μ*".into(),
            Self::Frequency => "frequency".into(),
            Self::RegimeMap => "contact regimes".into(),
            Self::FrequencyMap => "map of frequencies".into(),
            Self::Shares => "shares of stick, slip and separation".into(),
            Self::Bifurcation => "bifurcation diagram: range of N/F and amplitudes".into(),
            Self::RegimePlane => "contact regimes on true axes".into(),
            Self::GrowthRate => "growth rates of steady sliding".into(),
            Self::Waterfall => "spectra of the normal force".into(),
            Self::Of(scalar) => scalar.title().into(),
        }
    }

    /// Why a study has no figure of this kind, in a sentence; none if it has.
    pub(super) fn absence(self, layout: &Layout, spectra: &Spectra) -> Option<&'static str> {
        let has_spectrum =
            |group: &super::layout::Group| group.jobs.iter().any(|job| spectra.contains_key(&job.row.job));
        match self {
            Self::RegimePlane | Self::GrowthRate
                if !layout
                    .on_true_axes()
                    .as_ref()
                    .map_or_else(|| cells::has_true_axes(layout), cells::has_true_axes) =>
            {
                Some("There is no map on true axes, because an axis has names and no numbers.")
            }
            Self::Waterfall if !layout.groups.iter().any(has_spectrum) => Some(
                "There is no waterfall of spectra, because no spectrum is stored. `tribosweep inspect STUDY --all --only \
                 spectrum` stores them; write the report again afterwards.",
            ),
            _ => None,
        }
    }

    /// Whether it can show measured points beside jobs.
    pub(super) fn shows_measured(self) -> bool {
        matches!(self, Self::MuStar | Self::Frequency | Self::Of(_))
    }
}

/// One figure: a panel for each of some combinations of the further parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// The part of its file name after the stem: empty for the first figure, then `-2`, `-3` …
    pub suffix: String,
    /// Which combinations it shows; empty if there is only one figure.
    pub caption: String,
    /// The combinations by their numbers.
    pub groups: Range<usize>,
    /// The drawing as SVG.
    pub svg: String,
    /// The drawing, of maps and of the stability.
    pub chart: Chart,
}

impl Figure {
    /// The figure on sheet `number` of a layout with `of_sheet` combinations on a sheet.
    fn of_sheet(layout: &Layout, number: usize, of_sheet: usize, svg: String) -> Self {
        let count = layout.groups.len();
        let first = number * of_sheet;
        let groups = first..(first + of_sheet).min(count);
        if count <= of_sheet {
            return Self {
                suffix: String::new(),
                caption: String::new(),
                groups,
                svg,
                chart: Chart::default(),
            };
        }
        let suffix = if number == 0 { String::new() } else { format!("-{}", number + 1) };
        let caption = if of_sheet == 1 {
            layout.groups[first].caption()
        } else {
            format!("combinations {} to {} of {count}", first + 1, groups.end)
        };
        Self { suffix, caption, groups, svg, chart: Chart::default() }
    }

    fn of_chart(layout: &Layout, number: usize, of_sheet: usize, chart: Chart) -> Self {
        let own = Self::of_sheet(layout, number, of_sheet, chart.svg(""));
        Self { chart, ..own }
    }
}

/// Draws the combinations of the further parameters, up to twelve in one figure, with the same axes and colours. There is no
/// figure if the plot does not exist for these rows: a map on true axes needs numbers on both axes, and a waterfall needs
/// stored spectra.
///
/// # Errors
/// [`FigureError`].
pub fn figures(rows: &[JobRow], view: &View, plot: Plot) -> Result<Vec<Figure>, FigureError> {
    figures_with(rows, view, plot, &[])
}

/// As [`figures`], with the boundary of the linear stability of steady sliding at these points.
///
/// # Errors
/// [`FigureError`].
pub fn figures_with(
    rows: &[JobRow],
    view: &View,
    plot: Plot,
    points: &[StabilityPoint],
) -> Result<Vec<Figure>, FigureError> {
    figures_of(&Layout::of(rows, view), plot, &Spectra::new(), points)
}

/// The figures of a number over the other parameters of jobs that are points and no grid, one for each parameter that is a number. There
/// are none for a grid, and none of other plots.
pub(super) fn over_others(
    rows: &[JobRow],
    view: &View,
    layout: &Layout,
    plot: Plot,
) -> Result<Vec<Figure>, FigureError> {
    let scalar = match plot {
        Plot::MuStar => &MU_STAR,
        Plot::Frequency => &FREQUENCY,
        Plot::Of(scalar) => scalar,
        _ => return Ok(Vec::new()),
    };
    let is_number = |name: &&&str| rows.iter().any(|row| row.parameter(name).is_number());
    let draw = |name: &&str| {
        let own = Layout::of(rows, &View { x: Some((*name).to_owned()), ..view.clone() });
        Ok(Figure {
            suffix: format!("-over-{name}"),
            caption: format!("over {}", own.axis_name()),
            groups: 0..1,
            svg: chart::draw(&own, &own.groups, scalar)?,
            chart: Chart::default(),
        })
    };
    layout.scattered.iter().filter(is_number).map(draw).collect()
}

pub(super) fn figures_of(
    layout: &Layout,
    plot: Plot,
    spectra: &Spectra,
    points: &[StabilityPoint],
) -> Result<Vec<Figure>, FigureError> {
    if plot.absence(layout, spectra).is_some() {
        return Ok(Vec::new());
    }
    let own = match plot {
        Plot::RegimePlane | Plot::GrowthRate => layout.on_true_axes(),
        _ => None,
    };
    let layout = own.as_ref().unwrap_or(layout);
    let of_sheet = match plot {
        // The shares have a panel for each curve of each group.
        Plot::Shares => (MAX_PANELS / layout.series.len().max(1)).max(1),
        // These fill a sheet.
        Plot::Bifurcation | Plot::RegimePlane | Plot::GrowthRate | Plot::Waterfall => 1,
        _ => MAX_PANELS,
    };
    let map = |groups: &[super::layout::Group]| match plot {
        Plot::RegimeMap => Some(cells::regimes(layout, groups)),
        Plot::FrequencyMap => Some(cells::frequencies(layout, groups)),
        Plot::RegimePlane => Some(cells::regimes_on_true_axes(layout, &groups[0], points)),
        Plot::GrowthRate => Some(cells::growth_rates(layout, &groups[0])),
        _ => None,
    };
    let draw = |(number, groups): (usize, &[super::layout::Group])| {
        if let Some(chart) = map(groups) {
            return Ok(chart.map(|chart| Figure::of_chart(layout, number, of_sheet, chart)));
        }
        let svg = match plot {
            Plot::MuStar => chart::draw(layout, groups, &MU_STAR),
            Plot::Frequency => chart::draw(layout, groups, &FREQUENCY),
            Plot::Of(scalar) => chart::draw(layout, groups, scalar),
            Plot::Shares => shares::draw(layout, groups),
            Plot::Bifurcation => bifurcation::draw(layout, &groups[0]),
            Plot::Waterfall => waterfall::draw(layout, &groups[0], spectra),
            _ => return Ok(None),
        }?;
        Ok(Some(Figure::of_sheet(layout, number, of_sheet, svg)))
    };
    layout.groups.chunks(of_sheet).enumerate().map(draw).filter_map(Result::transpose).collect()
}

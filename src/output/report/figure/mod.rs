//! Figure 7 and its companions: curves against disk speed, maps over speed and friction, shares, residuals.

mod bifurcation;
mod cells;
mod curves;
pub(super) mod differences;
mod edges;
pub(super) mod pairs;
mod places;
pub(super) mod residuals;
mod shares;
mod span;
pub(super) mod stability;
pub(super) mod waterfall;

use super::columns::{ExportColumn, columns};
use super::layout::{Group, Layout};
use super::row::JobRow;
use super::scalar::{FREQUENCY, MU_STAR, Scalar};
use super::spectra::Spectra;
use super::stability_point::StabilityPoint;
use super::view::View;
use crate::publish::chart::{Chart, MAX_TIPS};
pub use stability::{StabilityPlot, stability_figures};
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

/// Largest number of panels in a figure. A report with more combinations has several figures of a kind.
const MAX_PANELS: usize = 12;

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
    /// The span of μ* over everything but the disk speed and μ, if it is asked for.
    Span,
    /// Another number of the record, over the disk speed.
    Of(&'static Scalar),
}

/// A file with the data behind a figure.
#[derive(Debug, Clone)]
pub(super) struct DataFile {
    /// Its name without the ending.
    pub stem: Cow<'static, str>,
    /// The columns of the export that it has, besides the parameters and the status.
    pub columns: Cow<'static, [&'static ExportColumn]>,
}

impl DataFile {
    const fn new(stem: &'static str, columns: &'static [&'static ExportColumn]) -> Self {
        Self { stem: Cow::Borrowed(stem), columns: Cow::Borrowed(columns) }
    }
}

/// The data behind the figure of residuals.
pub(super) const RESIDUALS: DataFile = DataFile::new("residuals", &OF_RESIDUALS);
static OF_RESIDUALS: [&ExportColumn; 2] = columns(["energy_residual", "identity_residual"]);
/// The data behind the statistics of run times.
pub(super) const RUN_TIMES: DataFile = DataFile::new("run_times", &OF_RUN_TIMES);
static OF_RUN_TIMES: [&ExportColumn; 4] = columns(["wall_s", "steps", "simulated_s", "time_step_s"]);

static OF_MU_STAR: [&ExportColumn; 5] =
    columns(["mu_star", "mu_star_se", "mu_star_mesh_error", "mu_star_contact", "regime"]);
static OF_FREQUENCY: [&ExportColumn; 3] = columns(["frequency_hz", "frequency_mesh_error_hz", "regime"]);
static OF_REGIME: [&ExportColumn; 2] = columns(["regime", "error"]);
static OF_SHARES: [&ExportColumn; 4] = columns(["stick_share", "slip_share", "separated_share", "regime"]);
static OF_GROWTH_RATE: [&ExportColumn; 2] = columns(["growth_rate_per_s", "regime"]);
static OF_BIFURCATION: [&ExportColumn; 6] = columns([
    "n_over_f_min",
    "n_over_f_max",
    "front_centre_y_peak_to_peak_m",
    "rear_centre_y_peak_to_peak_m",
    "lift_max_m",
    "regime",
]);

impl Plot {
    /// Those of every report; the span only where a view asks for it.
    pub const ALL: [Self; 10] = [
        Self::MuStar,
        Self::Span,
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
            Self::MuStar => MU_STAR.name,
            Self::Frequency => "frequency",
            Self::RegimeMap => "regime_map",
            Self::FrequencyMap => "frequency_map",
            Self::Shares => "shares",
            Self::Bifurcation => "bifurcation",
            Self::RegimePlane => "regime_plane",
            Self::GrowthRate => "growth_rate",
            Self::Waterfall => "waterfall",
            Self::Span => "span",
            Self::Of(scalar) => scalar.name,
        }
    }

    /// The file with the data behind it.
    pub(super) fn data(self) -> DataFile {
        match self {
            Self::MuStar | Self::Span => DataFile::new("mu_star_points", &OF_MU_STAR),
            // The lines of the spectra of a waterfall are in a file of their own; these columns are those of the dots.
            Self::Frequency | Self::FrequencyMap | Self::Waterfall => {
                DataFile::new("frequency_map", &OF_FREQUENCY)
            }
            Self::RegimeMap | Self::RegimePlane => DataFile::new("regime_map", &OF_REGIME),
            Self::Shares => DataFile::new("shares", &OF_SHARES),
            Self::Bifurcation => DataFile::new("bifurcation", &OF_BIFURCATION),
            Self::GrowthRate => DataFile::new("growth_rate", &OF_GROWTH_RATE),
            Self::Of(scalar) => DataFile {
                stem: format!("{}_points", scalar.name).into(),
                columns: vec![scalar.column, OF_REGIME[0]].into(),
            },
        }
    }

    /// What it shows, in words.
    pub fn title(self) -> Cow<'static, str> {
        match self {
            Self::MuStar => MU_STAR.meaning.into(),
            Self::Frequency => FREQUENCY.meaning.into(),
            Self::RegimeMap => "contact regimes".into(),
            Self::FrequencyMap => "map of frequencies".into(),
            Self::Shares => "shares of stick, slip and separation".into(),
            Self::Bifurcation => "bifurcation diagram: range of N/F and amplitudes".into(),
            Self::RegimePlane => "contact regimes on true axes".into(),
            Self::GrowthRate => "growth rates of steady sliding".into(),
            Self::Waterfall => "spectra of the normal force".into(),
            Self::Span => "span of the macroscopic friction coefficient".into(),
            Self::Of(scalar) => scalar.title().into(),
        }
    }

    /// Whether a study has a figure of this kind: a map on true axes needs numbers on both axes, and a waterfall needs stored
    /// spectra.
    fn exists(self, layout: &Layout, spectra: &Spectra) -> bool {
        let has_spectrum = |group: &Group| group.jobs.iter().any(|job| spectra.contains_key(&job.row.job));
        match self {
            Self::RegimePlane | Self::GrowthRate => layout
                .on_true_axes()
                .as_ref()
                .map_or_else(|| cells::has_true_axes(layout), cells::has_true_axes),
            Self::Waterfall => layout.groups.iter().any(has_spectrum),
            // Their lines and areas would join points that differ in other parameters.
            Self::Shares | Self::Bifurcation => layout.scattered.is_empty(),
            _ => true,
        }
    }

    /// Whether it can show measured points beside jobs.
    pub(super) fn shows_measured(self) -> bool {
        matches!(self, Self::MuStar | Self::Span | Self::Frequency | Self::Of(_))
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
    /// What it shows, in words.
    pub alternative: String,
    /// The drawing.
    pub chart: Chart,
    /// The drawing as SVG.
    pub svg: String,
}

impl Figure {
    /// The figure on sheet `number` of a layout with `of_sheet` combinations on a sheet. `title` says what it shows.
    fn of_sheet(layout: &Layout, number: usize, of_sheet: usize, title: &str, chart: Chart) -> Self {
        let count = layout.groups.len();
        let first = number * of_sheet;
        let groups = first..(first + of_sheet).min(count);
        let suffix = if number == 0 { String::new() } else { format!("-{}", number + 1) };
        let caption = match of_sheet {
            _ if count <= of_sheet => String::new(),
            1 => layout.groups[first].caption(),
            _ => format!("combinations {} to {} of {count}", first + 1, groups.end),
        };
        Self::new(suffix, caption, groups, title, chart)
    }

    fn new(suffix: String, caption: String, groups: Range<usize>, title: &str, chart: Chart) -> Self {
        let words = [title, &caption].into_iter().filter(|words| !words.is_empty()).collect::<Vec<_>>();
        let alternative = words.join(", ");
        let svg = chart.svg(&alternative);
        Self { suffix, caption, groups, alternative, chart, svg }
    }

    /// The figure in which the marks of jobs lead to their pages.
    ///
    /// Only the drawing is left, because the points of many jobs take a lot of memory.
    pub(super) fn finished(mut self, pages: &HashMap<String, String>) -> Self {
        if self.chart.link(pages) {
            self.svg = self.chart.svg(&self.alternative);
        }
        self.chart = Chart::default();
        self
    }
}

/// Draws the combinations of the further parameters, up to twelve in one figure, with the same axes and colours. There is no
/// figure if the plot does not exist for these rows: a map on true axes needs numbers on both axes, and a waterfall needs
/// stored spectra.
pub fn figures(rows: &[JobRow], view: &View, plot: Plot) -> Vec<Figure> {
    figures_with(rows, view, plot, &[])
}

/// As [`figures`], with the boundary of the linear stability of steady sliding at these points.
pub fn figures_with(rows: &[JobRow], view: &View, plot: Plot, points: &[StabilityPoint]) -> Vec<Figure> {
    figures_of(&Layout::of(rows, view), plot, &Spectra::new(), points)
}

/// The figures of a number over the other parameters of jobs that are points and no grid, one for each parameter that is a number. There
/// are none for a grid, and none of other plots.
pub(super) fn over_others(rows: &[JobRow], view: &View, layout: &Layout, plot: Plot) -> Vec<Figure> {
    let scalar = match plot {
        Plot::MuStar => MU_STAR,
        Plot::Frequency => FREQUENCY,
        Plot::Of(scalar) => scalar,
        _ => return Vec::new(),
    };
    let is_number = |name: &&&str| rows.iter().any(|row| row.parameter(name).is_number());
    let draw = |name: &&str| {
        let own = Layout::of(rows, &View { x: Some((*name).to_owned()), ..view.clone() });
        let chart = with_tips_of_few(&own.groups, curves::draw(&own, &own.groups, scalar));
        let caption = format!("over {}", own.axis_name());
        Figure::new(format!("-over-{name}"), caption, 0..1, &plot.title(), chart)
    };
    layout.scattered.iter().filter(is_number).map(draw).collect()
}

/// The chart without tooltips, if they would make its file too large.
fn with_tips_of_few(groups: &[Group], chart: Chart) -> Chart {
    let jobs: usize = groups.iter().map(|group| group.jobs.len()).sum();
    if jobs <= MAX_TIPS { chart } else { chart.without_tips() }
}

pub(super) fn figures_of(
    layout: &Layout,
    plot: Plot,
    spectra: &Spectra,
    points: &[StabilityPoint],
) -> Vec<Figure> {
    if !plot.exists(layout, spectra) {
        return Vec::new();
    }
    let own = match plot {
        Plot::RegimePlane | Plot::GrowthRate => layout.on_true_axes(),
        _ => None,
    };
    let layout = own.as_ref().unwrap_or(layout);
    let of_sheet = match plot {
        // The shares have a panel for each curve of each group.
        Plot::Shares => (MAX_PANELS / layout.series.len().max(1)).max(1),
        Plot::Span => layout.groups.len().max(1),
        // These fill a sheet.
        Plot::Bifurcation | Plot::RegimePlane | Plot::GrowthRate | Plot::Waterfall => 1,
        _ => MAX_PANELS,
    };
    let draw = |(number, groups): (usize, &[Group])| {
        let chart = match plot {
            Plot::MuStar => curves::draw(layout, groups, MU_STAR),
            Plot::Frequency => curves::draw(layout, groups, FREQUENCY),
            Plot::Of(scalar) => curves::draw(layout, groups, scalar),
            Plot::Span => span::draw(layout, groups, MU_STAR),
            Plot::RegimeMap => cells::regimes(layout, groups)?,
            Plot::FrequencyMap => cells::frequencies(layout, groups)?,
            Plot::Shares => shares::draw(layout, groups),
            Plot::Bifurcation => bifurcation::draw(layout, &groups[0]),
            Plot::RegimePlane => cells::regimes_on_true_axes(layout, &groups[0], points)?,
            Plot::GrowthRate => cells::growth_rates(layout, &groups[0])?,
            Plot::Waterfall => waterfall::draw(layout, &groups[0], spectra),
        };
        Some(Figure::of_sheet(layout, number, of_sheet, &plot.title(), with_tips_of_few(groups, chart)))
    };
    layout.groups.chunks(of_sheet).enumerate().filter_map(draw).collect()
}

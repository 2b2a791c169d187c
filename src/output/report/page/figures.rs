//! Sections with figures, the data behind them, and tables.

use super::tables::{MAX_DRAWN, MAX_JOBS, see_files, what_is_left_out};
use super::{Parts, head, tables};
use crate::analysis::{Outcome, Regime};
use crate::publish::chart::MAX_TIPS;
use crate::publish::page::{Block, Figure as Shown, Section, Span, Text};
use crate::report::explore;
use crate::report::export;
use crate::report::figure::{DataFile, Figure, Plot, RESIDUALS};
use crate::report::layout::{Layout, MAX_SHEETS};
use crate::report::row::JobRow;
use crate::report::scalar::Scalar;
use crate::report::tables::Quantity;

/// Largest number of figures of a kind over different parameters.
const MAX_MARGINAL: usize = 8;

pub(super) fn friction(parts: &Parts) -> Section {
    let is_known = parts.report.rows.iter().any(|row| row.mesh_error().is_some());
    let bands = if is_known { " Bands: the mesh error, where it is known." } else { "" };
    let caption = format!(
        "Macroscopic friction coefficient μ* {}. Error bars: standard error over the cycles, where it is larger than a \
         marker{}.{bands}",
        curves(parts.layouts.all),
        if parts.report.rows.iter().any(JobRow::is_measured) {
            ", and the given error of measured points"
        } else {
            ""
        }
    );
    let mut blocks = figures(parts, Plot::MuStar, &caption);
    let span = format!(
        "Span of μ* {}: a panel for each {}, from the smallest to the largest value of all jobs there that have settled. Line: {}, where \
         it has one job.",
        against(parts.layouts.all),
        parts.layouts.all.dimension(parts.layouts.all.by).label,
        parts.layouts.all.sources.first().map_or("", |first| first.name)
    );
    blocks.extend(figures(parts, Plot::Span, &span));
    blocks.extend(head::numbers(parts.report.rows));
    let page = Span::Link("page to explore".to_owned(), explore::PAGE.to_owned());
    blocks.push(Block::Text(
        Text::from("Other axes, single curves and all jobs in one table: ").and(page).and("."),
    ));
    if parts.report.rows.iter().any(JobRow::is_at_boundary) {
        blocks.push(Block::note(
            "Jobs that were added at boundaries are in maps, in the page to explore and in `jobs.csv`. Curves and tables \
             have the other jobs.",
        ));
    }
    blocks.extend(tables::below(parts, Quantity::MuStar));
    Section::new("friction", "Macroscopic friction", blocks)
}

/// What the figures of curves have along their axis.
fn against(layout: &Layout) -> String {
    if layout.scattered.is_empty() {
        format!("against {}", layout.axis_label())
    } else {
        "against each parameter that varies".to_owned()
    }
}

/// What a figure of curves shows.
fn curves(layout: &Layout) -> String {
    let what = if layout.scattered.is_empty() {
        format!("one curve for each {}", layout.by_words())
    } else {
        "a point for each job".to_owned()
    };
    format!("{}, {what}", against(layout))
}

/// Whether a job did not become periodic, so that its marks have to be explained.
fn has_aperiodic(parts: &Parts) -> bool {
    let mut records = parts.report.rows.iter().filter_map(JobRow::record);
    records.any(|record| record.outcome == Outcome::NotPeriodic)
}

pub(super) fn frequency(parts: &Parts) -> Section {
    let (axis, by) = (parts.layouts.all.axis_label(), parts.layouts.all.by_words());
    let aperiodic = has_aperiodic(parts);
    let curves = format!(
        "Fundamental frequency of the total normal contact force {}.{}",
        against(parts.layouts.all),
        if aperiodic {
            " The axis spans the frequencies of periodic jobs. Hollow: not periodic, the mean rate of the cycles; an arrow: \
             outside of the axis."
        } else {
            ""
        }
    );
    let without =
        parts.report.rows.iter().any(|row| row.record().is_none_or(|record| record.frequency_hz.is_none()));
    let map = format!(
        "The same frequencies over {axis} and {by}.{}{}",
        if without { " Letters mark jobs without a frequency." } else { "" },
        if aperiodic { " ~: not periodic, and not in the colour scale." } else { "" }
    );
    let waterfall = format!(
        "Stored spectra of the total normal contact force over {axis}, a panel for each {by}. A dot marks the fundamental \
         frequency."
    );
    let mut blocks = figures(parts, Plot::Frequency, &curves);
    blocks.extend(figures(parts, Plot::FrequencyMap, &map));
    blocks.extend(figures(parts, Plot::Waterfall, &waterfall));
    blocks.extend(tables::folded(parts, Quantity::Frequency));
    Section::new("frequency", "Frequency", blocks)
}

pub(super) fn regimes(parts: &Parts) -> Section {
    let named = |regime| !matches!(regime, Regime::Stable | Regime::Undecided);
    let pale = |row: &JobRow| {
        row.record().is_some_and(|record| record.outcome == Outcome::NotPeriodic && named(record.regime))
    };
    let (axis, by) = (parts.layouts.all.axis_label(), parts.layouts.all.by_words());
    let note = if parts.report.rows.iter().any(pale) {
        " A small letter on a pale colour: the run did not become periodic."
    } else {
        ""
    };
    let map = format!("Contact regime of every job over {axis} and {by}.{note}");
    let boundary = if parts.report.stability.is_empty() {
        ""
    } else {
        " The black line is the threshold of linear stability: on its unstable side, a mode of steady sliding grows. A triangle marks a \
         limit cycle where every mode decays. A diamond marks a job in which a mode grows, but μ* is within 0.1 % of that of \
         steady sliding."
    };
    let plane = format!(
        "The same regimes with {axis} and {by} on true axes. On a grid a dot is a job, whose cell ends half-way to its neighbours; \
         elsewhere a square is a job.{boundary}"
    );
    let growth = format!(
        "Growth rate of the fastest growing, or slowest decaying, strong line of jobs that ended in steady sliding, over \
         {axis} and {by}. Blue decays: sliding is stable. Letters mark jobs without a growth rate, which have a limit cycle \
         or no result."
    );
    let mut blocks = figures(parts, Plot::RegimeMap, &map);
    blocks.extend(figures(parts, Plot::RegimePlane, &plane));
    blocks.extend(figures(parts, Plot::GrowthRate, &growth));
    blocks.extend(tables::folded(parts, Quantity::Regime));
    Section::new("regimes", "Contact regimes", blocks)
}

pub(super) fn bifurcation(parts: &Parts) -> Section {
    let caption = format!(
        "Bifurcation diagram {}: the largest and the smallest total normal contact force N over the load F, the range \
         of the displacement in y of the observed nodes, and the largest gap of a node, all in the averaging window. Steady \
         sliding collapses to N/F = 1 and to no amplitude (dashed). N is smoothed. Hollow: not periodic.",
        against(parts.layouts.all)
    );
    Section::new("bifurcation", "Amplitudes", figures(parts, Plot::Bifurcation, &caption))
}

pub(super) fn shares(parts: &Parts) -> Section {
    let caption = format!(
        "Shares of stick, slip and separation in the time of all contact nodes, against {}. White lines mark the jobs.",
        parts.layouts.all.axis_label()
    );
    Section::new("shares", "Stick, slip and separation", figures(parts, Plot::Shares, &caption))
}

/// A quantity that a reader asked for.
pub(super) fn quantity(parts: &Parts, scalar: &'static Scalar) -> Section {
    let caption = format!("{} {}.", scalar.title(), curves(parts.layouts.all));
    let mut blocks = figures(parts, Plot::Of(scalar), &caption);
    blocks.extend(tables::folded(parts, Quantity::Of(scalar)));
    Section::new(scalar.name, scalar.meaning, blocks)
}

pub(super) fn residuals(parts: &Parts) -> Section {
    let rows = parts.report.rows;
    let caption = "Residuals of every job: of the energy balance over the whole run, relative to the energy put in, and \
                   the larger one of two identities over the averaging window.";
    let file = format!("{}.svg", RESIDUALS.stem);
    let block = if rows.len() <= MAX_DRAWN {
        let data = data(parts, rows.iter(), rows.len(), &RESIDUALS);
        let svg = parts.residuals.to_owned();
        Block::figure(Shown { file, svg, caption: caption.to_owned(), data: Some(data) })
    } else {
        Block::note(&format!("… {} jobs are too many for this page: see `{file}` in its folder.", rows.len()))
    };
    Section::new("residuals", "Residuals", vec![block])
}

/// A link that contains the data of all jobs, if they are not too many.
pub(super) fn download(parts: &Parts, file: &DataFile) -> Text {
    let rows = parts.report.rows;
    match data(parts, rows.iter(), rows.len(), file) {
        (name, Some(csv)) => Text::from(" ").and(Span::Download(name, csv)),
        (name, None) => Text::from(" Data: ").and(Text::code(name)).and("."),
    }
}

/// The data behind a figure: the file in the folder, and its contents if these are not too long for a page.
fn data<'a>(
    parts: &Parts,
    rows: impl Iterator<Item = &'a JobRow>,
    count: usize,
    data: &DataFile,
) -> (String, Option<String>) {
    let csv =
        |rows| export::selection(data.stem.clone(), rows, &parts.layouts.all.varied, &data.columns).csv();
    (format!("{}.csv", data.stem), (count <= MAX_TIPS).then(|| csv(rows.collect::<Vec<_>>())))
}

/// The figures of one kind, with the data behind them; nothing if the study has none.
fn figures(parts: &Parts, plot: Plot, caption: &str) -> Vec<Block> {
    let layout = parts.layouts.of(plot);
    let of_plot = plot.data();
    let all = || parts.figures.iter().filter(|(own, _)| *own == plot).flat_map(|(_, figures)| figures);
    if all().next().is_none() {
        return Vec::new();
    }
    let mut jobs = 0;
    let fitting = all().enumerate().take_while(|(number, figure)| {
        jobs += jobs_of(layout, figure);
        let sheets = if layout.scattered.is_empty() { MAX_SHEETS } else { MAX_MARGINAL };
        if *number == 0 {
            jobs <= MAX_DRAWN
        } else {
            *number < sheets && jobs <= MAX_DRAWN.min(MAX_JOBS * sheets / 2)
        }
    });
    let mut blocks = Vec::new();
    let mut shown = 0;
    for (_, figure) in fitting {
        shown = figure.groups.end;
        if !figure.caption.is_empty() {
            blocks.push(Block::Heading(figure.caption.clone()));
        }
        let rows =
            layout.groups[figure.groups.clone()].iter().flat_map(|group| &group.jobs).map(|job| job.row);
        let data = data(parts, rows, jobs_of(layout, figure), &of_plot);
        let is_large = data.1.is_none();
        blocks.push(Block::figure(Shown {
            file: format!("{}{}.svg", plot.stem(), figure.suffix),
            svg: figure.svg.clone(),
            caption: caption.to_owned(),
            data: Some(data),
        }));
        if is_large {
            blocks.push(Block::note("There are too many jobs for tooltips."));
        }
        if plot == Plot::Waterfall {
            blocks.push(Block::note("All lines of the spectra are in `waterfall.csv`."));
        }
    }
    if shown < layout.groups.len() {
        blocks.push(see_files(&what_is_left_out(layout, shown), &format!("{}*.svg", plot.stem())));
    }
    blocks
}

/// Whether a figure can stand in a page. Larger ones are in their files alone.
pub(in crate::report) fn has_room_for(layout: &Layout, figure: &Figure) -> bool {
    jobs_of(layout, figure) <= MAX_DRAWN
}

fn jobs_of(layout: &Layout, figure: &Figure) -> usize {
    layout.groups[figure.groups.clone()].iter().map(|group| group.jobs.len()).sum()
}

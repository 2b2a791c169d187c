//! Sections with figures, the data behind them, and tables.

use super::parts::Parts;
use crate::analysis::{Outcome, Regime};
use crate::publish::{html, value};
use crate::report::Discretisation;
use crate::report::export;
use crate::report::figure::{DataFile, Figure, Plot, RESIDUALS, RUN_TIMES};
use crate::report::layout::{Group, Layout, MAX_TOOLTIPS, parameters_in_words};
use crate::report::row::JobRow;
use crate::report::scalar::Scalar;
use crate::report::tables::{self, Digits, Quantity};
use crate::report::times::Times;
use crate::report::tooltip::short_key;
use maud::{Markup, html};
use std::borrow::Cow;
use std::collections::HashMap;

/// Largest number of combinations of further parameters that are shown.
const MAX_GROUPS: usize = 6;
/// Largest number of jobs in all of these together …
const MAX_JOBS: usize = 4_000;
/// … unless only the first combination is shown, which may have more. Beyond this number it is not drawn either.
const MAX_DRAWN: usize = 20_000;
/// Largest number of figures of a kind.
const MAX_SHEETS: usize = 2;
/// Largest number of figures of a kind over different parameters.
const MAX_MARGINAL: usize = 8;

pub(super) fn friction(parts: &Parts) -> Markup {
    let errors =
        || parts.report.rows.iter().filter(|row| row.record().is_some()).map(|row| &row.discretisation);
    let bands = match (errors().any(|error| error.error().is_some()), errors().any(is_indicative)) {
        (false, _) => "",
        (true, false) => " Bands: the measured error of mesh and time step.",
        (true, true) => " Bands: the error of mesh and time step, paler where it is indicative only.",
    };
    let caption = format!(
        "Macroscopic friction coefficient μ* against {}, one curve for each {} (dashed: μ* = μ). Error bars: standard error \
         over the cycles, where it is larger than a marker.{bands}",
        parts.layouts.all.axis_label(),
        parts.layouts.all.by_words()
    );
    html! {
        (figures(parts, Plot::MuStar, &caption))
        (table(parts, Quantity::MuStar))
    }
}

fn is_indicative(error: &Discretisation) -> bool {
    matches!(error, Discretisation::Indicative(_))
}

/// Whether a job did not become periodic, so that its marks have to be explained.
fn has_aperiodic(parts: &Parts) -> bool {
    let records = parts.report.rows.iter().filter_map(JobRow::record);
    records.into_iter().any(|record| record.outcome == Outcome::NotPeriodic)
}

pub(super) fn frequency(parts: &Parts) -> Markup {
    let axis = parts.layouts.all.axis_label();
    let aperiodic = has_aperiodic(parts);
    let curves = format!(
        "Fundamental frequency of the total normal contact force against {axis}.{}",
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
        "The same frequencies over {axis} and {}.{}{}",
        parts.layouts.all.by_words(),
        if without { " A letter: the job has no frequency." } else { "" },
        if aperiodic { " ~: not periodic, and not in the colour scale." } else { "" }
    );
    let waterfall = format!(
        "Stored spectra of the total normal contact force over {axis}, a panel for each {}. A dot marks the fundamental \
         frequency.",
        parts.layouts.all.by_words()
    );
    html! {
        (figures(parts, Plot::Frequency, &curves))
        (figures(parts, Plot::FrequencyMap, &map))
        (figures(parts, Plot::Waterfall, &waterfall))
        (table(parts, Quantity::Frequency))
    }
}

pub(super) fn regimes(parts: &Parts) -> Markup {
    let named = |regime| !matches!(regime, Regime::Stable | Regime::Undecided);
    let pale = |row: &JobRow| {
        row.record().is_some_and(|record| record.outcome == Outcome::NotPeriodic && named(record.regime))
    };
    let caption = format!(
        "Contact regime of every job over {} and {}.{}",
        parts.layouts.all.axis_label(),
        parts.layouts.all.by_words(),
        if parts.report.rows.iter().any(pale) {
            " A small letter on a pale colour: the run did not become periodic."
        } else {
            ""
        }
    );
    let axis = parts.layouts.all.axis_label();
    let by = parts.layouts.all.by_words();
    let boundary = if parts.report.stability.is_empty() {
        ""
    } else {
        " The black line is the threshold of linear stability: on its unstable side, a mode of steady sliding grows. A triangle marks a \
         limit cycle where every mode decays. A diamond marks a job in which a mode grows, but μ* is within 0.1 % of that of \
         steady sliding."
    };
    let plane = format!(
        "The same regimes with {axis} and {by} on true axes. A dot is a job; its cell ends half-way to its \
         neighbours.{boundary}"
    );
    let growth = format!(
        "Growth rate of the fastest growing, or slowest decaying, strong line of jobs that ended in steady sliding, over \
         {axis} and {by}. Blue decays: sliding is stable. A letter: the job has no growth rate, because it has a limit cycle \
         or no result."
    );
    html! {
        (figures(parts, Plot::RegimeMap, &caption))
        (figures(parts, Plot::RegimePlane, &plane))
        (figures(parts, Plot::GrowthRate, &growth))
        (table(parts, Quantity::Regime))
    }
}

pub(super) fn bifurcation(parts: &Parts) -> Markup {
    let caption = format!(
        "Bifurcation diagram against {}: the largest and the smallest total normal contact force N over the load F, the range \
         of the displacement in y of the observed nodes, and the largest gap of a node, all in the averaging window. Steady \
         sliding collapses to N/F = 1 and to no amplitude (dashed). N is smoothed. Hollow: not periodic.",
        parts.layouts.all.axis_label()
    );
    figures(parts, Plot::Bifurcation, &caption)
}

pub(super) fn shares(parts: &Parts) -> Markup {
    let caption = format!(
        "Shares of stick, slip and separation in the time of all contact nodes, against {}. White lines mark the jobs.",
        parts.layouts.all.axis_label()
    );
    figures(parts, Plot::Shares, &caption)
}

/// The other quantities that a reader asked for.
pub(super) fn quantity(parts: &Parts, scalar: &'static Scalar) -> Markup {
    let caption = format!(
        "{} against {}, one curve for each {}.",
        scalar.title(),
        parts.layouts.all.axis_label(),
        parts.layouts.all.by_words()
    );
    html! {
        (figures(parts, Plot::Of(scalar), &caption))
        (table(parts, Quantity::Of(scalar)))
    }
}

pub(super) fn residuals(parts: &Parts) -> Markup {
    let rows = parts.report.rows;
    let has_tooltips = rows.len() <= MAX_TOOLTIPS;
    let caption = "Residuals of every job: of the energy balance over the whole run, relative to the energy put in, and \
                   the larger one of two identities over the averaging window.";
    let data = has_tooltips.then(|| csv(parts, rows.iter(), &RESIDUALS));
    let file = format!("{}.csv", RESIDUALS.stem);
    html! {
        @if rows.len() <= MAX_DRAWN {
            (html::figure(&linked(parts, parts.residuals), caption, data.as_deref().map(|csv| (file.as_str(), csv))))
        } @else {
            (see_files(&format!("{} jobs are too many for this page", rows.len()), "residuals.svg"))
        }
    }
}

pub(super) fn times(parts: &Parts) -> Markup {
    let rows = parts.report.rows;
    let Some(times) = Times::of(rows) else {
        return html! { p { "No job has ended yet." } };
    };
    let mut tiles = vec![
        ("thread time, all jobs", value::duration(times.total_s), value::count(times.jobs, "job")),
        ("shortest", value::duration(times.min_s), String::new()),
        ("median", value::duration(times.median_s), String::new()),
        ("mean", value::duration(times.mean_s), String::new()),
        ("longest", value::duration(times.max_s), String::new()),
    ];
    tiles.extend(
        times
            .steps_per_s
            .map(|steps| ("steps per second", value::fixed(steps, 0), "of a job, per thread".to_owned())),
    );
    let header = ["parameters", "thread time", "steps", "steps per second", "job"].map(str::to_owned);
    let lines: Vec<Vec<Markup>> = times.slowest.iter().map(|(row, seconds)| slow(row, *seconds)).collect();
    let data = (rows.len() <= MAX_TOOLTIPS).then(|| csv(parts, rows.iter(), &RUN_TIMES));
    html! {
        p {
            "The time of a job is its share of the time of its thread. Jobs that are advanced together have equal shares."
            @if let Some(csv) = data { " " (html::download(&format!("{}.csv", RUN_TIMES.stem), &csv)) }
        }
        (html::tiles(&tiles))
        h3 { "Slowest jobs" }
        (html::table(&header, &lines))
    }
}

fn slow(row: &JobRow, seconds: f64) -> Vec<Markup> {
    let steps = row.record().map(|record| record.steps);
    let cell = |text: Option<String>| html! { (text.as_deref().unwrap_or(value::MISSING)) };
    vec![
        html! { (parameters_in_words(row)) },
        html! { (value::duration(seconds)) },
        cell(steps.map(|steps| steps.to_string())),
        cell(steps.filter(|_| seconds > 0.0).map(|steps| value::fixed(steps as f64 / seconds, 0))),
        html! { code { (short_key(row)) } },
    ]
}

/// Number of groups that are shown in tables.
fn shown(layout: &Layout) -> usize {
    let mut jobs = 0;
    let fits = |(index, group): (usize, &Group)| {
        jobs += group.jobs.len();
        if index == 0 { jobs <= MAX_DRAWN } else { index < MAX_GROUPS && jobs <= MAX_JOBS }
    };
    layout.groups.iter().enumerate().map(fits).take_while(|fits| *fits).count()
}

/// A drawing in which the marks of inspected jobs lead to the pages of their inspections.
fn linked<'a>(parts: &Parts, svg: &'a str) -> Cow<'a, str> {
    let mut svg = Cow::Borrowed(svg);
    for (job, page) in &parts.pages {
        // Neither keys in drawings nor addresses have characters that would end the attribute.
        let mark = format!("data-job=\"{job}\"");
        if svg.contains(&mark) {
            svg = Cow::Owned(svg.replace(&mark, &format!("{mark} data-page=\"{page}\"")));
        }
    }
    svg
}

/// The figures of one kind, with the data behind them.
fn figures(parts: &Parts, plot: Plot, caption: &str) -> Markup {
    let layout = parts.layouts.of(plot);
    let data = plot.data();
    let all = || parts.figures.iter().filter(|(own, _)| *own == plot).flat_map(|(_, figures)| figures);
    let exists = all().next().is_some();
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
    let figures: Vec<&Figure> = fitting.map(|(_, figure)| figure).collect();
    let shown = figures.last().map_or(0, |figure| figure.groups.end);
    let absence = plot.absence(layout, parts.spectra);
    html! {
        @if let Some(sentence) = absence { p.note { (sentence) } }
        @for figure in figures {
            @if !figure.caption.is_empty() { h3 { (figure.caption) } }
            @let has_tooltips = jobs_of(layout, figure) <= MAX_TOOLTIPS;
            @let rows = layout.groups[figure.groups.clone()].iter().flat_map(|group| &group.jobs).map(|job| job.row);
            @let csv = has_tooltips.then(|| csv(parts, rows, &data));
            @let file = format!("{}{}.csv", data.stem, figure.suffix);
            (html::figure(&linked(parts, &figure.svg), caption, csv.as_deref().map(|csv| (file.as_str(), csv))))
            @if csv.is_none() {
                p.note { "There are too many jobs for tooltips; the data are in " code { (data.stem) ".csv" } "." }
            }
            @if plot == Plot::Waterfall {
                p.note { "All lines of the spectra are in " code { "waterfall.csv" } "." }
            }
        }
        @if exists && shown < layout.groups.len() {
            @let files = format!("{}*.svg", plot.stem());
            (see_files(&what_is_left_out(layout, shown), &files))
        }
    }
}

fn jobs_of(layout: &Layout, figure: &Figure) -> usize {
    layout.groups[figure.groups.clone()].iter().map(|group| group.jobs.len()).sum()
}

fn what_is_left_out(layout: &Layout, shown: usize) -> String {
    let groups = &layout.groups;
    let jobs: usize = groups[shown..].iter().map(|group| group.jobs.len()).sum();
    if groups.len() == 1 {
        return format!("{jobs} jobs are too many for this page");
    }
    let more = if shown > 0 { "more " } else { "" };
    format!(
        "left out of this page: {} of parameters, {}",
        value::count(groups.len() - shown, &format!("{more}combination")),
        value::count(jobs, "job")
    )
}

fn see_files(what: &str, files: &str) -> Markup {
    html! { p.note { "… " (what) ": see " code { (files) } " in its folder." } }
}

fn csv<'a>(parts: &Parts, rows: impl Iterator<Item = &'a JobRow>, data: &DataFile) -> String {
    // The CSV consists of strings, so it is valid UTF-8; writing to memory cannot fail.
    export::selection(rows, &parts.layouts.all.further, &data.columns)
        .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
        .unwrap_or_default()
}

/// The pages of the inspected jobs of a group by line and column of their cells.
fn cell_pages<'a>(parts: &'a Parts, group: &Group) -> HashMap<(usize, usize), &'a str> {
    let found = group
        .jobs
        .iter()
        .filter_map(|job| Some(((job.axis_index, job.series), parts.pages.get(&job.row.job)?.as_str())));
    found.collect()
}

fn table(parts: &Parts, quantity: Quantity) -> Markup {
    let layout = parts.layouts.all;
    let constants = layout.constants_in_words();
    let header = tables::header(layout);
    let shown = shown(layout);
    let word_cells = quantity == Quantity::Regime;
    let table = |group: &Group| {
        let pages = cell_pages(parts, group);
        let cells = tables::lines(layout, group, quantity, Digits::ByError).enumerate();
        let lines: Vec<Vec<Markup>> = cells
            .map(|(line, (at, cells))| {
                let mut markup = vec![html! { (layout.axis_text(at)) }];
                for (column, text) in cells.iter().enumerate() {
                    // Names of regimes may break at a hyphen.
                    let text = if word_cells { text.replace('_', "-") } else { text.clone() };
                    let page = pages.get(&(line, column));
                    markup.push(html! {
                        @if let Some(page) = page { a href=(page) title="what happens in this job" { (text) } }
                        @else { (text) }
                    });
                }
                markup
            })
            .collect();
        html::table(&header, &lines)
    };
    let content = html! {
        @if !constants.is_empty() { p { "In all jobs: " (constants) "." } }
        @for group in layout.groups.iter().take(shown) {
            @if !group.key.is_empty() { h3 { (group.caption()) } }
            (table(group))
        }
        @if shown < layout.groups.len() {
            (see_files(&what_is_left_out(layout, shown), "the tables"))
        }
        ul.note {
            @for (mark, meaning) in tables::legend(layout, quantity) {
                li { @if !mark.is_empty() { code { (mark) } " " } (meaning) }
            }
        }
    };
    let heading = format!("Table: {}", quantity.title());
    if quantity == Quantity::MuStar {
        html! { h3 { (heading) } (content) }
    } else {
        html::details(&heading, &content)
    }
}

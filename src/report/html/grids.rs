//! Sections with figures, the data behind them, and tables.

use super::parts::Parts;
use crate::publish::{html, value};
use crate::report::export;
use crate::report::figure::{DataFile, Plot, RESIDUALS, RUN_TIMES};
use crate::report::layout::{Group, MAX_TOOLTIPS, parameters_in_words};
use crate::report::row::JobRow;
use crate::report::tables::{self, Quantity};
use crate::report::times::Times;
use crate::report::tooltip::short_key;
use maud::{Markup, html};

/// Largest number of combinations of further parameters that are shown.
const MAX_GROUPS: usize = 6;
/// Largest number of jobs in all of these together …
const MAX_JOBS: usize = 4_000;
/// … unless only the first combination is shown, which may have more. Beyond this number it is not drawn either.
const MAX_DRAWN: usize = 20_000;

pub(super) fn friction(parts: &Parts) -> Markup {
    let axis = parts.layout.axis_label();
    let caption = format!(
        "Macroscopic friction coefficient μ* against {axis}, one curve per local coefficient μ (dashed: μ* = μ). Error \
         bars where they are larger than a marker."
    );
    html! {
        (figures(parts, Plot::MuStar, &caption))
        (table(parts, Quantity::MuStar))
    }
}

pub(super) fn frequency(parts: &Parts) -> Markup {
    let axis = parts.layout.axis_label();
    let curves = format!("Fundamental frequency of the total normal contact force against {axis}.");
    let map = format!(
        "The same frequencies over {axis} and μ. A letter: the job has no frequency. ~: not periodic."
    );
    html! {
        (figures(parts, Plot::Frequency, &curves))
        (figures(parts, Plot::FrequencyMap, &map))
        (table(parts, Quantity::Frequency))
    }
}

pub(super) fn regimes(parts: &Parts) -> Markup {
    let caption = format!(
        "Contact regime of every job over {} and μ. A small letter on a pale colour: the run did not become periodic.",
        parts.layout.axis_label()
    );
    html! {
        (figures(parts, Plot::RegimeMap, &caption))
        (table(parts, Quantity::Regime))
    }
}

pub(super) fn shares(parts: &Parts) -> Markup {
    let caption = format!(
        "Shares of stick, slip and separation in the time of all contact nodes, against {}. White lines mark the jobs.",
        parts.layout.axis_label()
    );
    figures(parts, Plot::Shares, &caption)
}

pub(super) fn residuals(parts: &Parts) -> Markup {
    let rows = parts.report.rows;
    let has_tooltips = rows.len() <= MAX_TOOLTIPS;
    let caption = "Residuals of every job: of the energy balance over the whole run, relative to the energy put in, and \
                   the larger one of two identities over the averaging window.";
    let data = has_tooltips.then(|| csv(parts, rows.iter(), RESIDUALS));
    let file = format!("{}.csv", RESIDUALS.stem);
    html! {
        @if rows.len() <= MAX_DRAWN {
            (html::figure(parts.residuals, caption, data.as_deref().map(|csv| (file.as_str(), csv))))
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
        ("thread time, all jobs", value::duration(times.total_s), format!("{} jobs", times.jobs)),
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
    let data = (rows.len() <= MAX_TOOLTIPS).then(|| csv(parts, rows.iter(), RUN_TIMES));
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

/// Number of groups that are shown.
fn shown(parts: &Parts) -> usize {
    let mut jobs = 0;
    let fits = |(index, group): (usize, &Group)| {
        jobs += group.jobs.len();
        if index == 0 { jobs <= MAX_DRAWN } else { index < MAX_GROUPS && jobs <= MAX_JOBS }
    };
    parts.layout.groups.iter().enumerate().map(fits).take_while(|fits| *fits).count()
}

/// The figures of one kind, with the data behind them.
fn figures(parts: &Parts, plot: Plot, caption: &str) -> Markup {
    let groups = &parts.layout.groups;
    let (shown, data) = (shown(parts), plot.data());
    let figures = parts.figures.iter().filter(|(own, _)| *own == plot).flat_map(|(_, figures)| figures);
    html! {
        @for (group, figure) in groups.iter().zip(figures).take(shown) {
            @if !figure.caption.is_empty() { h3 { (figure.caption) } }
            @let csv = group.has_tooltips().then(|| csv(parts, group.jobs.iter().map(|job| job.row), data));
            @let file = format!("{}{}.csv", data.stem, figure.suffix);
            (html::figure(&figure.svg, caption, csv.as_deref().map(|csv| (file.as_str(), csv))))
            @if csv.is_none() {
                p.note { "There are too many jobs for tooltips; the data are in " code { (data.stem) ".csv" } "." }
            }
        }
        @if shown < groups.len() {
            @let files = format!("{}*.svg", plot.stem());
            (see_files(&what_is_left_out(parts, shown), &files))
        }
    }
}

fn what_is_left_out(parts: &Parts, shown: usize) -> String {
    let groups = &parts.layout.groups;
    let jobs: usize = groups[shown..].iter().map(|group| group.jobs.len()).sum();
    if groups.len() == 1 {
        return format!("{jobs} jobs are too many for this page");
    }
    let more = if shown > 0 { "more " } else { "" };
    format!(
        "{} {more}combinations of parameters, {jobs} jobs, are left out of this page",
        groups.len() - shown
    )
}

fn see_files(what: &str, files: &str) -> Markup {
    html! { p.note { "… " (what) ": see " code { (files) } " in its folder." } }
}

fn csv<'a>(parts: &Parts, rows: impl Iterator<Item = &'a JobRow>, data: DataFile) -> String {
    // The CSV consists of strings, so it is valid UTF-8; writing to memory cannot fail.
    export::selection(rows, &parts.layout.further, data.columns)
        .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
        .unwrap_or_default()
}

fn table(parts: &Parts, quantity: Quantity) -> Markup {
    let layout = parts.layout;
    let constants = layout.constants_in_words();
    let header = tables::header(layout);
    let shown = shown(parts);
    let word_cells = quantity == Quantity::Regime;
    let cell = |text: &str| {
        // Names of regimes may break at a hyphen.
        if word_cells {
            html! { (text.replace('_', "-")) }
        } else {
            html! { (text) }
        }
    };
    let table = |group: &Group| {
        let lines: Vec<Vec<Markup>> = tables::lines(layout, group, quantity)
            .map(|(at, cells)| {
                std::iter::once(html! { (at) }).chain(cells.iter().map(|text| cell(text))).collect()
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
            (see_files(&what_is_left_out(parts, shown), "the tables"))
        }
        ul.note {
            @for (mark, meaning) in quantity.legend() {
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

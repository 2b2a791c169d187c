//! The beginning and the end of the page: counts of jobs, what is missing, and the main results.

use crate::analysis::JobRecord;
use crate::publish::{html, value};
use crate::report::input::Report;
use crate::report::layout::parameters_in_words;
use crate::report::row::JobRow;
use crate::report::scalar::FREQUENCY;
use crate::report::summary::{self, Summary};
use crate::report::tooltip::residual_text;
use crate::report::{Discretisation, digits};
use maud::{Markup, html};

/// Warnings about missing and failed jobs, and the main numbers below them.
pub(super) fn summary(report: &Report) -> Markup {
    let rows = report.rows;
    let summary = Summary::of(rows);
    let mut tiles = vec![
        ("jobs done", format!("{} of {}", summary.done(), summary.total), summary.done_in_words()),
        ("failed", summary.failed.to_string(), String::new()),
        (
            "missing",
            summary.missing().to_string(),
            if summary.missing() > 0 { summary.missing_in_words() } else { String::new() },
        ),
    ];
    tiles.extend(drop_of_friction(rows));
    tiles.extend(error_of_friction(rows));
    tiles.extend(frequencies(rows));
    tiles.extend(residuals(rows));
    html! {
        @if summary.missing() > 0 {
            (html::warning(&html! {
                @let verb = if summary.missing() == 1 { "is" } else { "are" };
                strong {
                    "This report is incomplete: " (summary.missing()) " of " (value::count(summary.total, "job")) " " (verb)
                    " missing"
                }
                " (" (summary.missing_in_words()) "). Figures and tables hold only the jobs that are done."
            }))
        }
        @if summary.failed > 0 {
            (html::warning(&html! {
                strong {
                    @if summary.failed == 1 { "1 job has failed" } @else { (summary.failed) " jobs have failed" }
                }
                ": see " a href="#trouble" { "where and why" } "."
            }))
        }
        (html::tiles(&tiles))
    }
}

type Tile = (&'static str, String, String);

/// The job whose macroscopic coefficient is the smallest in relation to the local one.
fn drop_of_friction(rows: &[JobRow]) -> Option<Tile> {
    let ratio = |row: &JobRow| Some(row.record()?.mu_star / row.mu).filter(|ratio| ratio.is_finite());
    let ratios = rows.iter().filter_map(|row| Some((ratio(row)?, row)));
    let (_, row) = ratios.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(("lowest μ*/μ", digits::ratio(row, row.record()?), parameters_in_words(row)))
}

/// The largest error of μ\* that mesh and step make, or that it is not measured.
fn error_of_friction(rows: &[JobRow]) -> Option<Tile> {
    let done = || rows.iter().filter(|row| row.record().is_some());
    let errors: Vec<Option<f64>> =
        done().map(|row| Some(row.discretisation.error()?.mu_star_relative)).collect();
    if errors.is_empty() {
        return None;
    }
    let Some(largest) = errors.iter().flatten().copied().max_by(f64::total_cmp) else {
        return Some(("error of mesh and step", "not measured".to_owned(), String::new()));
    };
    let is_indicative = |row: &JobRow| matches!(row.discretisation, Discretisation::Indicative(_));
    let note = if errors.contains(&None) {
        "of μ*; in some jobs not measured"
    } else if done().all(is_indicative) {
        "of μ*, indicative: of another scene, friction or speed"
    } else if done().any(is_indicative) {
        "of μ*; indicative in some jobs"
    } else {
        "of μ*, measured on this scene"
    };
    Some((
        "error of mesh and step",
        format!("≤ {} %", value::significant(100.0 * largest, 2)),
        note.to_owned(),
    ))
}

fn frequencies(rows: &[JobRow]) -> Option<Tile> {
    // The mean rate of a run that is not periodic is no frequency of a limit cycle.
    let settled = rows.iter().filter(|row| !row.is_measured() && FREQUENCY.is_settled(row));
    let found = settled.filter_map(|row| FREQUENCY.value(row));
    let (low, high) =
        found.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), f| (low.min(f), high.max(f)));
    let [low_khz, high_khz] = [low, high].map(|f| value::fixed(f / 1e3, 1));
    let range =
        if low_khz == high_khz { format!("{low_khz} kHz") } else { format!("{low_khz}–{high_khz} kHz") };
    (low <= high).then_some(("frequencies", range, String::new()))
}

fn residuals(rows: &[JobRow]) -> Option<Tile> {
    let (energy, one) = summary::worst(rows, |record| record.energy_residual.abs())?;
    let (identity, other) = summary::worst(rows, JobRecord::identity_residual)?;
    let note = if one.job == other.job {
        format!("energy, identities; both at {}", parameters_in_words(one))
    } else {
        format!("energy at {}; identities at {}", parameters_in_words(one), parameters_in_words(other))
    };
    Some(("largest residuals", format!("{}, {}", residual_text(energy), residual_text(identity)), note))
}

/// When the page was written, and which other files there are.
pub(super) fn foot(report: &Report) -> Markup {
    html! {
        footer {
            p.note {
                "Written " (value::utc_minute(report.written_ms)) " by tribosweep. "
                @if let Some(seconds) = report.refresh_s {
                    "The study is not finished: this page reloads every " (seconds) " s. "
                }
                "The folder of this page has the figures as SVG, the tables and the data behind the figures as CSV, "
                "and " code { "jobs.csv" } " with all results, one line per job."
            }
        }
    }
}

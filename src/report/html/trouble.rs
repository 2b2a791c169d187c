//! Jobs that failed, that did not become periodic, or that are missing: where they are in the grid, and why.

use crate::analysis::Outcome;
use crate::publish::{html, value};
use crate::report::digits;
use crate::report::layout::parameters_in_words;
use crate::report::row::{JobRow, RowState};
use crate::report::tooltip::short_key;
use crate::report::trouble;
use maud::{Markup, html};

/// Largest number of jobs in a list.
const MAX_LISTED: usize = 100;

/// None if there is no such job.
pub(super) fn section(rows: &[JobRow]) -> Option<Markup> {
    let regions = trouble::sentences(&trouble::regions(rows));
    let failed = list("Failed jobs", rows, failed);
    let not_periodic = list("Not periodic", rows, not_periodic);
    let missing = list("Missing jobs", rows, missing);
    let parts: Vec<Markup> = [failed, not_periodic, missing].into_iter().flatten().collect();
    if parts.is_empty() {
        return None;
    }
    Some(html! {
        @if !regions.is_empty() {
            p { "Neighbouring jobs of the grid with the same cause form a region:" }
            ul { @for sentence in &regions { li { (sentence) } } }
        }
        @for part in &parts { (part) }
    })
}

/// A table of the rows for which `why` returns a reason. Rows beyond [`MAX_LISTED`] are counted only.
fn list(heading: &str, rows: &[JobRow], why: fn(&JobRow) -> Option<Markup>) -> Option<Markup> {
    let mut entries = rows.iter().filter_map(|row| Some((row, why(row)?)));
    let line = |(row, why): (&JobRow, Markup)| {
        vec![html! { (parameters_in_words(row)) }, why, html! { code { (short_key(row)) } }]
    };
    let lines: Vec<Vec<Markup>> = entries.by_ref().take(MAX_LISTED).map(line).collect();
    if lines.is_empty() {
        return None;
    }
    let more = entries.count();
    let header = ["parameters", "why", "job"].map(str::to_owned);
    Some(html! {
        h3 { (heading) " (" (lines.len() + more) ")" }
        (html::table(&header, &lines))
        @if more > 0 { p.note { "… and " (more) " more: see " code { "jobs.csv" } "." } }
    })
}

fn failed(row: &JobRow) -> Option<Markup> {
    match &row.state {
        RowState::Failed { error } => Some(html! { span.words { (error) } }),
        _ => None,
    }
}

fn not_periodic(row: &JobRow) -> Option<Markup> {
    let record = row.record().filter(|record| record.outcome == Outcome::NotPeriodic)?;
    let why = trouble::cause(row)?.why;
    Some(html! {
        span.words {
            (why) "; after " (value::quantity(record.simulated_s, "s")) " μ* = " (digits::mu_star_with_error(row, record))
            " over " (record.cycles) " cycles"
        }
    })
}

fn missing(row: &JobRow) -> Option<Markup> {
    match &row.state {
        RowState::Pending | RowState::Running | RowState::Cancelled => Some(html! { (row.status()) }),
        RowState::Unreadable { reason } => Some(html! { span.words { (row.status()) ": " (reason) } }),
        _ => None,
    }
}

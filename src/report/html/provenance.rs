//! Where the results come from: program, machine, dates, and the study as it was submitted.

use crate::publish::{html, value};
use crate::report::provenance::{Provenance, ResultGroup};
use maud::{Markup, html};

/// Number of characters of a commit that are shown.
const COMMIT_LENGTH: usize = 12;

pub(super) fn section(provenance: &Provenance) -> Markup {
    let warnings = provenance.warnings();
    let header =
        ["results", "program", "machine", "processor", "vectors", "threads", "finished"].map(str::to_owned);
    let lines: Vec<Vec<Markup>> = provenance.groups.iter().map(line).collect();
    html! {
        @for warning in &warnings { (html::warning(&html! { (warning) })) }
        p { "Submitted " (value::utc_minute(provenance.submitted_ms)) "." }
        @if lines.is_empty() { p { "There are no results yet." } } @else { (html::wrapping_table(&header, &lines)) }
        (html::details("The study as it was submitted", &html! { pre { code { (provenance.document) } } }))
    }
}

fn line(group: &ResultGroup) -> Vec<Markup> {
    let mut line = vec![html! { (group.jobs) }];
    if let Some(build) = &group.build {
        let (commit, modified) = build.commit.split_at(build.commit.find('+').unwrap_or(build.commit.len()));
        let short: String = commit.chars().take(COMMIT_LENGTH).collect();
        line.extend([
            html! { (build.version) br; code title=(build.commit) { (short) (modified) } },
            html! { (build.host) },
            html! { (build.cpu.as_deref().unwrap_or(value::MISSING)) " (" (build.platform) ")" },
            html! { (build.vectors) },
            html! { (build.threads) },
        ]);
    } else {
        line.push(html! { "unknown" });
        line.extend((0..4).map(|_| html! { (value::MISSING) }));
    }
    line.push(html! { (value::utc_minute(group.first_ms)) br; "to " (value::utc_minute(group.last_ms)) });
    line
}

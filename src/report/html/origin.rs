//! Where the results come from: program, machine, dates, and the study as it was submitted.

use crate::publish::{html, value};
use crate::report::origin::{Made, Origin};
use maud::{Markup, html};

/// So many characters of a commit tell it apart.
const COMMIT_LENGTH: usize = 12;

pub(super) fn section(origin: &Origin) -> Markup {
    let doubts = origin.doubts();
    let header =
        ["results", "program", "machine", "processor", "vectors", "threads", "finished"].map(str::to_owned);
    let lines: Vec<Vec<Markup>> = origin.made.iter().map(line).collect();
    html! {
        @for doubt in &doubts { (html::warning(&html! { (doubt) })) }
        p { "Submitted " (value::moment(origin.submitted_ms)) "." }
        @if lines.is_empty() { p { "There are no results yet." } } @else { (html::table(&header, &lines)) }
        (html::details("The study as it was submitted", &html! { pre { code { (origin.document) } } }))
    }
}

fn line(made: &Made) -> Vec<Markup> {
    let mut line = vec![html! { (made.jobs) }];
    if let Some(maker) = &made.with {
        let (commit, modified) = maker.commit.split_at(maker.commit.find('+').unwrap_or(maker.commit.len()));
        let short: String = commit.chars().take(COMMIT_LENGTH).collect();
        line.extend([
            html! { (maker.version) br; code title=(maker.commit) { (short) (modified) } },
            html! { (maker.host) },
            html! { (maker.cpu.as_deref().unwrap_or(value::MISSING)) " (" (maker.platform) ")" },
            html! { (maker.vectors) },
            html! { (maker.threads) },
        ]);
    } else {
        line.push(html! { "unknown" });
        line.extend((0..4).map(|_| html! { (value::MISSING) }));
    }
    line.push(html! { (value::moment(made.first_ms)) br; "to " (value::moment(made.last_ms)) });
    line
}

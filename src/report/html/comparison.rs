//! The section on the differences between several sources.

use crate::publish::html;
use crate::report::comparison::{Comparison, MAX_LISTED};
use maud::{Markup, html};

pub(super) fn section(comparison: &Comparison) -> Markup {
    let (summary_head, summary) = comparison.summary();
    let (head, lines) = comparison.table();
    let more = comparison.differences.len().saturating_sub(MAX_LISTED);
    let cells = |lines: &[Vec<String>]| -> Vec<Vec<Markup>> {
        lines.iter().map(|line| line.iter().map(|text| html! { (text) }).collect()).collect()
    };
    let contradictions = comparison.contradictions_in_words();
    html! {
        @if let [head, lines @ ..] = &contradictions[..] {
            (html::warning(&html! { strong { (head) } ul { @for line in lines { li { (line) } } } }))
        }
        @if !comparison.notes.is_empty() {
            ul { @for note in &comparison.notes { li { (note) } } }
        }
        @if summary.is_empty() {
            p { "No point of another source can be compared with " (comparison.reference) "." }
        } @else {
            (html::table(&summary_head, &cells(&summary)))
            (html::details("Table: all differences", &html! {
                (html::table(&head, &cells(&lines)))
                @if more > 0 { p.note { "… and " (more) " more: see " code { "differences.csv" } "." } }
            }))
            p.note { (comparison.explanation()) }
        }
    }
}

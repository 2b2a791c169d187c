//! What is doubtful about the study's inputs.

use crate::publish::html;
use maud::{Markup, html};

/// The doubts in a box at the beginning of the page; nothing if there are none.
///
/// Remarks about the cost stand below it and do not stand out: the results are right.
pub(super) fn list(warnings: &[String], remarks: &[String]) -> Markup {
    html! {
        @if !warnings.is_empty() {
            (html::warning(&html! {
                strong { "Check these inputs before you use the results:" }
                ul { @for warning in warnings { li { (warning) } } }
            }))
        }
        @for remark in remarks { p.note { "Cost, without an effect on results: " (remark) } }
    }
}

//! What was simulated, and how accurate the results are.

use crate::publish::{Sheet, html};
use crate::report::accuracy;
use crate::report::row::JobRow;
use maud::{Markup, html};

/// The drawings of the scene and the table of inputs.
pub(super) fn section(sheet: &Sheet) -> Markup {
    html! {
        (html::sheet(sheet))
        p.note {
            "\"From\" says who gave the value: the study, its grid, its preset, or nobody (default). The names in files are "
            "those of grids, of " code { "--set" } " and of the export."
        }
    }
}

/// The errors of the results in sentences.
pub(super) fn errors(rows: &[JobRow]) -> Markup {
    let sentences = accuracy::in_words(rows);
    html! {
        @if !sentences.is_empty() {
            div.accuracy {
                p { strong { "Accuracy" } }
                ul { @for sentence in &sentences { li { (sentence) } } }
            }
        }
    }
}

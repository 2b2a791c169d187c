//! The report as one page for a browser.
//!
//! It is whole: all drawings, tables and the data behind them are in it. A study that is too large for that is shown as
//! far as it goes, and the page says what is left out, which is in the files beside it.

mod grids;
mod head;
mod parts;
mod provenance;
mod trouble;

pub(super) use parts::Parts;

use crate::publish::html;
use maud::{Markup, html};

/// The page.
pub(super) fn page(parts: &Parts) -> String {
    let report = parts.report;
    let mut sections: Vec<(&str, &str, Markup)> = vec![
        ("friction", "Macroscopic friction", grids::friction(parts)),
        ("frequency", "Frequency", grids::frequency(parts)),
        ("regimes", "Contact regimes", grids::regimes(parts)),
        ("shares", "Stick, slip and separation", grids::shares(parts)),
        ("residuals", "Residuals", grids::residuals(parts)),
    ];
    sections.extend(trouble::section(report.rows).map(|content| ("trouble", "Trouble", content)));
    sections.push(("times", "Run times", grids::times(parts)));
    sections.extend(report.provenance.map(|own| ("provenance", "Provenance", provenance::section(own))));
    let body = html! {
        (head::summary(report))
        (html::navigation(sections.iter().map(|(id, heading, _)| (*id, *heading))))
        @for (id, heading, content) in &sections { (html::section(id, heading, content)) }
        (head::foot(report))
    };
    html::page(report.title, report.refresh_s, &body)
}

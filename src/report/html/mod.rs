//! The report as one page for a browser.
//!
//! The page contains all drawings, tables and the data behind them. If a study is too large for that, the page shows a
//! part of it, says what is left out, and names the files that have it.

mod comparison;
mod grids;
mod head;
mod parts;
mod provenance;
mod scene;
mod trouble;
mod warnings;

pub(super) use parts::{Layouts, Parts};

use crate::publish::{html, value};
use crate::report::input::Report;
use crate::report::stability::{self, Analysis, Files};
use maud::{Markup, html};

const STABILITY: &str = "Linear stability";

/// The page of the stability alone. If it has shapes of modes, they are in a folder beside the page.
pub(super) fn stability_page(
    report: &Report,
    analysis: &Analysis,
    files: &Files,
    has_shapes: bool,
) -> String {
    let mut sections = vec![("stability", STABILITY, stability::markup(analysis, files))];
    sections.extend(report.sheet.map(|sheet| ("scene", "What was analysed", scene::section(sheet))));
    sections.extend(report.provenance.map(|from| ("provenance", "Provenance", provenance::section(from))));
    let body = html! {
        @if let Some(description) = report.description { p.description { (description) } }
        (warnings::list(report.warnings, report.remarks))
        @if sections.len() > 1 { (html::navigation(sections.iter().map(|(id, heading, _)| (*id, *heading)))) }
        @for (id, heading, content) in &sections { (html::section(id, heading, content)) }
        footer {
            p.note {
                "Written " (value::utc_minute(report.written_ms)) " by tribosweep. The folder of this page has the figures as "
                "SVG, all modes in " code { "modes.csv" } " and the thresholds in " code { "thresholds.csv" } "."
                @if has_shapes {
                    " The shapes of modes, for ParaView, are in the folder " a href="modes/" { code { "modes" } } "."
                }
            }
        }
    };
    html::page(report.title, report.refresh_s, &body)
}

/// The page.
pub(super) fn page(parts: &Parts) -> String {
    let report = parts.report;
    let mut sections: Vec<(&str, &str, Markup)> = Vec::new();
    sections.extend(parts.comparison.map(|found| ("comparison", "Comparison", comparison::section(found))));
    sections.extend(report.sheet.map(|sheet| ("scene", "What was simulated", scene::section(sheet))));
    sections.extend(parts.programs.map(|own| ("program", "Speed and load in time", own.markup())));
    sections.extend(report.findings.map(|own| ("findings", "What was found", own.markup())));
    sections.extend([
        ("friction", "Macroscopic friction", grids::friction(parts)),
        ("frequency", "Frequency", grids::frequency(parts)),
        ("regimes", "Contact regimes", grids::regimes(parts)),
        ("bifurcation", "Amplitudes", grids::bifurcation(parts)),
        ("shares", "Stick, slip and separation", grids::shares(parts)),
    ]);
    sections.extend(
        parts.stability.map(|(analysis, files)| ("stability", STABILITY, stability::markup(analysis, files))),
    );
    let quantities =
        report.view.y.iter().map(|scalar| (scalar.name, scalar.meaning, grids::quantity(parts, scalar)));
    sections.extend(quantities);
    sections.push(("residuals", "Residuals", grids::residuals(parts)));
    sections.extend(trouble::section(report.rows).map(|content| ("trouble", "Trouble", content)));
    sections.push(("times", "Run times", grids::times(parts)));
    sections.extend(report.provenance.map(|from| ("provenance", "Provenance", provenance::section(from))));
    let body = html! {
        @if let Some(description) = report.description { p.description { (description) } }
        (head::summary(report))
        (warnings::list(report.warnings, report.remarks))
        (scene::errors(report.rows))
        (html::navigation(sections.iter().map(|(id, heading, _)| (*id, *heading))))
        @for (id, heading, content) in &sections { (html::section(id, heading, content)) }
        (head::foot(report))
    };
    html::page(report.title, report.refresh_s, &body)
}

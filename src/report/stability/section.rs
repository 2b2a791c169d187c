//! The section on linear stability of a page, in HTML and in Markdown.

use super::analysis::{Analysis, GroupModes};
use super::ranges::Speed;
use super::write::Files;
use crate::publish::{html, value};
use crate::report::figure::stability::StabilityPlot;
use crate::report::markdown;
use maud::{Markup, html};
use std::fmt::Write;

/// Largest number of figures of a kind, and of tables.
const MAX_SHEETS: usize = 2;
const MAX_GROUPS: usize = 6;
/// Longer files of data are not in the page [bytes].
const MAX_DATA: usize = 1_000_000;

/// What the section is about.
const MEANING: [&str; 3] = [
    "The figures show the linear stability of steady sliding. Small vibrations about steady sliding are complex modes. Each mode \
     has a frequency and a growth rate: the imaginary part of its eigenvalue over 2π, and the real part.",
    "If a growth rate is positive, the vibration grows, and steady sliding is unstable. A threshold is a value of the parameter \
     that is varied, usually μ, at which this begins or ends. With friction that falls with the speed, sliding can be unstable \
     below a threshold and stable above it.",
    "The eigenvalues say nothing about the size that the vibration reaches. A limit cycle can also exist below the threshold, \
     because stable sliding and a stick–slip cycle exist side by side; the start of a run decides which of them it reaches.",
];

/// What else must be said: along which parameter, and what nobody looked at.
fn sentences(analysis: &Analysis) -> Vec<String> {
    [analysis.along_in_words(), analysis.above_band(), not_converged(analysis)]
        .into_iter()
        .flatten()
        .collect()
}

fn caption(plot: StabilityPlot) -> &'static str {
    match plot {
        StabilityPlot::Map => {
            "Growth rate of the leading mode, which grows fastest or decays slowest. Blue decays, red grows. The \
             line is the threshold, interpolated between the points."
        }
        StabilityPlot::LockIn => {
            "Frequencies of the modes over the parameter that is varied and, below them, their growth rates. Where two frequencies meet and the growth \
             rates part, two modes lock in. At most six speeds are shown."
        }
        StabilityPlot::Thresholds => {
            "Thresholds: where the growth rate of a mode becomes positive (filled) or negative again (hollow). Steady sliding is \
             unstable where at least one mode grows; the table has these ranges."
        }
    }
}

/// The section of a page.
pub(in crate::report) fn markup(analysis: &Analysis, files: &Files) -> Markup {
    let shown = analysis.groups.len().min(MAX_GROUPS);
    let left_out = analysis.groups.len() - shown;
    let has_sheets_left = files.figures.iter().any(|(_, figures)| figures.len() > MAX_SHEETS);
    html! {
        @for paragraph in MEANING { p { (paragraph) } }
        @for sentence in sentences(analysis) { p { (sentence) } }
        @for (plot, figures) in &files.figures {
            @for (number, figure) in figures.iter().take(MAX_SHEETS).enumerate() {
                @if !figure.caption.is_empty() { h3 { (figure.caption) } }
                (html::figure(&figure.svg, caption(*plot), data_of(*plot, files).filter(|_| number == 0)))
            }
        }
        @if has_sheets_left { p.note { "… more combinations of parameters: see the figures in the folder of this page." } }
        @if analysis.points().is_empty() { p { "There are no points." } } @else { h3 { "Thresholds" } }
        @for (group, modes) in analysis.layout.groups.iter().zip(&analysis.groups).take(shown) {
            @if !group.key.is_empty() { p { (group.caption()) } }
            (table(analysis, modes))
        }
        @if left_out > 0 {
            p.note { "… left out: " (value::count(left_out, "combination")) " of parameters; see " code { "thresholds.csv" } "." }
        }
    }
}

/// The data below a figure.
fn data_of(plot: StabilityPlot, files: &Files) -> Option<(&str, &str)> {
    let name = match plot {
        StabilityPlot::Map => return None,
        StabilityPlot::LockIn => "modes.csv",
        StabilityPlot::Thresholds => "thresholds.csv",
    };
    let (file, text) = files.data.iter().find(|(file, _)| *file == name)?;
    (text.len() <= MAX_DATA).then_some((file, text))
}

/// How many modes are not converged, in a sentence; none if all are.
fn not_converged(analysis: &Analysis) -> Option<String> {
    let modes = || analysis.points().iter().flat_map(|point| &point.stability.modes);
    let count = modes().filter(|mode| !mode.is_converged).count();
    let all = value::count(modes().count(), "mode");
    let verb = if count == 1 { "is" } else { "are" };
    (count > 0).then(|| format!("Of {all}, {count} {verb} not converged. They are drawn grey or hollow."))
}

fn header(analysis: &Analysis) -> Vec<String> {
    let across = analysis.layout.dimension(analysis.along.across()).label.clone();
    let threshold = if analysis.along.is_mu() { "μ_c".to_owned() } else { analysis.along.threshold() };
    let own = ["unstable", "frequency", "note"].map(str::to_owned);
    [across, threshold].into_iter().chain(own).collect()
}

/// The lines of the table of a group: ω, the first threshold, where sliding is unstable, the frequency, and what else there is to say.
fn lines(analysis: &Analysis, modes: &GroupModes) -> Vec<Vec<String>> {
    let line = |speed: &Speed| {
        let omega = analysis.across_in_words(speed);
        [omega].into_iter().chain(analysis.words(speed)).collect()
    };
    modes.speeds.iter().map(line).collect()
}

fn table(analysis: &Analysis, modes: &GroupModes) -> Markup {
    let cells = |line: Vec<String>| line.into_iter().map(|text| html! { (text) }).collect();
    html::table(
        &header(analysis),
        &lines(analysis, modes).into_iter().map(cells).collect::<Vec<Vec<Markup>>>(),
    )
}

/// The section of a Markdown page.
pub(in crate::report) fn markdown(analysis: &Analysis, files: &Files) -> String {
    let mut text = "\n## Linear stability\n\n".to_owned();
    for paragraph in MEANING {
        let _ = write!(text, "{}\n\n", markdown::escape(paragraph));
    }
    for sentence in sentences(analysis) {
        let _ = write!(text, "{}\n\n", markdown::escape(&sentence));
    }
    for (plot, figures) in &files.figures {
        for figure in figures {
            if !figure.caption.is_empty() {
                let _ = write!(text, "{}:\n\n", markdown::escape(&figure.caption));
            }
            let _ = write!(text, "![{}]({}{}.svg)\n\n", plot.title(), plot.stem(), figure.suffix);
        }
    }
    for (group, modes) in analysis.layout.groups.iter().zip(&analysis.groups) {
        if !group.key.is_empty() {
            let _ = write!(text, "### {}\n\n", markdown::escape(&group.caption()));
        }
        let _ = writeln!(text, "{}", markdown::table(&header(analysis), &lines(analysis, modes), false));
    }
    text
}

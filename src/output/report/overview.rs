//! A study at a glance, for a terminal: a letter for every job, a row for each friction coefficient, a column for each
//! speed.

use super::glyph::{SEVERAL_JOBS, StatusGlyph, status_glyph};
use super::layout::{Group, Layout, MAX_GROUPS};
use super::row::JobRow;
use super::view::View;
use anstyle::Style;
use std::fmt::Write;

/// The grid in lines of at most `width` characters, as far as its labels leave room. The text has colours in ANSI codes,
/// which the caller can strip. It is empty if there are no jobs.
pub fn overview(rows: &[JobRow], width: usize) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let layout = Layout::of(rows.iter().filter(|row| !row.is_at_boundary()), &View::DEFAULT);
    let mut text = String::new();
    let mut used: Vec<StatusGlyph> = Vec::new();
    for group in layout.groups.iter().take(MAX_GROUPS) {
        if !group.key.is_empty() {
            let _ = writeln!(text, "{}:", group.caption());
        }
        grid(&layout, group, width, &mut used, &mut text);
    }
    if layout.groups.len() > MAX_GROUPS {
        let _ = writeln!(text, "… and {} more combinations of parameters", layout.groups.len() - MAX_GROUPS);
    }
    let legend: Vec<String> =
        used.iter().map(|glyph| format!("{} {}", painted(*glyph), glyph.meaning)).collect();
    let mut line = 0;
    for (entry, glyph) in legend.iter().zip(&used) {
        let length = glyph.meaning.chars().count() + 4;
        if line > 0 && line + length > width {
            text.push('\n');
            line = 0;
        }
        let _ = write!(text, "{}{entry}", if line > 0 { "  " } else { "" });
        line += length;
    }
    text.push('\n');
    text
}

fn grid(
    layout: &Layout<'_>,
    group: &Group<'_>,
    width: usize,
    used: &mut Vec<StatusGlyph>,
    text: &mut String,
) {
    let columns: Vec<String> = group.axis_values.iter().map(|value| layout.axis_text(value)).collect();
    let corner = format!("{} \\ {}", layout.dimension(layout.by).label, layout.axis_label());
    let labels: Vec<String> = layout.series.iter().map(|series| layout.series_value(series)).collect();
    let label_width = labels.iter().chain([&corner]).map(|label| label.chars().count()).max().unwrap_or(0);
    let cell_width = columns.iter().map(|label| label.chars().count()).max().unwrap_or(0) + 1;
    let mut glyphs: Vec<Vec<Option<StatusGlyph>>> = vec![vec![None; columns.len()]; labels.len()];
    for job in &group.jobs {
        let cell = &mut glyphs[job.series][job.axis_index];
        *cell = Some(if cell.is_some() { SEVERAL_JOBS } else { status_glyph(job.row) });
    }
    for glyph in glyphs.iter().flatten().flatten() {
        if !used.contains(glyph) {
            used.push(*glyph);
        }
    }
    let across = (width.saturating_sub(label_width) / cell_width).max(1);
    for first in (0..columns.len()).step_by(across) {
        let part = first..(first + across).min(columns.len());
        let _ = write!(text, "{corner:label_width$}");
        for label in &columns[part.clone()] {
            let _ = write!(text, "{label:>cell_width$}");
        }
        text.push('\n');
        // The highest friction is on top, as in the maps.
        for (label, line) in labels.iter().zip(&glyphs).rev() {
            let _ = write!(text, "{label:>label_width$}");
            for cell in &line[part.clone()] {
                let _ = write!(text, "{:1$}", "", cell_width - 1);
                match cell {
                    Some(glyph) => text.push_str(&painted(*glyph)),
                    None => text.push(' '),
                }
            }
            text.push('\n');
        }
    }
}

fn painted(glyph: StatusGlyph) -> String {
    let style = Style::new().fg_color(Some(glyph.terminal_colour.into()));
    format!("{style}{}{style:#}", glyph.letter)
}

//! A study at a glance, for a terminal: a letter for every job, friction coefficients down, speeds across.

use super::layout::{Group, Layout};
use super::row::Row;
use super::sign::{SEVERAL, Sign, sign};
use crate::publish::value;
use anstyle::Style;
use std::fmt::Write;

/// No more combinations of further parameters than this are shown.
const GROUPS: usize = 6;

/// The grid, in lines of at most `width` characters where its labels leave room; with colours, for the caller to strip
/// where they are not wanted. Nothing if there are no jobs.
pub fn overview(rows: &[Row], width: usize) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let layout = Layout::new(rows);
    let mut text = String::new();
    let mut used: Vec<Sign> = Vec::new();
    for group in layout.groups.iter().take(GROUPS) {
        if !group.key.is_empty() {
            let _ = writeln!(text, "{}:", group.caption());
        }
        grid(&layout, group, width, &mut used, &mut text);
    }
    if layout.groups.len() > GROUPS {
        let _ = writeln!(text, "… and {} more combinations of parameters", layout.groups.len() - GROUPS);
    }
    let legend: Vec<String> =
        used.iter().map(|sign| format!("{} {}", painted(*sign), sign.meaning)).collect();
    let mut line = 0;
    for (entry, sign) in legend.iter().zip(&used) {
        let length = sign.meaning.chars().count() + 4;
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

fn grid(layout: &Layout<'_>, group: &Group<'_>, width: usize, used: &mut Vec<Sign>, text: &mut String) {
    let columns: Vec<String> = group.axis_values.iter().map(value::text).collect();
    let corner = format!("μ \\ {}", layout.axis_label());
    let labels: Vec<String> = layout.mus.iter().map(|mu| value::number(*mu)).collect();
    let label_width = labels.iter().chain([&corner]).map(|label| label.chars().count()).max().unwrap_or(0);
    let cell_width = columns.iter().map(|label| label.chars().count()).max().unwrap_or(0) + 1;
    let mut signs: Vec<Vec<Option<Sign>>> = vec![vec![None; columns.len()]; labels.len()];
    for job in &group.jobs {
        let cell = &mut signs[job.mu][job.at];
        *cell = Some(if cell.is_some() { SEVERAL } else { sign(job.row) });
    }
    for sign in signs.iter().flatten().flatten() {
        if !used.contains(sign) {
            used.push(*sign);
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
        // The highest friction on top, as its curve is in a figure's legend.
        for (label, line) in labels.iter().zip(&signs).rev() {
            let _ = write!(text, "{label:>label_width$}");
            for cell in &line[part.clone()] {
                let _ = write!(text, "{:1$}", "", cell_width - 1);
                match cell {
                    Some(sign) => text.push_str(&painted(*sign)),
                    None => text.push(' '),
                }
            }
            text.push('\n');
        }
    }
}

fn painted(sign: Sign) -> String {
    let style = Style::new().fg_color(Some(sign.colour.into()));
    format!("{style}{}{style:#}", sign.letter)
}

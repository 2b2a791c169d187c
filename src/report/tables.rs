//! Tables of the same layout as Figure 7: speed by friction coefficient, one cell per job.

use super::export::io_error;
use super::layout::{Group, Layout};
use super::markdown;
use super::row::{JobRow, RowState};
use crate::analysis::{JobRecord, Outcome, Regime};
use crate::publish::value;
use crate::publish::value::MISSING;
use std::io::{self, Write};

/// What a table shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Macroscopic friction coefficient μ*.
    MuStar,
    /// Frequency of the limit cycle.
    Frequency,
    /// Contact regime.
    Regime,
}

impl Quantity {
    /// The quantity with its symbol and unit.
    pub fn title(self) -> &'static str {
        match self {
            Self::MuStar => "macroscopic friction coefficient μ*",
            Self::Frequency => "frequency [Hz]",
            Self::Regime => "contact regime",
        }
    }

    /// The marks in its cells with their meaning.
    pub(super) fn legend(self) -> impl Iterator<Item = (&'static str, &'static str)> {
        let own: &[_] = match self {
            Self::MuStar => &[("~", "not periodic: an average over the last part of the run")],
            Self::Frequency => &[
                ("", "fundamental frequency of the total normal contact force"),
                ("stable", "the oscillation decays"),
                ("none", "no frequency found"),
                ("~", "not periodic"),
            ],
            Self::Regime => &[("~", "not periodic: from the last part of the run")],
        };
        let common = [
            ("failed", "no result"),
            ("–", "no result yet, or no such job"),
            ("a / b", "several jobs at this point"),
        ];
        own.iter().copied().chain(common)
    }

    fn result(self, record: &JobRecord) -> String {
        let text = match self {
            Self::MuStar if !record.mu_star.is_finite() => return MISSING.to_owned(),
            Self::MuStar => value::fixed(record.mu_star, 4),
            Self::Frequency => match record.frequency_hz.filter(|f| f.is_finite()) {
                Some(frequency) => format!("{frequency:.0}"),
                None if record.regime == Regime::Stable => "stable".to_owned(),
                None => "none".to_owned(),
            },
            Self::Regime => record.regime.name().to_owned(),
        };
        if record.outcome == Outcome::NotPeriodic { text + "~" } else { text }
    }

    fn cell(self, row: &JobRow) -> String {
        match &row.state {
            RowState::Pending | RowState::Running | RowState::Cancelled => MISSING.to_owned(),
            RowState::Failed { .. } => "failed".to_owned(),
            RowState::Done(record) => self.result(record),
        }
    }
}

/// The tables of one quantity as Markdown: one per combination of further parameters, and a legend.
pub fn markdown(rows: &[JobRow], quantity: Quantity) -> String {
    markdown_of(&Layout::new(rows), quantity)
}

pub(super) fn markdown_of(layout: &Layout, quantity: Quantity) -> String {
    let mut parts = vec![constants(layout)];
    let header = header(layout);
    for group in &layout.groups {
        if !group.key.is_empty() {
            parts.push(format!("### {}\n\n", markdown::escape(&group.caption())));
        }
        let lines: Vec<Vec<String>> = lines(layout, group, quantity)
            .map(|(at, cells)| std::iter::once(at).chain(cells).collect())
            .collect();
        parts.push(markdown::table(&header, &lines, quantity != Quantity::Regime));
        parts.push("\n".to_owned());
    }
    parts.extend(quantity.legend().map(|(mark, meaning)| match mark {
        "" => format!("- {meaning}\n"),
        mark => format!("- `{mark}` {meaning}\n"),
    }));
    parts.concat()
}

/// The tables of one quantity as one CSV: columns for further parameters, one for the parameter along the rows, and one
/// for each μ.
///
/// The cells are those of [`markdown`]. A missing result is an empty cell.
///
/// # Errors
/// Those of the writer.
pub fn csv<W: Write>(rows: &[JobRow], quantity: Quantity, out: W) -> io::Result<()> {
    csv_of(&Layout::new(rows), quantity, out)
}

pub(super) fn csv_of<W: Write>(layout: &Layout, quantity: Quantity, out: W) -> io::Result<()> {
    let mut writer = ::csv::Writer::from_writer(out);
    let header = layout
        .further
        .iter()
        .chain([&layout.axis])
        .map(|&name| name.to_owned())
        .chain(layout.mus.iter().map(|&mu| format!("mu={}", value::rounded(mu))));
    writer.write_record(header).map_err(io_error)?;
    for group in &layout.groups {
        for (at, cells) in lines(layout, group, quantity) {
            let key = group.key.iter().map(|(_, value)| value::text(value));
            let cells = cells.into_iter().map(|cell| if cell == MISSING { String::new() } else { cell });
            writer.write_record(key.chain([at]).chain(cells)).map_err(io_error)?;
        }
    }
    writer.flush()
}

/// The headings of all columns.
pub(super) fn header(layout: &Layout) -> Vec<String> {
    let mus = layout.mus.iter().map(|&mu| format!("μ = {}", value::rounded(mu)));
    std::iter::once(layout.axis_label().to_owned()).chain(mus).collect()
}

/// Each value along the axis with its cells, one for each μ.
pub(super) fn lines<'a>(
    layout: &'a Layout,
    group: &'a Group,
    quantity: Quantity,
) -> impl Iterator<Item = (String, Vec<String>)> + 'a {
    let mut cells: Vec<Vec<Option<String>>> = vec![vec![None; layout.mus.len()]; group.axis_values.len()];
    for job in &group.jobs {
        let here = quantity.cell(job.row);
        match &mut cells[job.axis_index][job.mu_index] {
            Some(others) => others.extend([" / ", &here]),
            empty => *empty = Some(here),
        }
    }
    group.axis_values.iter().zip(cells).map(|(at, cells)| {
        let line = cells.into_iter().map(|cell| cell.unwrap_or_else(|| MISSING.to_owned())).collect();
        (value::rounded_text(at), line)
    })
}

fn constants(layout: &Layout) -> String {
    let words = layout.constants_in_words();
    if words.is_empty() { words } else { format!("In all jobs: {}.\n\n", markdown::escape(&words)) }
}

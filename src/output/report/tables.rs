//! Tables of the same layout as the curves: speed by friction coefficient, one cell per job.

use super::accuracy;
use super::digits;
use super::layout::{Group, Layout, PlacedJob};
use super::page::tables_of;
use super::parameters;
use super::row::{JobRow, RowState};
use super::scalar::{FREQUENCY, MU_STAR, Scalar};
use super::view::View;
use crate::analysis::{JobRecord, Outcome, Regime};
use crate::publish::markdown;
use crate::publish::page::{Block, Page};
use crate::publish::table::{FileColumns, Head, Table};
use crate::publish::value::{self, MISSING};
use serde_json::Value;
use std::borrow::Cow;
use std::collections::HashMap;

/// What a table shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Macroscopic friction coefficient μ*.
    MuStar,
    /// Frequency of the limit cycle.
    Frequency,
    /// Contact regime.
    Regime,
    /// Another number of the record.
    Of(&'static Scalar),
}

/// The mark of several jobs in one cell, in a legend.
const SEVERAL: &str = "a / b";

impl Quantity {
    /// The quantity with its symbol and unit.
    pub fn title(self) -> Cow<'static, str> {
        match self {
            Self::MuStar => MU_STAR.title().into(),
            Self::Frequency => FREQUENCY.title().into(),
            Self::Regime => "contact regime".into(),
            Self::Of(scalar) => scalar.title().into(),
        }
    }

    /// The name of its files without the ending.
    pub(super) fn stem(self) -> &'static str {
        match self {
            Self::MuStar => MU_STAR.name,
            Self::Frequency => "frequency",
            Self::Regime => "regime",
            Self::Of(scalar) => scalar.name,
        }
    }

    /// What a mark in a cell means, for the marks that are in `cells`.
    fn legend<'a>(self, cells: impl Iterator<Item = &'a str>) -> Vec<(&'static str, &'static str)> {
        let own: &[_] = match self {
            Self::MuStar => &[("~", "not periodic: an average over the last part of the run")],
            Self::Frequency => &[
                ("", "fundamental frequency of the total normal contact force"),
                ("growing", "a mode of steady sliding grows, and there was no run"),
                ("stable", "the oscillation decays"),
                ("none", "no frequency found"),
                ("~", "not periodic: the mean rate of its cycles"),
            ],
            Self::Regime | Self::Of(_) => &[("~", "not periodic: from the last part of the run")],
        };
        let common = [
            ("±", "error of the measured point"),
            ("failed", "no result"),
            (MISSING, "no result yet, or no such job"),
            (SEVERAL, "several jobs at this point"),
        ];
        let mut entries: Vec<_> = own.iter().copied().chain(common).map(|entry| (entry, false)).collect();
        for cell in cells {
            for ((mark, _), occurs) in &mut entries {
                let sign = if *mark == SEVERAL { " / " } else { mark };
                *occurs = *occurs || cell.contains(sign);
            }
        }
        entries.into_iter().filter(|(_, occurs)| *occurs).map(|(entry, _)| entry).collect()
    }

    fn result(self, row: &JobRow, record: &JobRecord, digits: Digits) -> String {
        let text = match self {
            Self::MuStar if !record.mu_star.is_finite() => return MISSING.to_owned(),
            Self::MuStar if digits == Digits::Fixed => MU_STAR.text(record.mu_star),
            Self::MuStar => digits::by_error(MU_STAR, row),
            Self::Frequency => match record.frequency_hz.filter(|f| f.is_finite()) {
                Some(frequency) if digits == Digits::Fixed => FREQUENCY.text(frequency),
                Some(_) => digits::by_error(FREQUENCY, row),
                None if record.regime == Regime::Stable => "stable".to_owned(),
                None if record.outcome == Outcome::Unstable => "growing".to_owned(),
                None => "none".to_owned(),
            },
            Self::Regime if record.outcome == Outcome::Unstable => record.outcome.name().to_owned(),
            Self::Regime => record.regime.name().to_owned(),
            Self::Of(scalar) => match scalar.value(row) {
                Some(x) => scalar.text(x),
                None => return MISSING.to_owned(),
            },
        };
        if record.outcome == Outcome::NotPeriodic { text + "~" } else { text }
    }

    fn measured(self, row: &JobRow) -> String {
        let scalar = match self {
            Self::MuStar => MU_STAR,
            Self::Frequency => FREQUENCY,
            Self::Of(scalar) => scalar,
            Self::Regime => return MISSING.to_owned(),
        };
        match (scalar.value(row), scalar.error(row)) {
            (Some(x), error) => scalar.text_with_error(x, error),
            (None, _) => MISSING.to_owned(),
        }
    }

    fn cell(self, row: &JobRow, digits: Digits) -> String {
        match &row.state {
            RowState::Pending | RowState::Running | RowState::Cancelled => MISSING.to_owned(),
            RowState::Failed { .. } => "failed".to_owned(),
            RowState::Unreadable { .. } => "unreadable".to_owned(),
            RowState::Done(record) => self.result(row, record, digits),
            RowState::Measured(_) => self.measured(row),
        }
    }
}

/// The digits of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Digits {
    /// Those that its errors leave, for a reader.
    ByError,
    /// Always the same number, for a program.
    Fixed,
}

/// The tables of one quantity as Markdown: one per combination of further parameters, and a legend of the marks that occur.
pub fn markdown(rows: &[JobRow], quantity: Quantity) -> String {
    markdown::of_blocks(&tables_of(&Layout::new(rows), quantity, &HashMap::new()))
}

/// The tables of one quantity as a page in Markdown: below a title, and with the axes of a `view`.
pub fn page(rows: &[JobRow], view: &View, quantity: Quantity, title: &str) -> String {
    let rows = rows.iter().filter(|row| !row.is_at_boundary());
    let lead = tables_of(&Layout::of(rows, view), quantity, &HashMap::new());
    markdown::of_page(&Page { title: format!("{title}: {}", quantity.title()), lead, ..Page::default() })
}

/// What a run has found, for a terminal: a page of μ\*, one of the frequency if there is one, and what is known about the errors by the mesh.
pub fn of_results(rows: &[JobRow], view: &View, title: &str) -> String {
    let page = |quantity| page(rows, view, quantity, title);
    let has_frequency = |row: &JobRow| row.record().is_some_and(|record| record.frequency_hz.is_some());
    let mut parts = vec![page(Quantity::MuStar)];
    if rows.iter().any(has_frequency) {
        parts.push(page(Quantity::Frequency));
    }
    let errors = accuracy::of_mesh(rows);
    if !errors.is_empty() {
        parts.push(markdown::of_blocks(&[Block::list(errors)]));
    }
    format!("{}\n", parts.join("\n").trim_end())
}

/// The marks that occur in the tables of a quantity with their meaning.
pub(super) fn legend(layout: &Layout, quantity: Quantity) -> Vec<(&'static str, &'static str)> {
    let lines = layout.groups.iter().flat_map(|group| lines(layout, group, quantity, Digits::ByError));
    let cells: Vec<String> = lines.flat_map(|(_, cells)| cells).collect();
    quantity.legend(cells.iter().map(String::as_str))
}

/// The tables of one quantity as one: columns for further parameters, one for the parameter along the rows, and one
/// for each μ.
///
/// The cells are those of [`markdown`](fn@markdown), but μ\* has four decimals and a frequency none, whatever their errors are. A missing result is an empty cell.
pub fn table(rows: &[JobRow], quantity: Quantity) -> Table {
    table_of(&Layout::new(rows), quantity)
}

pub(super) fn table_of(layout: &Layout, quantity: Quantity) -> Table {
    table_with(layout, quantity, Digits::Fixed)
}

pub(super) fn table_with(layout: &Layout, quantity: Quantity, digits: Digits) -> Table {
    let stem = quantity.stem();
    let of_series = layout.series.iter().map(|series| {
        let of_source = layout.sources.get(series.source).filter(|_| layout.has_sources());
        let source = of_source.map_or_else(String::new, |source| format!(" {}", source.name));
        let name = format!("{}={}{source}", layout.by, value::rounded_text(&series.value));
        Head::new(name, "", format!("{} there", quantity.title()))
    });
    let names = layout.further.iter().chain(&layout.scattered).chain([&layout.axis]);
    let heads = names.map(|name| parameters::head(name)).chain(of_series).collect();
    let of_point = |group: &Group, job: &PlacedJob| {
        let key = group.key.iter().map(|(_, value)| value.clone());
        let scattered = layout.scattered.iter().map(|name| job.row.parameter(name));
        let at = value::rounded_value(&group.axis_values[job.axis_index]);
        let cell = cell_or_null(quantity.cell(job.row, digits));
        let cells =
            (0..layout.series.len()).map(|own| if own == job.series { cell.clone() } else { Value::Null });
        key.chain(scattered).chain([at]).chain(cells).collect()
    };
    if !layout.scattered.is_empty() {
        // Two points at one place along the axis are no neighbours.
        let jobs = |group: &Group| {
            let mut jobs: Vec<PlacedJob> = group.jobs.clone();
            jobs.sort_by_key(|job| job.axis_index);
            jobs.into_iter().map(|job| of_point(group, &job)).collect::<Vec<_>>()
        };
        return Table { stem: stem.into(), heads, lines: layout.groups.iter().flat_map(jobs).collect() };
    }
    let of_group = |group| {
        lines(layout, group, quantity, digits).map(|(at, cells)| {
            let key = group.key.iter().map(|(_, value)| value.clone());
            let cells = cells.into_iter().map(cell_or_null);
            key.chain([value::rounded_value(at)]).chain(cells).collect()
        })
    };
    Table { stem: stem.into(), heads, lines: layout.groups.iter().flat_map(of_group).collect() }
}

fn cell_or_null(cell: String) -> Value {
    if cell == MISSING { Value::Null } else { cell.into() }
}

/// What the columns are, for the page of columns.
pub(super) fn described() -> FileColumns {
    let lines = "Tables of a quantity. A line has the jobs at one value of the parameter along the axis, with the parameters that tell \
                 tables apart. There is a column for each value of the parameter of the curves, for example `mu=0.4`.";
    FileColumns::new::<JobRow>(&["mu_star.csv", "frequency.csv", "regime.csv", "QUANTITY.csv"], lines, [])
}

/// The headings of all columns.
pub(super) fn header(layout: &Layout) -> Vec<String> {
    let columns = layout.series.iter().map(|series| layout.series_name(series));
    std::iter::once(layout.axis_label().to_owned()).chain(columns).collect()
}

/// Each value along the axis with its cells, one for each series.
pub(super) fn lines<'a>(
    layout: &'a Layout,
    group: &'a Group,
    quantity: Quantity,
    digits: Digits,
) -> impl Iterator<Item = (&'a Value, Vec<String>)> + 'a {
    let mut cells: Vec<Vec<Option<String>>> = vec![vec![None; layout.series.len()]; group.axis_values.len()];
    for job in &group.jobs {
        let here = quantity.cell(job.row, digits);
        match &mut cells[job.axis_index][job.series] {
            Some(others) => others.extend([" / ", &here]),
            empty => *empty = Some(here),
        }
    }
    group.axis_values.iter().zip(cells).map(|(at, cells)| {
        (at, cells.into_iter().map(|cell| cell.unwrap_or_else(|| MISSING.to_owned())).collect())
    })
}

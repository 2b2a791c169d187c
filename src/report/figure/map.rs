//! Maps of the grid: a cell for every job, a column for each speed, a row for each friction coefficient, in one panel for
//! each group.

use super::colour_key::{self, KeyEntry, Swatch};
use super::panels::{self, SMALL, TITLE};
use crate::analysis::Outcome;
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area};
use crate::publish::plot::tooltip::{Shape, TooltipTarget};
use crate::publish::plot::{DrawError, MARGIN, TEXT, palette};
use crate::publish::value;
use crate::report::glyph::{StatusGlyph, status_glyph};
use crate::report::layout::{Group, Layout, PlacedJob};
use crate::report::row::JobRow;
use crate::report::scalar::FREQUENCY;
use crate::report::tooltip::tooltip_text;
use plotters::prelude::RGBColor;
use plotters::style::text_anchor::HPos;

/// Width of the labels of the rows [px].
const Y_LABELS: i32 = 130;
/// Height above the cells, where the symbol μ is [px].
const HEAD: i32 = 72;
const LEGEND_WIDTH: i32 = 500;
/// Smallest and largest height of a row of cells [px].
const ROW_HEIGHT: (i32, i32) = (12, 86);
/// Height of all rows, if that leaves each of them the smallest height or more [px].
const ROWS_HEIGHT: i32 = 1000;
/// Smallest size of text [px].
const MIN_TEXT: i32 = 16;
/// Distance between cells [px].
const GAP: i32 = 2;

/// Colour and text of a cell.
struct CellStyle {
    fill: RGBColor,
    text: String,
    /// The value in full precision, for the attribute `data-value`.
    value: String,
}

/// The contact regimes.
pub(super) fn regimes(layout: &Layout, groups: &[Group]) -> Result<String, FigureError> {
    let style = |row: &JobRow| {
        let glyph = status_glyph(row);
        CellStyle { fill: glyph.fill, text: glyph.letter.to_string(), value: glyph.letter.to_string() }
    };
    let entries = glyph_key(rows_of(groups));
    draw(layout, groups, style, 60 * entries.len() as i32, |area| {
        colour_key::draw_column(area, HEAD, &entries)
    })
}

/// The frequencies as colours and numbers. The colours span the frequencies of limit cycles; a job that is not periodic
/// has its number, but no colour.
pub(super) fn frequencies(layout: &Layout, groups: &[Group]) -> Result<String, FigureError> {
    let frequency = |row: &JobRow| FREQUENCY.value(row);
    let settled = |row: &JobRow| frequency(row).filter(|_| FREQUENCY.is_settled(row));
    let (low, high) = rows_of(groups)
        .filter_map(settled)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), f| (low.min(f), high.max(f)));
    let share = |f: f64| if high > low { (f - low) / (high - low) } else { 0.5 };
    let largest = rows_of(groups).filter_map(frequency).fold(0.0, f64::max);
    let (unit, per_unit) = if largest >= 1000.0 { ("kHz", 1000.0) } else { ("Hz", 1.0) };
    let style = |row: &JobRow| match frequency(row) {
        Some(f) => CellStyle {
            fill: settled(row).map_or(NO_VALUE, |f| palette::sequential(share(f))),
            text: value::fixed(f / per_unit, 1) + not_periodic(row),
            value: value::number(f),
        },
        None => {
            CellStyle { fill: NO_VALUE, text: status_glyph(row).letter.to_string(), value: String::new() }
        }
    };
    let mut entries = glyph_key(rows_of(groups).filter(|row| frequency(row).is_none()));
    for entry in &mut entries {
        entry.swatch.fill = NO_VALUE;
    }
    if rows_of(groups).any(|row| frequency(row).is_some() && settled(row).is_none()) {
        let label = format!("not periodic [{unit}]");
        entries.insert(0, KeyEntry { swatch: Swatch::filled(NO_VALUE, '~'), label });
    }
    let scale = if low <= high { SCALE } else { 0 };
    draw(layout, groups, style, scale + 60 * entries.len() as i32 + 40, |area| {
        if low <= high {
            draw_scale(area, (low / per_unit, high / per_unit), unit)?;
        }
        colour_key::draw_column(area, HEAD + scale, &entries)
    })
}

/// The jobs of all panels.
fn rows_of<'a>(groups: &'a [Group]) -> impl Iterator<Item = &'a JobRow> {
    groups.iter().flat_map(|group| &group.jobs).map(|job| job.row)
}

/// The mark for a job that is not periodic, as in tables.
fn not_periodic(row: &JobRow) -> &'static str {
    if row.record().is_some_and(|record| record.outcome == Outcome::NotPeriodic) { "~" } else { "" }
}

const NO_VALUE: RGBColor = RGBColor(0xEC, 0xEC, 0xEC);
/// Height of the colour scale with its heading [px].
const SCALE: i32 = 360;
/// Number of colours in it.
const STEPS: i32 = 60;

/// The letters of all glyphs in the order of the colour key.
const ORDER: &str = "SKkXxPp?!>.-";

/// A colour key of the glyphs that occur, each once.
pub(super) fn glyph_key<'a>(rows: impl Iterator<Item = &'a JobRow>) -> Vec<KeyEntry> {
    let mut used: Vec<StatusGlyph> = Vec::new();
    for glyph in rows.map(status_glyph) {
        if !used.contains(&glyph) {
            used.push(glyph);
        }
    }
    used.sort_by_key(|glyph| ORDER.find(glyph.letter));
    let entry = |glyph: &StatusGlyph| KeyEntry {
        swatch: Swatch::filled(glyph.fill, glyph.letter),
        label: glyph.meaning.to_owned(),
    };
    used.iter().map(entry).collect()
}

fn draw_scale(area: &Area, (low, high): (f64, f64), unit: &str) -> Result<(), DrawError> {
    canvas::write(area, &format!("frequency [{unit}]"), (0, HEAD / 2), TEXT, HPos::Left)?;
    let (top, bottom, width) = (HEAD, HEAD + SCALE - 90, 56);
    let y = |share: f64| bottom - (share * f64::from(bottom - top)).round() as i32;
    for step in 0..STEPS {
        let share = |step: i32| f64::from(step) / f64::from(STEPS);
        // If all values are equal, the scale has the one colour of the cells.
        let middle = if high > low { share(step) + 0.5 / f64::from(STEPS) } else { 0.5 };
        let colour = palette::sequential(middle);
        canvas::fill_rectangle(area, (0, y(share(step + 1))), (width, y(share(step))), colour)?;
    }
    let marks =
        if high > low { Axis::Linear(low..high).labelled_ticks() } else { vec![(low, value::fixed(low, 1))] };
    for (at, label) in marks {
        let share = if high > low { (at - low) / (high - low) } else { 0.5 };
        canvas::fill_rectangle(area, (width, y(share) - 1), (width + 10, y(share) + 1), RGBColor(0, 0, 0))?;
        canvas::write(area, &label, (width + 20, y(share)), TEXT, HPos::Left)?;
    }
    Ok(())
}

/// Positions of the cells of a panel [px].
struct CellGrid {
    columns: usize,
    rows: usize,
    left: i32,
    right: i32,
    top: i32,
    row: i32,
    /// Largest size of text.
    text: i32,
}

impl CellGrid {
    /// Left edge of column `at`; fractions are positions within a column.
    fn x(&self, at: f64) -> i32 {
        self.left + (f64::from(self.right - self.left) * at / self.columns.max(1) as f64).round() as i32
    }

    /// Upper edge of the row of a series. The largest value is on top.
    fn y(&self, series: usize) -> i32 {
        self.top + (self.rows - 1 - series) as i32 * self.row
    }

    fn bottom(&self) -> i32 {
        self.top + self.rows as i32 * self.row
    }
}

fn draw(
    layout: &Layout,
    groups: &[Group],
    style: impl Fn(&JobRow) -> CellStyle,
    legend_height: i32,
    legend: impl FnOnce(&Area) -> Result<(), DrawError>,
) -> Result<String, FigureError> {
    let across = panels::columns(groups.len()).min(3);
    let down = groups.len().div_ceil(across);
    let rows = layout.series.len();
    let row = (ROWS_HEIGHT / (rows.max(1) * down) as i32).clamp(ROW_HEIGHT.0, ROW_HEIGHT.1);
    let cells = |columns: usize, width: i32| CellGrid {
        columns,
        rows,
        left: MARGIN / across as i32 + Y_LABELS,
        right: width - MARGIN / across as i32,
        top: HEAD,
        row,
        text: if across > 1 { SMALL } else { TEXT },
    };
    let panel_height = HEAD + rows as i32 * row + canvas::X_LABELS as i32 + MARGIN / 2;
    let caption = |group: &Group| if groups.len() > 1 { group.caption() } else { String::new() };
    let above = if groups.len() > 1 { TITLE as i32 } else { 0 };
    let alone = if groups.len() == 1 { groups[0].caption() } else { String::new() };
    let height = (down as i32 * (panel_height + above)).max(HEAD + legend_height + MARGIN) as u32
        + canvas::caption_height(&alone);
    let has_tooltips = rows_of(groups).count() <= super::MAX_TOOLTIPS;
    canvas::sheet((canvas::WIDTH, height), |root| {
        let below = canvas::caption(root, &alone)?;
        let (left, right) = below.split_horizontally(canvas::WIDTH as i32 - LEGEND_WIDTH);
        let (left, _) = left.split_vertically(down as i32 * (panel_height + above));
        // Parts of a sheet may differ by a pixel; equal panels have equal labels.
        let width = (canvas::WIDTH as i32 - LEGEND_WIDTH) / across as i32;
        let mut targets = Vec::new();
        for (group, part) in groups.iter().zip(left.split_evenly((down, across))) {
            let cells = cells(group.axis_values.len(), width);
            let part = match caption(group) {
                words if words.is_empty() => part,
                words => panels::title(&part, &words, (cells.left + cells.right) / 2)?,
            };
            draw_labels(&part, layout, group, &cells)?;
            targets.extend(draw_cells(&part, layout, group, &cells, &style)?);
        }
        legend(&right)?;
        Ok(if has_tooltips { targets } else { Vec::new() })
    })
}

fn draw_cells(
    area: &Area,
    layout: &Layout,
    group: &Group,
    cells: &CellGrid,
    style: impl Fn(&JobRow) -> CellStyle,
) -> Result<Vec<TooltipTarget>, DrawError> {
    let mut jobs: Vec<&PlacedJob> = group.jobs.iter().collect();
    jobs.sort_by_key(|job| (job.series, job.axis_index));
    let base = area.get_base_pixel();
    let on_sheet = |at: (i32, i32)| (at.0 + base.0, at.1 + base.1);
    let mut targets = Vec::with_capacity(jobs.len());
    for here in jobs.chunk_by(|a, b| (a.series, a.axis_index) == (b.series, b.axis_index)) {
        // Several jobs at one point of the grid share a cell.
        let part = 1.0 / here.len() as f64;
        for (number, job) in here.iter().enumerate() {
            let start = job.axis_index as f64 + number as f64 * part;
            let from = (cells.x(start), cells.y(job.series));
            let to = (cells.x(start + part) - GAP, cells.y(job.series) + cells.row - GAP);
            let CellStyle { fill, text, value } = style(job.row);
            canvas::fill_rectangle(area, from, to, fill)?;
            // The widths of columns differ by a pixel because of rounding; the text size is the same in all of them.
            let room =
                (((cells.right - cells.left) as f64 * part) as i32 / cells.columns as i32 - GAP - 6).max(0);
            // The width of a digit is a little more than half of its height.
            let fitting = room * 19 / (10 * text.chars().count().max(1) as i32);
            let size = fitting.min((to.1 - from.1) * 2 / 3).min(cells.text + 4);
            if size >= MIN_TEXT {
                let at = ((from.0 + to.0) / 2, (from.1 + to.1) / 2);
                canvas::write_coloured(area, &text, at, size, HPos::Center, palette::contrasting(fill))?;
            }
            targets.push(TooltipTarget {
                shape: Shape::Cell { from: on_sheet(from), to: on_sheet(to) },
                title: tooltip_text(job.row),
                data: vec![
                    ("job", job.row.job.clone()),
                    ("x", value::text(&group.axis_values[job.axis_index])),
                    ("y", value::text(&layout.series[job.series].value)),
                    ("value", value),
                ],
            });
        }
    }
    Ok(targets)
}

fn draw_labels(area: &Area, layout: &Layout, group: &Group, cells: &CellGrid) -> Result<(), DrawError> {
    let beside = cells.left - 16;
    let head = &layout.dimension(layout.by).label;
    let head_size = canvas::fitting_size(head.chars().count(), cells.right).min(cells.text + 4);
    // A long name begins at the edge of the panel.
    let (at, anchor) = if head.chars().count() > 4 { (4, HPos::Left) } else { (beside, HPos::Right) };
    canvas::write(area, head, (at, HEAD / 2), head_size, anchor)?;
    let names: Vec<String> = layout.series.iter().map(|series| layout.series_value(series)).collect();
    let longest = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let fitting = canvas::fitting_size(longest, beside);
    let size = (cells.row - 2).min(fitting).clamp(MIN_TEXT, cells.text);
    let every = (size as usize).div_ceil(cells.row as usize);
    for (index, name) in names.iter().enumerate().step_by(every) {
        let at = (beside, cells.y(index) + (cells.row - GAP) / 2);
        canvas::write(area, name, at, size, HPos::Right)?;
    }
    let labels: Vec<String> = group.axis_values.iter().map(|value| layout.axis_text(value)).collect();
    let longest = labels.iter().map(|label| label.chars().count()).max().unwrap_or(0) as i32 + 1;
    let room = (cells.right - cells.left) / cells.columns.max(1) as i32;
    let size = canvas::fitting_size(longest as usize, room).clamp(MIN_TEXT, cells.text);
    let every = (longest * size / 2).div_euclid(room.max(1)) as usize + 1;
    let every = if longest * size / 2 <= room { 1 } else { every };
    for (index, label) in labels.iter().enumerate().step_by(every) {
        let at = (cells.x(index as f64 + 0.5) - GAP / 2, cells.bottom() + 28);
        canvas::write(area, label, at, size, HPos::Center)?;
    }
    let middle = ((cells.left + cells.right) / 2, cells.bottom() + 78);
    canvas::write(area, layout.axis_name(), middle, cells.text + 4, HPos::Center)
}

//! Maps on true axes: jobs at their places in a plane, each with the part of the plane that is nearer to its values than to
//! those of its neighbours.

use super::colour_key::{self, KeyEntry};
use super::map::glyph_key;
use super::places::{self, Place};
use super::stability::boundary::{self, Sign};
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area, Chart, X_LABELS};
use crate::publish::plot::tooltip::{Shape, TooltipTarget};
use crate::publish::plot::{DrawError, FONT, GRID, MARGIN, TEXT, palette};
use crate::publish::value;
use crate::report::glyph::status_glyph;
use crate::report::layout::{Group, Layout};
use crate::report::row::JobRow;
use crate::report::stability::{Verdict, Verdicts};
use crate::report::stability_point::StabilityPoint;
use crate::report::tooltip::tooltip_text;
use plotters::chart::ChartBuilder;
use plotters::prelude::{Circle, RGBColor};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;
use serde_json::Value;
use std::cell::Cell;

const LEGEND_WIDTH: u32 = 500;
const Y_LABELS: u32 = 150;
/// Height of the plane with its labels [px].
const HEIGHT: u32 = 1000;
/// Smallest and largest size of text in a cell [px].
const TEXT_SIZES: (i32, i32) = (15, 30);
/// Half the size [px] of the cell of a job that is not on a grid.
const ALONE: i32 = 17;
/// Radius of the dot at a job's place [px].
const DOT: i32 = 4;

/// Colour and text of a job's cell.
pub(super) struct CellStyle {
    pub fill: RGBColor,
    pub text: String,
    /// The value in full precision, for the attribute `data-value`.
    pub value: String,
    /// The tooltip, if it is not that of the job.
    pub title: Option<String>,
    /// A mark in the corner.
    pub mark: Option<Verdict>,
    /// Whether the row is a job, whose key a program may want.
    pub is_job: bool,
}

impl CellStyle {
    /// A cell with the tooltip of its job.
    pub fn new(fill: RGBColor, text: String, value: String) -> Self {
        Self { fill, text, value, title: None, mark: None, is_job: true }
    }
}

/// Whether a layout has numbers on both axes. Otherwise there is no plane.
pub(super) fn exists(layout: &Layout) -> bool {
    let has_jobs = layout.groups.iter().any(|group| !group.jobs.is_empty());
    let is_numeric = || {
        !matches!(layout.x_axis(), Axis::Names(_))
            && places::series(layout).iter().any(|look| look.y.is_some())
    };
    !has_jobs || is_numeric()
}

/// The contact regimes. If the linear stability of steady sliding is known, its boundary is drawn into them, and the jobs that
/// it does not explain are marked.
pub(super) fn regimes(
    layout: &Layout,
    group: &Group,
    points: &[StabilityPoint],
) -> Result<String, FigureError> {
    // Points of one study say nothing about the jobs of another one.
    let points = if layout.sources.len() > 1 { &[] } else { points };
    let verdicts = Verdicts::new(points);
    let style = |row: &JobRow| {
        let glyph = status_glyph(row);
        let mark = verdicts.of(row);
        let title = mark.map(|verdict| format!("{}\n{}", tooltip_text(row), verdict.words()));
        let letter = glyph.letter.to_string();
        CellStyle { title, mark, ..CellStyle::new(glyph.fill, letter.clone(), letter) }
    };
    let rows = || group.jobs.iter().map(|job| job.row);
    let entries: Vec<KeyEntry> = glyph_key(rows());
    let nodes = boundary::nodes(layout, group, points);
    let occurs = |verdict: &Verdict| rows().any(|row| verdicts.of(row) == Some(*verdict));
    let has_line = Cell::new(false);
    let overlay = |chart: &mut Chart| {
        has_line.set(boundary::draw(chart, &nodes)?);
        Ok(())
    };
    draw(layout, group, style, overlay, |area| {
        colour_key::draw_column(area, MARGIN, &entries)?;
        let line = has_line.get().then_some(Sign::ZeroLine);
        let marks = Verdict::ALL.into_iter().filter(occurs).map(Sign::Verdict);
        let signs: Vec<Sign> = line.into_iter().chain(marks).collect();
        boundary::draw_signs(area, MARGIN + colour_key::PITCH * (entries.len() as i32 + 1), &signs)
    })
}

/// The values along one axis, ascending, and the boundaries of their cells.
pub(super) struct CellEdges {
    values: Vec<f64>,
    /// One more than values.
    edges: Vec<f64>,
    pub axis: Axis,
}

impl CellEdges {
    /// Boundaries half-way between neighbours, on a logarithmic axis at their geometric mean. The outer cells reach as far
    /// outwards as inwards.
    pub fn of(values: impl Iterator<Item = f64>, logarithmic: bool) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let as_values: Vec<Value> = values.iter().map(|x| (*x).into()).collect();
        let is_log = matches!(Axis::for_values(&as_values, logarithmic.then_some(true)), Axis::Log(_));
        let to = |x: f64| if is_log { x.ln() } else { x };
        let from = |t: f64| if is_log { t.exp() } else { t };
        let at: Vec<f64> = values.iter().map(|x| to(*x)).collect();
        let alone = match at.as_slice() {
            [only] if !is_log && *only != 0.0 => only.abs() / 4.0,
            _ => 0.5,
        };
        let half = |pair: Option<&[f64]>| pair.map_or(alone, |pair| (pair[1] - pair[0]) / 2.0);
        let (first, last) = (at.first().copied().unwrap_or(0.5), at.last().copied().unwrap_or(0.5));
        let mut edges = vec![first - half(at.windows(2).next())];
        edges.extend(at.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0));
        edges.push(last + half(at.windows(2).next_back()));
        let edges: Vec<f64> = edges.into_iter().map(from).collect();
        let range = edges[0]..edges[edges.len() - 1];
        let axis = match (values.is_empty(), is_log) {
            (true, _) => Axis::Names(Vec::new()),
            (false, true) => Axis::Log(range),
            (false, false) => Axis::Linear(range),
        };
        Self { values, edges, axis }
    }

    /// The index of a value.
    fn index(&self, value: f64) -> usize {
        self.values.partition_point(|own| *own < value)
    }
}

/// A job in the plane.
struct JobCell<'a> {
    place: Place<'a>,
    y: f64,
    column: usize,
    row: usize,
}

/// Draws the cells of a group's jobs, what lies over them, and the legend beside them.
pub(super) fn draw(
    layout: &Layout,
    group: &Group,
    style: impl Fn(&JobRow) -> CellStyle,
    overlay: impl FnOnce(&mut Chart) -> Result<(), DrawError>,
    legend: impl FnOnce(&Area) -> Result<(), DrawError>,
) -> Result<String, FigureError> {
    let caption = group.caption();
    let offset = canvas::caption_height(&caption);
    let x_axis = layout.x_axis();
    let looks = places::series(layout);
    let places = places::places(layout, group, &x_axis);
    let placed = || places.iter().filter_map(|place| Some((*place, looks[place.series].y?)));
    let columns = CellEdges::of(placed().map(|(place, _)| place.x), matches!(x_axis, Axis::Log(_)));
    let rows = CellEdges::of(placed().map(|(_, y)| y), false);
    let mut cells: Vec<JobCell> = placed()
        .map(|(place, y)| JobCell { column: columns.index(place.x), row: rows.index(y), place, y })
        .collect();
    cells.sort_by_key(|cell| (cell.row, cell.column));
    canvas::sheet((canvas::WIDTH, HEIGHT + offset), |root| {
        let below = canvas::caption(root, &caption)?;
        let (left, right) = below.split_horizontally(canvas::WIDTH - LEGEND_WIDTH);
        let mut chart = ChartBuilder::on(&left)
            .margin(MARGIN)
            .x_label_area_size(X_LABELS)
            .y_label_area_size(Y_LABELS)
            .build_cartesian_2d(columns.axis.clone(), rows.axis.clone())?;
        canvas::mesh(&mut chart)
            .disable_mesh()
            .x_label_style((FONT, TEXT))
            .x_desc(layout.axis_name())
            .y_desc(places::series_title(layout))
            .draw()?;
        let targets = draw_cells(&left, &chart, &cells, &columns, &rows, style)?;
        overlay(&mut chart)?;
        canvas::frame(&chart)?;
        legend(&right)?;
        Ok(if places::has_tooltips(group) { targets } else { Vec::new() })
    })
}

fn draw_cells(
    area: &Area,
    chart: &Chart,
    cells: &[JobCell],
    columns: &CellEdges,
    rows: &CellEdges,
    style: impl Fn(&JobRow) -> CellStyle,
) -> Result<Vec<TooltipTarget>, DrawError> {
    let base = area.get_base_pixel();
    let points: Vec<&[JobCell]> = cells.chunk_by(|a, b| (a.row, a.column) == (b.row, b.column)).collect();
    // Points that are not on a grid have no neighbours in rows and columns. A cell of theirs would say nothing.
    let is_grid = 2 * points.len() >= columns.values.len() * rows.values.len();
    let mut targets = Vec::with_capacity(cells.len());
    for here in points {
        let at = chart.backend_coord(&(here[0].place.x, here[0].y));
        let (from, to) = if is_grid {
            let edge =
                |column: usize, row: usize| chart.backend_coord(&(columns.edges[column], rows.edges[row]));
            let (column, row) = (here[0].column, here[0].row);
            let ((left, bottom), (right, top)) = (edge(column, row), edge(column + 1, row + 1));
            ((left, top), (right, bottom))
        } else {
            ((at.0 - ALONE, at.1 - ALONE), (at.0 + ALONE, at.1 + ALONE))
        };
        // Several jobs at one point share a cell.
        let width = (to.0 - from.0) / here.len() as i32;
        for (number, cell) in here.iter().enumerate() {
            let left = from.0 + number as i32 * width;
            let right = if number + 1 == here.len() { to.0 } else { left + width };
            let CellStyle { fill, text, value, title, mark, is_job } = style(cell.place.row);
            let own = |(x, y): (i32, i32)| (x - base.0, y - base.1);
            let (upper, lower) = (own((left, from.1)), own((right, to.1)));
            canvas::fill_rectangle(area, upper, lower, fill)?;
            let middle = if here.len() == 1 { own(at) } else { (i32::midpoint(upper.0, lower.0), own(at).1) };
            write_text(area, &text, middle, (upper, lower), palette::contrasting(fill), is_grid)?;
            if let Some(verdict) = mark {
                boundary::draw_mark_in(area, verdict, upper, lower)?;
            }
            let mut data = Vec::from_iter(is_job.then(|| ("job", cell.place.row.job.clone())));
            data.extend([("x", value::text(cell.place.at)), ("y", value::number(cell.y)), ("value", value)]);
            data.extend(mark.map(|verdict| ("mark", verdict.name().to_owned())));
            targets.push(TooltipTarget {
                shape: Shape::Cell { from: (left, from.1), to: (right.max(left + 1), to.1) },
                title: title.unwrap_or_else(|| tooltip_text(cell.place.row)),
                data,
            });
        }
    }
    if is_grid {
        draw_boundaries(area, chart, columns, rows)?;
    }
    Ok(targets)
}

/// Writes the text of a cell above the dot at the place of its job; without a dot if the job is not on a grid.
fn write_text(
    area: &Area,
    text: &str,
    (x, y): (i32, i32),
    (upper, lower): ((i32, i32), (i32, i32)),
    ink: RGBColor,
    is_grid: bool,
) -> Result<(), DrawError> {
    // The text is centred at the place, which may be near to a side of the cell.
    let room = 2 * (x - upper.0).min(lower.0 - x) - 6;
    let fitting = room * 19 / (10 * text.chars().count().max(1) as i32);
    if !is_grid {
        return canvas::write_coloured(area, text, (x, y), fitting.min(TEXT_SIZES.1 - 4), HPos::Center, ink);
    }
    area.draw(&Circle::new((x, y), DOT, ink.filled()))?;
    let above = y - upper.1 - DOT - 2;
    let below = lower.1 - y - DOT - 2;
    let size = fitting.min(above.max(below)).min(TEXT_SIZES.1);
    if size < TEXT_SIZES.0 {
        return Ok(());
    }
    let distance = DOT + 3 + size / 2;
    let at = if above >= size { y - distance } else { y + distance };
    canvas::write_coloured(area, text, (x, at), size, HPos::Center, ink)
}

/// Thin lines between the cells.
fn draw_boundaries(
    area: &Area,
    chart: &Chart,
    columns: &CellEdges,
    rows: &CellEdges,
) -> Result<(), DrawError> {
    let base = area.get_base_pixel();
    let pixel = |x: f64, y: f64| {
        let (x, y) = chart.backend_coord(&(x, y));
        (x - base.0, y - base.1)
    };
    let (left, right) = (columns.edges[0], columns.edges[columns.edges.len() - 1]);
    let (bottom, top) = (rows.edges[0], rows.edges[rows.edges.len() - 1]);
    let vertical = columns.edges.iter().map(|x| [pixel(*x, bottom), pixel(*x, top)]);
    let horizontal = rows.edges.iter().map(|y| [pixel(left, *y), pixel(right, *y)]);
    for line in vertical.chain(horizontal) {
        area.draw(&plotters::prelude::PathElement::new(line, GRID.stroke_width(1)))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: cells meet half-way between their values, on a logarithmic axis at the geometric mean, and the outer ones
    /// are symmetric. A single value has a cell too, also at zero.
    #[test]
    fn cells_meet_half_way() {
        let linear = CellEdges::of([0.1, 0.4, 0.2].into_iter(), false);
        let near = |edges: &[f64], expected: &[f64]| {
            assert_eq!(edges.len(), expected.len());
            let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= 4.0 * f64::EPSILON * b.abs().max(1.0);
            assert!(edges.iter().zip(expected).all(is_near), "{edges:?} {expected:?}");
        };
        near(&linear.edges, &[0.05, 0.15, 0.3, 0.5]);
        let speeds = CellEdges::of([1.0, 4.0, 100.0].into_iter(), true);
        assert!(matches!(speeds.axis, Axis::Log(_)));
        near(&speeds.edges, &[0.5, 2.0, 20.0, 500.0]);
        near(&CellEdges::of([0.4].into_iter(), false).edges, &[0.3, 0.5]);
        near(&CellEdges::of([0.0].into_iter(), true).edges, &[-0.5, 0.5]);
        assert!(matches!(CellEdges::of(std::iter::empty(), true).axis, Axis::Names(_)));
    }
}

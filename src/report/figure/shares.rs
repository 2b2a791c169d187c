//! The shares of stick, slip and separation in the time of all contact nodes: a panel for every friction coefficient of
//! every group.

use super::colour_key::{self, KeyEntry, Swatch};
use super::panels::{self, SMALL};
use crate::analysis::JobRecord;
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area, Chart};
use crate::publish::plot::tooltip::{Shape, TooltipTarget};
use crate::publish::plot::{DrawError, FONT, MARGIN, TEXT, palette};
use crate::publish::value;
use crate::report::layout::{Group, Layout, Series};
use crate::report::row::JobRow;
use crate::report::tooltip::tooltip_text;
use plotters::chart::ChartBuilder;
use plotters::prelude::{BLACK, PathElement, Polygon, RGBColor, Rectangle, WHITE};
use plotters::style::text_anchor::HPos;
use plotters::style::{Color, TRANSPARENT};
use serde_json::Value;

/// The layers from bottom to top. The lightest one is in the middle, so that a reader can tell them apart without
/// colours.
const LAYERS: [(&str, RGBColor); 3] =
    [("stick", palette::BLUE), ("slip", RGBColor(0xE0, 0xE0, 0xE0)), ("separated", palette::VERMILLION)];
/// Height of a panel [px].
const PANEL: u32 = 426;
const HEAD: u32 = 72;

/// A job in a panel.
struct Column<'a> {
    row: &'a JobRow,
    at: usize,
    value: &'a Value,
    x: f64,
    /// Boundaries of the layers [%], from bottom to top.
    ends: [f64; 4],
}

/// Draws all panels of some groups.
pub(super) fn draw(layout: &Layout, groups: &[Group]) -> Result<String, FigureError> {
    let series: Vec<Option<&Series>> =
        if layout.series.is_empty() { vec![None] } else { layout.series.iter().map(Some).collect() };
    let panels = series.len() * groups.len();
    let columns = if panels <= 6 { panels.min(3) } else { 4 };
    let rows = panels.div_ceil(columns);
    let caption = if let [group] = groups { group.caption() } else { String::new() };
    let height = canvas::caption_height(&caption) + HEAD + rows as u32 * PANEL + MARGIN as u32 + 40;
    let has_tooltips = groups.iter().map(|group| group.jobs.len()).sum::<usize>() <= super::MAX_TOOLTIPS;
    canvas::sheet((canvas::WIDTH, height), |root| {
        let below = canvas::caption(root, &caption)?;
        let (head, below) = below.split_vertically(HEAD);
        let (below, foot) = below.split_vertically(rows as u32 * PANEL);
        let entries = LAYERS.map(|(label, colour)| KeyEntry {
            swatch: Swatch::filled(colour, ' '),
            label: format!("{label} [% of node-time]"),
        });
        colour_key::draw_row(&head, MARGIN + 90, 520, &entries)?;
        let parts = below.split_evenly((rows, columns));
        let mut targets = Vec::new();
        let each = groups.iter().flat_map(|group| series.iter().enumerate().map(move |own| (group, own)));
        for ((group, (index, series)), part) in each.zip(&parts) {
            let own = series.map(|series| layout.series_name(series));
            let of_group = Some(group.caption()).filter(|_| groups.len() > 1);
            let title = of_group.into_iter().chain(own).collect::<Vec<_>>().join(", ");
            targets.extend(draw_panel(part, layout, group, index, &title)?);
        }
        canvas::write(&foot, layout.axis_name(), (canvas::WIDTH as i32 / 2, 24), TEXT, HPos::Center)?;
        Ok(if has_tooltips { targets } else { Vec::new() })
    })
}

fn draw_panel(
    area: &Area,
    layout: &Layout,
    group: &Group,
    series: usize,
    title: &str,
) -> Result<Vec<TooltipTarget>, DrawError> {
    let x_axis = layout.x_axis();
    let columns = columns(layout, group, series, &x_axis);
    let width = area.dim_in_pixel().0 as i32;
    let names = if let Axis::Names(names) = &x_axis { names.len() } else { 1 };
    let x_text =
        canvas::fitting_size(x_axis.longest_label() + 1, (width - 120) / names.max(1) as i32).min(SMALL);
    let below = panels::title(area, title, width / 2 + 30)?;
    let mut chart = ChartBuilder::on(&below)
        .margin_right(24)
        .margin_left(12)
        .margin_bottom(8)
        .x_label_area_size(52)
        .y_label_area_size(76)
        .build_cartesian_2d(x_axis.clone(), Axis::Linear(0.0..100.0))?;
    draw_layers(&mut chart, &columns, &x_axis)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .light_line_style(TRANSPARENT)
        .axis_style(BLACK.stroke_width(2))
        .set_all_tick_mark_size(6)
        .x_label_style((FONT, x_text))
        .y_label_style((FONT, SMALL))
        .draw()?;
    canvas::frame(&chart)?;
    if columns.is_empty() {
        let inside = chart.plotting_area().strip_coord_spec();
        let (width, height) = inside.dim_in_pixel();
        let at = (width as i32 / 2, height as i32 / 2);
        canvas::write(&inside, "no results yet", at, SMALL, HPos::Center)?;
    }
    Ok(targets(&chart, &columns))
}

fn columns<'a>(layout: &Layout, group: &'a Group, series: usize, x_axis: &Axis) -> Vec<Column<'a>> {
    let mut columns: Vec<Column> = group
        .jobs
        .iter()
        .filter(|job| job.series == series)
        .filter_map(|job| {
            let value = &group.axis_values[job.axis_index];
            let ends = ends(job.row.record()?)?;
            Some(Column { row: job.row, at: job.axis_index, value, x: layout.position(x_axis, value)?, ends })
        })
        .collect();
    columns.sort_by_key(|column| column.at);
    columns
}

fn ends(record: &JobRecord) -> Option<[f64; 4]> {
    let JobRecord { stick_share, slip_share, separated_share, .. } = *record;
    let ends = [0.0, stick_share, stick_share + slip_share, stick_share + slip_share + separated_share];
    ends.iter().all(|end| end.is_finite()).then_some(ends.map(|end| (100.0 * end).clamp(0.0, 100.0)))
}

/// Draws areas between neighbours in the grid if the axis has numbers, and a bar for a job without neighbours.
fn draw_layers(chart: &mut Chart, columns: &[Column], x_axis: &Axis) -> Result<(), DrawError> {
    let are_joined = |a: &Column, b: &Column| !matches!(x_axis, Axis::Names(_)) && b.at <= a.at + 1;
    for stretch in columns.chunk_by(are_joined) {
        for (layer, (_, colour)) in LAYERS.iter().enumerate() {
            if stretch.len() == 1 {
                draw_bar(chart, &stretch[0], layer, *colour)?;
                continue;
            }
            let upper = stretch.iter().map(|column| (column.x, column.ends[layer + 1]));
            let lower = stretch.iter().rev().map(|column| (column.x, column.ends[layer]));
            let outline: Vec<(f64, f64)> = upper.chain(lower).collect();
            chart.draw_series(std::iter::once(Polygon::new(outline, colour.filled())))?;
        }
        if stretch.len() > 1 {
            // White lines mark the jobs; the areas between them are interpolated.
            for column in stretch {
                let line = [(column.x, 0.0), (column.x, 100.0)];
                chart
                    .draw_series(std::iter::once(PathElement::new(line, WHITE.mix(0.75).stroke_width(2))))?;
            }
        }
    }
    Ok(())
}

/// Half the width of a bar [px].
const HALF_BAR: i32 = 14;

fn draw_bar(chart: &Chart, column: &Column, layer: usize, colour: RGBColor) -> Result<(), DrawError> {
    let area = chart.plotting_area().strip_coord_spec();
    let (left, top) = area.get_base_pixel();
    let pixel = |end: f64| {
        let (x, y) = chart.backend_coord(&(column.x, end));
        (x - left, y - top)
    };
    let (upper, lower) = (pixel(column.ends[layer + 1]), pixel(column.ends[layer]));
    area.draw(&Rectangle::new(
        [(upper.0 - HALF_BAR, upper.1), (lower.0 + HALF_BAR, lower.1)],
        colour.filled(),
    ))
}

/// Tooltips of the columns. Their areas reach half-way to the neighbours, and no farther than 40 px.
fn targets(chart: &Chart, columns: &[Column]) -> Vec<TooltipTarget> {
    let inside = chart.plotting_area().strip_coord_spec();
    let left = inside.get_base_pixel().0;
    let right = left + inside.dim_in_pixel().0 as i32;
    let pixel = |column: &Column, end: f64| chart.backend_coord(&(column.x, end));
    let x: Vec<i32> = columns.iter().map(|column| pixel(column, 0.0).0).collect();
    let between = |a: i32, b: i32| (a + b) / 2;
    let target = |(index, column): (usize, &Column)| {
        let from = index.checked_sub(1).map_or(left, |before| between(x[before], x[index]));
        let to = x.get(index + 1).map_or(right, |after| between(x[index], *after));
        let reach = |edge: i32| edge.clamp(x[index] - 40, x[index] + 40);
        let percent = |layer: usize| value::number(column.ends[layer + 1] - column.ends[layer]);
        TooltipTarget {
            shape: Shape::Cell {
                from: (reach(from), pixel(column, 100.0).1),
                to: (reach(to).max(reach(from) + 1), pixel(column, 0.0).1),
            },
            title: tooltip_text(column.row),
            data: vec![
                ("job", column.row.job.clone()),
                ("x", value::text(column.value)),
                ("mu", value::number(column.row.mu)),
                ("stick", percent(0)),
                ("slip", percent(1)),
                ("separated", percent(2)),
            ],
        }
    };
    columns.iter().enumerate().map(target).collect()
}

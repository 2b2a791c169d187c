//! The shares of stick, slip and separation in the time of all contact nodes: a panel for every friction coefficient of
//! every group.

use super::places::{self, Place};
use crate::analysis::JobRecord;
use crate::publish::chart::palette::{BLUE, PAPER, VERMILLION};
use crate::publish::chart::{At, Axis, Cell, Chart, Entry, Layer, Panel, Pen, Rgb, Scale};
use crate::publish::value;
use crate::report::layout::{Group, Layout, Series};

/// The layers from bottom to top. The lightest one is in the middle, so that a reader can tell them apart without
/// colours.
const LAYERS: [(&str, Rgb); 3] =
    [("stick", BLUE), ("slip", Rgb(0xE0, 0xE0, 0xE0)), ("separated", VERMILLION)];
/// Half the widths of the bar of a job without neighbours, and of the part of the plot that has a job's tooltip, relative to the
/// plot.
const HALF_BAR: f64 = 0.03;
const HALF_TIP: f64 = 0.08;

/// A job in a panel.
struct Column<'a> {
    place: Place<'a>,
    /// Index of its value among those of the group.
    number: usize,
    /// Boundaries of the layers \[%\], from bottom to top.
    ends: [f64; 4],
}

/// All panels of some groups.
pub(super) fn draw(layout: &Layout, groups: &[Group]) -> Chart {
    let x = places::x_scale(layout).without_grid();
    let series: Vec<Option<&Series>> =
        if layout.series.is_empty() { vec![None] } else { layout.series.iter().map(Some).collect() };
    let mut panels = Vec::new();
    for group in groups {
        let places = places::places(layout, group, &x.axis);
        for (index, series) in series.iter().enumerate() {
            let own = series.map(|series| layout.series_name(series));
            let of_group = Some(group.caption()).filter(|_| groups.len() > 1);
            let title = of_group.into_iter().chain(own).collect::<Vec<_>>().join(", ");
            let columns: Vec<Column> = places
                .iter()
                .filter(|place| place.series == index)
                .filter_map(|own| column(group, own))
                .collect();
            panels.push(panel(&title, x.clone(), &columns));
        }
    }
    let title = if let [group] = groups { group.caption() } else { String::new() };
    let entry = |(label, colour): &(&str, Rgb)| Entry::cell(*colour, "", label);
    Chart { title, panels, legend: LAYERS.iter().rev().map(entry).collect(), ..Chart::default() }
}

fn column<'a>(group: &Group, place: &Place<'a>) -> Option<Column<'a>> {
    let JobRecord { stick_share, slip_share, separated_share, .. } = *place.row.record()?;
    let ends = [0.0, stick_share, stick_share + slip_share, stick_share + slip_share + separated_share];
    let number = group.axis_values.iter().position(|value| std::ptr::eq(value, place.at))?;
    let ends = ends.map(|end| (100.0 * end).clamp(0.0, 100.0));
    ends.iter().all(|end| end.is_finite()).then_some(Column { place: *place, number, ends })
}

/// Areas between neighbours in the grid if the axis has numbers, and a bar for a job without neighbours.
fn panel(title: &str, x: Scale, columns: &[Column]) -> Panel {
    let axis = x.axis.clone();
    let mut layers = Vec::new();
    let are_joined = |a: &Column, b: &Column| !matches!(axis, Axis::Names(_)) && b.number <= a.number + 1;
    for stretch in columns.chunk_by(are_joined) {
        for (layer, (_, colour)) in LAYERS.iter().enumerate() {
            let corners: Vec<At> = if let [alone] = stretch {
                let [left, right] =
                    [-HALF_BAR, HALF_BAR].map(|half| axis.value_at(axis.place(alone.place.x) + half));
                let [low, high] = [alone.ends[layer], alone.ends[layer + 1]];
                vec![(left, low), (right, low), (right, high), (left, high)]
            } else {
                let upper = stretch.iter().map(|column| (column.place.x, column.ends[layer + 1]));
                let lower = stretch.iter().rev().map(|column| (column.place.x, column.ends[layer]));
                upper.chain(lower).collect()
            };
            layers.push(Layer::Area(corners, *colour, 1.0));
        }
        if stretch.len() > 1 {
            // White lines mark the jobs; the areas between them are interpolated.
            layers.extend(stretch.iter().map(|column| Layer::Line {
                points: vec![(column.place.x, 0.0), (column.place.x, 100.0)],
                pen: Pen { cover: 0.75, ..Pen::solid(PAPER, 1.0) },
                right: false,
            }));
        }
    }
    if !columns.is_empty() {
        layers.push(Layer::Cells(tips(columns, &axis)));
    }
    let y = Scale::from_to("share of the node-time [%]", 0.0, 100.0).without_grid();
    Panel { layers, note: "no results yet".to_owned(), ..Panel::new(title, x, y) }
}

/// Parts of the plot with the tooltips of jobs. They reach half-way to the neighbours, and not too far.
fn tips(columns: &[Column], axis: &Axis) -> Vec<Cell> {
    let places: Vec<f64> = columns.iter().map(|column| axis.place(column.place.x)).collect();
    let cell = |(index, column): (usize, &Column)| {
        let at = places[index];
        let half_way = |other: Option<&f64>, edge: f64| other.map_or(edge, |other| (at + other) / 2.0);
        let before = index.checked_sub(1).and_then(|before| places.get(before));
        let from = half_way(before, 0.0).max(at - HALF_TIP);
        let to = half_way(places.get(index + 1), 1.0).min(at + HALF_TIP);
        let percent = |layer: usize| value::number(column.ends[layer + 1] - column.ends[layer]);
        let tip = column.place.tip([
            ("mu", value::number(column.place.row.parameters.mu())),
            ("stick", percent(0)),
            ("slip", percent(1)),
            ("separated", percent(2)),
        ]);
        Cell { x: [from, to].map(|at| axis.value_at(at)), y: [0.0, 100.0], tip: Some(tip), ..Cell::default() }
    };
    columns.iter().enumerate().map(cell).collect()
}

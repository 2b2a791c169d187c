//! The bifurcation diagram: over the speed, the range of the normal force and the amplitudes of the nodes. Steady sliding
//! has N/F = 1 and no amplitude; a limit cycle has two values of N/F and an amplitude.

use super::colour_key::{self, KeyEntry, Swatch};
use super::places::{self, Place, SeriesLook};
use crate::analysis::{JobRecord, Outcome};
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area, Chart, X_LABELS};
use crate::publish::plot::tooltip::{Shape, TooltipTarget};
use crate::publish::plot::{DASH, DrawError, FONT, GUIDE_WIDTH, MARGIN, TEXT};
use crate::publish::value;
use crate::report::layout::{Group, Layout};
use crate::report::tooltip::tooltip_text;
use plotters::chart::ChartBuilder;
use plotters::prelude::{Circle, DashedLineSeries, PathElement, Polygon, RGBColor, WHITE};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

const LEGEND_WIDTH: u32 = 420;
const Y_LABELS: u32 = 170;
/// Height of a panel without the labels of the abscissa [px].
const PANEL: u32 = 470;
/// Height of the key above a panel [px].
const KEY: u32 = 60;
const RADIUS: i32 = 8;
const GREY: RGBColor = RGBColor(0x50, 0x50, 0x50);
/// Micrometres per metre.
const MICRO: f64 = 1e6;

/// The shape of a marker.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shaped {
    Up,
    Down,
    Round,
    Square,
}

/// A figure of a record that a panel shows.
struct Quantity {
    name: &'static str,
    label: &'static str,
    shape: Shaped,
    /// Whether a line joins its points.
    joined: bool,
    of: fn(&JobRecord) -> Option<f64>,
}

/// A panel.
struct Panel {
    y_label: &'static str,
    quantities: &'static [Quantity],
    /// A level that steady sliding has.
    level: f64,
    /// The least height of the ordinate.
    least: f64,
}

fn peak_to_peak_um(record: &JobRecord, name: &str) -> Option<f64> {
    record.nodes.iter().find(|node| node.name == name).map(|node| node.y_peak_to_peak_m * MICRO)
}

const PANELS: [Panel; 3] = [
    Panel {
        y_label: "N/F",
        quantities: &[
            Quantity {
                name: "n_over_f_max",
                label: "largest N/F",
                shape: Shaped::Up,
                joined: true,
                of: |record| Some(record.n_over_f_max),
            },
            Quantity {
                name: "n_over_f_min",
                label: "smallest N/F",
                shape: Shaped::Down,
                joined: true,
                of: |record| Some(record.n_over_f_min),
            },
        ],
        level: 1.0,
        least: 0.1,
    },
    Panel {
        y_label: "range of y [µm]",
        quantities: &[
            Quantity {
                name: "front_centre_y_peak_to_peak_m",
                label: "front centre",
                shape: Shaped::Round,
                joined: true,
                of: |record| peak_to_peak_um(record, "front_centre"),
            },
            Quantity {
                name: "rear_centre_y_peak_to_peak_m",
                label: "rear centre",
                shape: Shaped::Square,
                joined: false,
                of: |record| peak_to_peak_um(record, "rear_centre"),
            },
        ],
        level: 0.0,
        least: 0.01,
    },
    Panel {
        y_label: "lift [µm]",
        quantities: &[Quantity {
            name: "lift_max_m",
            label: "largest gap",
            shape: Shaped::Round,
            joined: true,
            of: |record| Some(record.lift_max_m * MICRO),
        }],
        level: 0.0,
        least: 0.01,
    },
];

/// Draws the panels of a group one above the other, with a common abscissa.
pub(super) fn draw(layout: &Layout, group: &Group) -> Result<String, FigureError> {
    let caption = group.caption();
    let x_axis = layout.x_axis();
    let all = places::places(layout, group, &x_axis);
    let looks = places::series(layout);
    let panels = PANELS.len() as u32;
    let height = canvas::caption_height(&caption) + panels * PANEL + X_LABELS + MARGIN as u32;
    canvas::sheet((canvas::WIDTH, height), |root| {
        let below = canvas::caption(root, &caption)?;
        let (mut rest, right) = below.split_horizontally(canvas::WIDTH - LEGEND_WIDTH);
        let mut targets = Vec::new();
        for (number, panel) in PANELS.iter().enumerate() {
            let is_last = number + 1 == PANELS.len();
            let part = PANEL + if is_last { X_LABELS } else { 0 };
            let (here, after) = rest.split_vertically(part);
            let (key, here) = here.split_vertically(KEY);
            let x_label = is_last.then(|| layout.axis_name());
            draw_key(&key, panel)?;
            targets.extend(draw_panel(&here, panel, &x_axis, x_label, &all, &looks)?);
            rest = after;
        }
        let hollow = all.iter().any(is_hollow);
        draw_series_key(&right, places::series_title(layout), &looks, hollow)?;
        Ok(if places::has_tooltips(group) { targets } else { Vec::new() })
    })
}

/// Whether a job has a result and did not become periodic.
fn is_hollow(place: &Place) -> bool {
    place.row.record().is_some_and(|record| record.outcome == Outcome::NotPeriodic)
}

/// The value of a quantity for a job that has one.
fn value_of(quantity: &Quantity, place: &Place) -> Option<f64> {
    (quantity.of)(place.row.record()?).filter(|y| y.is_finite())
}

fn draw_panel(
    area: &Area,
    panel: &Panel,
    x_axis: &Axis,
    x_label: Option<&str>,
    all: &[Place],
    looks: &[SeriesLook],
) -> Result<Vec<TooltipTarget>, DrawError> {
    let values = || {
        let of = |quantity| all.iter().filter_map(move |place| value_of(quantity, place));
        panel.quantities.iter().flat_map(of)
    };
    let is_empty = values().next().is_none();
    let (low, high) = values().fold((panel.level, panel.level), |(low, high), y| (low.min(y), high.max(y)));
    // Without values there are no ticks, because they would suggest a scale.
    let y_axis = if is_empty { Axis::Names(Vec::new()) } else { Axis::spanning(low, high, panel.least) };
    let names = if let Axis::Names(names) = x_axis { names.len().max(1) } else { 1 };
    let room = (canvas::WIDTH - LEGEND_WIDTH - Y_LABELS) as i32 / names as i32;
    let x_text = canvas::fitting_size(x_axis.longest_label() + 1, room);
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .margin_top(4)
        .margin_bottom(4)
        .x_label_area_size(if x_label.is_some() { X_LABELS } else { 0 })
        .y_label_area_size(Y_LABELS)
        .build_cartesian_2d(x_axis.clone(), y_axis)?;
    let mut mesh = canvas::mesh(&mut chart);
    mesh.x_label_style((FONT, x_text)).y_desc(panel.y_label).disable_y_mesh();
    if let Some(label) = x_label {
        mesh.x_desc(label);
    }
    mesh.draw()?;
    canvas::whole_frame(&chart)?;
    if is_empty {
        let inside = chart.plotting_area().strip_coord_spec();
        let (width, height) = inside.dim_in_pixel();
        let at = (width as i32 / 2, height as i32 / 2);
        canvas::write(&inside, "no results yet", at, TEXT, HPos::Center)?;
        return Ok(Vec::new());
    }
    let across = chart.x_range();
    let level = [(across.start, panel.level), (across.end, panel.level)];
    chart.draw_series(DashedLineSeries::new(level, DASH, DASH, GREY.stroke_width(GUIDE_WIDTH)))?;
    for own in all.chunk_by(|a, b| a.series == b.series) {
        draw_lines(&mut chart, panel, own, looks[own[0].series].colour)?;
    }
    let mut targets = Vec::new();
    for place in all {
        for quantity in panel.quantities {
            let Some(y) = value_of(quantity, place) else { continue };
            let at = chart.backend_coord(&(place.x, y));
            let (left, top) = area.get_base_pixel();
            let colour = looks[place.series].colour;
            draw_marker(area, (at.0 - left, at.1 - top), quantity.shape, is_hollow(place), colour)?;
            targets.push(TooltipTarget {
                shape: Shape::Around { at, radius: 2 * RADIUS },
                title: tooltip_text(place.row),
                data: vec![
                    ("job", place.row.job.clone()),
                    ("x", value::text(place.at)),
                    ("y", value::number(y)),
                    ("kind", quantity.name.to_owned()),
                ],
            });
        }
    }
    Ok(targets)
}

/// Lines through the quantities of one series.
fn draw_lines(chart: &mut Chart, panel: &Panel, own: &[Place], colour: RGBColor) -> Result<(), DrawError> {
    for quantity in panel.quantities.iter().filter(|quantity| quantity.joined) {
        // A job without a result interrupts the line.
        let stretches = own.split(|place| value_of(quantity, place).is_none());
        for stretch in stretches.filter(|stretch| stretch.len() > 1) {
            let points: Vec<(f64, f64)> =
                stretch.iter().filter_map(|place| Some((place.x, value_of(quantity, place)?))).collect();
            chart.draw_series([PathElement::new(points, colour.mix(0.7).stroke_width(3))])?;
        }
    }
    Ok(())
}

fn draw_marker(
    area: &Area,
    (x, y): (i32, i32),
    shape: Shaped,
    hollow: bool,
    colour: RGBColor,
) -> Result<(), DrawError> {
    let corners = |reach: i32| -> Vec<(i32, i32)> {
        match shape {
            Shaped::Up => vec![(x, y - reach), (x + reach, y + reach), (x - reach, y + reach)],
            Shaped::Down => vec![(x, y + reach), (x + reach, y - reach), (x - reach, y - reach)],
            Shaped::Square => vec![
                (x - reach, y - reach),
                (x + reach, y - reach),
                (x + reach, y + reach),
                (x - reach, y + reach),
            ],
            Shaped::Round => Vec::new(),
        }
    };
    let fill = |reach: i32, colour: RGBColor| {
        if shape == Shaped::Round {
            area.draw(&Circle::new((x, y), reach, colour.filled()))
        } else {
            area.draw(&Polygon::new(corners(reach), colour))
        }
    };
    fill(RADIUS, colour)?;
    if hollow { fill(RADIUS - 3, WHITE) } else { Ok(()) }
}

/// The markers of a panel's quantities.
fn draw_key(area: &Area, panel: &Panel) -> Result<(), DrawError> {
    let symbol = |shape| match shape {
        Shaped::Up => '▲',
        Shaped::Down => '▼',
        Shaped::Round => '●',
        Shaped::Square => '■',
    };
    let entry = |quantity: &Quantity| KeyEntry {
        swatch: Swatch::coloured(GREY, symbol(quantity.shape)),
        label: quantity.label.to_owned(),
    };
    let entries: Vec<KeyEntry> = panel.quantities.iter().map(entry).collect();
    colour_key::draw_row(area, MARGIN + Y_LABELS as i32, 360, &entries)
}

/// The colours, and the meaning of hollow markers if there are some.
fn draw_series_key(
    area: &Area,
    title: &str,
    looks: &[SeriesLook],
    has_hollow: bool,
) -> Result<(), DrawError> {
    let top = MARGIN + KEY as i32;
    canvas::write(area, title, (0, top - 24), TEXT - 6, HPos::Left)?;
    let series = looks
        .iter()
        .map(|look| KeyEntry { swatch: Swatch::filled(look.colour, ' '), label: look.name.clone() });
    let hollow = has_hollow
        .then(|| KeyEntry {
            swatch: Swatch::coloured(GREY, '○'), label: "hollow: not periodic".to_owned()
        });
    colour_key::draw_column(area, top, &series.chain(hollow).collect::<Vec<_>>())
}

//! The drawing: axes, guides, curves, error bars, markers.

use super::data::{self, Curve, Point};
use super::{Plot, legend, marker};
use crate::publish::plot::axis::Axis;
use crate::publish::plot::{CURVE_WIDTH, DASH, FONT, FigureError, GRID, GUIDE_WIDTH, MARGIN, TEXT, palette};
use crate::publish::value::OMEGA;
use crate::report::layout::{Group, Layout};
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::prelude::{
    BLACK, DashedLineSeries, DrawingArea, IntoDrawingArea, LineSeries, PathElement, RGBColor, SVGBackend,
    Text, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, IntoFont, TextStyle};

// The backend rounds to whole pixels, so the drawing is made at twice the size it is shown at.
const SIZE: (u32, u32) = (1800, 1120);
const SHOWN: (u32, u32) = (900, 560);
const LEGEND_WIDTH: u32 = 420;
const CAPTION_HEIGHT: u32 = 64;
const X_LABELS: u32 = 104;
const Y_LABELS: u32 = 150;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

/// Draws the figure of one group as SVG.
pub(super) fn draw(layout: &Layout, group: &Group, plot: Plot) -> Result<String, FigureError> {
    let x_axis = Axis::across(&group.axis_values, layout.axis == OMEGA);
    let curves = data::curves(layout, group, plot, &x_axis);
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let caption = group.caption();
        let below = if caption.is_empty() { root.clone() } else { draw_caption(&root, &caption)? };
        let (left, right) = below.split_horizontally(SIZE.0 - LEGEND_WIDTH);
        draw_plot(&left, x_axis, x_label(layout), &curves, plot)?;
        legend::draw(&right, &curves, plot)?;
        root.present()?;
    }
    let size = |(width, height): (u32, u32)| format!("width=\"{width}\" height=\"{height}\"");
    Ok(svg.replacen(&size(SIZE), &size(SHOWN), 1))
}

fn x_label<'a>(layout: &Layout<'a>) -> &'a str {
    if layout.axis == OMEGA { "disk speed ω [rpm]" } else { layout.axis }
}

/// Draws the caption on top and returns what is left below.
fn draw_caption<'a>(root: &Area<'a>, caption: &str) -> Result<Area<'a>, FigureError> {
    let (top, below) = root.split_vertically(CAPTION_HEIGHT);
    // XML has no place for control characters.
    let caption: String = caption.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let room = SIZE.0 as i32 - 2 * MARGIN;
    let style = TextStyle::from((FONT, fitting(caption.chars().count(), room)).into_font());
    let at = (SIZE.0 as i32 / 2, CAPTION_HEIGHT as i32 * 2 / 3);
    top.draw(&Text::new(caption, at, style.pos(Pos::new(HPos::Center, VPos::Center))))?;
    Ok(below)
}

/// The size at which text of this length stays within `room`: a character is about half as wide as high.
fn fitting(characters: usize, room: i32) -> i32 {
    (room * 2 / characters.max(1) as i32).clamp(8, TEXT)
}

fn draw_plot(
    area: &Area,
    x_axis: Axis,
    x_label: &str,
    curves: &[Curve],
    plot: Plot,
) -> Result<(), FigureError> {
    let y_axis = y_axis(curves, plot);
    let empty = curves.iter().all(|curve| curve.points.is_empty());
    let tick_room = (SIZE.0 - LEGEND_WIDTH - Y_LABELS) as i32
        / if let Axis::Names(names) = &x_axis { names.len().max(1) as i32 } else { 1 };
    let x_text = fitting(x_axis.longest_label() + 1, tick_room);

    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .x_label_area_size(X_LABELS)
        .y_label_area_size(Y_LABELS)
        .build_cartesian_2d(x_axis, y_axis)?;
    let mut mesh = chart.configure_mesh();
    mesh.bold_line_style(GRID.stroke_width(2))
        .light_line_style(plotters::style::TRANSPARENT)
        .axis_style(BLACK.stroke_width(2))
        .set_all_tick_mark_size(8)
        .x_label_style((FONT, x_text))
        .y_label_style((FONT, TEXT))
        .axis_desc_style((FONT, TEXT + 4))
        .x_desc(x_label)
        .y_desc(match plot {
            Plot::MuStar => "macroscopic friction coefficient μ*",
            Plot::Frequency => "frequency [Hz]",
        });
    if plot == Plot::MuStar {
        // The guides are the horizontal lines here; a grid would run along some of them.
        mesh.disable_y_mesh();
    }
    mesh.draw()?;
    draw_frame(&mut chart)?;

    for (index, curve) in curves.iter().enumerate() {
        draw_lines(&mut chart, curve, plot, palette::colour(index, curves.len()))?;
    }
    for (index, curve) in curves.iter().enumerate() {
        for point in &curve.points {
            draw_point(area, &chart, point, palette::colour(index, curves.len()))?;
        }
    }
    if empty { draw_note(&chart, plot) } else { Ok(()) }
}

fn y_axis(curves: &[Curve], plot: Plot) -> Axis {
    let ends = curves.iter().flat_map(|curve| &curve.points).flat_map(|p| [p.y - p.error, p.y + p.error]);
    let guides = curves.iter().map(|curve| curve.mu).filter(|_| plot == Plot::MuStar);
    let (low, high) = ends
        .chain(guides)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    if low > high {
        // Nothing to measure: no ticks that would suggest a scale.
        return Axis::Names(Vec::new());
    }
    // Differences smaller than this are not to fill the height.
    let least = match plot {
        Plot::MuStar => 0.02,
        Plot::Frequency => (0.05 * high).max(1.0),
    };
    Axis::spanning(low, high, least)
}

/// Closes the frame that the two axes begin.
fn draw_frame(chart: &mut Chart) -> Result<(), FigureError> {
    let area = chart.plotting_area().strip_coord_spec();
    let (right, bottom) = (area.dim_in_pixel().0 as i32 - 1, area.dim_in_pixel().1 as i32 - 1);
    area.draw(&PathElement::new([(0, 0), (right, 0), (right, bottom)], BLACK.stroke_width(2)))
}

fn draw_lines(chart: &mut Chart, curve: &Curve, plot: Plot, colour: RGBColor) -> Result<(), FigureError> {
    if plot == Plot::MuStar {
        let across = chart.x_range();
        let ends = [(across.start, curve.mu), (across.end, curve.mu)];
        let style = colour.mix(0.8).stroke_width(GUIDE_WIDTH);
        chart.draw_series(DashedLineSeries::new(ends, DASH, DASH, style))?;
    }
    for stretch in &curve.stretches {
        let style = colour.stroke_width(CURVE_WIDTH);
        chart.draw_series(LineSeries::new(stretch.iter().copied(), style))?;
    }
    Ok(())
}

fn draw_point(area: &Area, chart: &Chart, point: &Point, colour: RGBColor) -> Result<(), FigureError> {
    let (left, top) = area.get_base_pixel();
    let pixel = |y: f64| {
        let (x, y) = chart.backend_coord(&(point.x, y));
        (x - left, y - top)
    };
    let at = pixel(point.y);
    let (above, below) = (pixel(point.y + point.error), pixel(point.y - point.error));
    if below.1 - at.1 > marker::RADIUS {
        let line = |ends: [(i32, i32); 2]| area.draw(&PathElement::new(ends, colour.stroke_width(2)));
        line([above, below])?;
        for (x, y) in [above, below] {
            line([(x - marker::RADIUS, y), (x + marker::RADIUS, y)])?;
        }
    }
    marker::draw(area, at, point.regime, point.periodic, colour)
}

fn draw_note(chart: &Chart, plot: Plot) -> Result<(), FigureError> {
    let area = chart.plotting_area().strip_coord_spec();
    let (width, height) = area.dim_in_pixel();
    let style = TextStyle::from((FONT, TEXT).into_font()).pos(Pos::new(HPos::Center, VPos::Center));
    let note = match plot {
        Plot::MuStar => "no results yet",
        Plot::Frequency => "no frequencies: no results yet, or all of them stable",
    };
    area.draw(&Text::new(note, (width as i32 / 2, height as i32 / 3), style))
}

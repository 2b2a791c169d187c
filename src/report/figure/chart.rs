//! The drawing of curves: axes, guide lines, curves, error bars, markers.

use super::data::{self, Curve, Ordinate, Point};
use super::{legend, marker};
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area, Chart, X_LABELS};
use crate::publish::plot::tooltip::{Shape, TooltipTarget};
use crate::publish::plot::{CURVE_WIDTH, DASH, DrawError, FONT, GUIDE_WIDTH, MARGIN, TEXT, palette};
use crate::publish::value;
use crate::report::layout::{Group, Layout};
use crate::report::parameters::OMEGA;
use crate::report::tooltip::tooltip_text;
use plotters::chart::ChartBuilder;
use plotters::prelude::{DashedLineSeries, LineSeries, PathElement, RGBColor};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

const LEGEND_WIDTH: u32 = 420;
const Y_LABELS: u32 = 150;
/// Radius of the tooltip area around a marker [px].
const TOOLTIP_RADIUS: i32 = 20;

/// Draws the figure of one group as SVG.
pub(super) fn draw(layout: &Layout, group: &Group, plot: Ordinate) -> Result<String, FigureError> {
    let x_axis = Axis::for_values(&group.axis_values, layout.axis == OMEGA);
    let curves = data::curves(layout, group, plot, &x_axis);
    canvas::sheet((canvas::WIDTH, canvas::HEIGHT), |root| {
        let below = canvas::caption(root, &group.caption())?;
        let (left, right) = below.split_horizontally(canvas::WIDTH - LEGEND_WIDTH);
        let targets = draw_plot(&left, x_axis, layout.axis_name(), &curves, plot)?;
        legend::draw(&right, &curves, plot)?;
        Ok(if group.has_tooltips() { targets } else { Vec::new() })
    })
}

fn draw_plot(
    area: &Area,
    x_axis: Axis,
    x_label: &str,
    curves: &[Curve],
    plot: Ordinate,
) -> Result<Vec<TooltipTarget>, DrawError> {
    let y_axis = y_axis(curves, plot);
    let empty = curves.iter().all(|curve| curve.points.is_empty());
    let tick_room = (canvas::WIDTH - LEGEND_WIDTH - Y_LABELS) as i32
        / if let Axis::Names(names) = &x_axis { names.len().max(1) as i32 } else { 1 };
    let x_text = canvas::fitting_size(x_axis.longest_label() + 1, tick_room);

    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .x_label_area_size(X_LABELS)
        .y_label_area_size(Y_LABELS)
        .build_cartesian_2d(x_axis, y_axis)?;
    let mut mesh = canvas::mesh(&mut chart);
    mesh.x_label_style((FONT, x_text)).x_desc(x_label).y_desc(match plot {
        Ordinate::MuStar => "macroscopic friction coefficient μ*",
        Ordinate::Frequency => "frequency [Hz]",
    });
    if plot == Ordinate::MuStar {
        // The guide lines are horizontal; lines of a grid could cover them.
        mesh.disable_y_mesh();
    }
    mesh.draw()?;
    canvas::frame(&chart)?;

    for (index, curve) in curves.iter().enumerate() {
        draw_lines(&mut chart, curve, plot, palette::colour(index, curves.len()))?;
    }
    let mut targets = Vec::new();
    for (index, curve) in curves.iter().enumerate() {
        for point in &curve.points {
            draw_point(area, &chart, point, palette::colour(index, curves.len()))?;
            targets.push(target(&chart, point));
        }
    }
    if empty {
        draw_note(&chart, plot)?;
    }
    Ok(targets)
}

fn target(chart: &Chart, point: &Point) -> TooltipTarget {
    TooltipTarget {
        shape: Shape::Around { at: chart.backend_coord(&(point.x, point.y)), radius: TOOLTIP_RADIUS },
        title: tooltip_text(point.row),
        data: vec![
            ("job", point.row.job.clone()),
            ("x", value::text(point.at)),
            ("y", value::number(point.y)),
            ("mu", value::number(point.row.mu)),
        ],
    }
}

fn y_axis(curves: &[Curve], plot: Ordinate) -> Axis {
    let ends = curves.iter().flat_map(|curve| &curve.points).flat_map(|p| [p.y - p.error, p.y + p.error]);
    let guides = curves.iter().map(|curve| curve.mu).filter(|_| plot == Ordinate::MuStar);
    let (low, high) = ends
        .chain(guides)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    if low > high {
        // Without values there are no ticks, because they would suggest a scale.
        return Axis::Names(Vec::new());
    }
    // Smaller differences must not fill the height of the figure.
    let min_range = match plot {
        Ordinate::MuStar => 0.02,
        Ordinate::Frequency => (0.05 * high).max(1.0),
    };
    Axis::spanning(low, high, min_range)
}

fn draw_lines(chart: &mut Chart, curve: &Curve, plot: Ordinate, colour: RGBColor) -> Result<(), DrawError> {
    if plot == Ordinate::MuStar {
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

fn draw_point(area: &Area, chart: &Chart, point: &Point, colour: RGBColor) -> Result<(), DrawError> {
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

fn draw_note(chart: &Chart, plot: Ordinate) -> Result<(), DrawError> {
    let area = chart.plotting_area().strip_coord_spec();
    let (width, height) = area.dim_in_pixel();
    let note = match plot {
        Ordinate::MuStar => "no results yet",
        Ordinate::Frequency => "no frequencies: no results yet, or all of them stable",
    };
    canvas::write(&area, note, (width as i32 / 2, height as i32 / 3), TEXT, HPos::Center)
}

//! The drawing of curves: axes, guide lines, curves, error bars, markers, in one panel for each group.

use super::data::{self, Curve, Point};
use super::panels::{self, SMALL, TITLE};
use super::style::{SourceStyle, colour};
use super::{band, legend, marker};
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area, Chart, X_LABELS};
use crate::publish::plot::tooltip::{Shape, TooltipTarget};
use crate::publish::plot::{CURVE_WIDTH, DASH, DrawError, FONT, GUIDE_WIDTH, MARGIN, TEXT};
use crate::publish::value;
use crate::report::layout::{Group, Layout};
use crate::report::scalar::{FREQUENCY, MU_STAR, Scalar};
use crate::report::tooltip::tooltip_text;
use plotters::chart::ChartBuilder;
use plotters::prelude::{DashedLineSeries, LineSeries, PathElement, RGBColor};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

const LEGEND_WIDTH: u32 = 420;
const Y_LABELS: u32 = 150;
/// Radius of the tooltip area around a marker [px].
const TOOLTIP_RADIUS: i32 = 20;
/// Height of a panel among others [px].
const PANEL: u32 = 470;
/// Height of the strips with the names of the axes, if there are several panels [px].
const NAMES: u32 = 64;
/// Colour of a guide line that belongs to all curves.
const GREY: RGBColor = RGBColor(0x50, 0x50, 0x50);

/// The content of one panel.
struct Panel<'a> {
    caption: String,
    curves: Vec<Curve<'a>>,
    /// Friction coefficients with the colour of their guide line.
    guides: Vec<(f64, RGBColor)>,
}

/// What all panels of a figure share.
struct Frame<'a> {
    layout: &'a Layout<'a>,
    scalar: &'a Scalar,
    x_axis: Axis,
    y_axis: Axis,
}

/// Draws the figure of some groups as SVG: a panel for each, with the same axes and colours in all panels.
pub(super) fn draw(layout: &Layout, groups: &[Group], scalar: &Scalar) -> Result<String, FigureError> {
    let x_axis = layout.x_axis();
    let panel = |group| Panel {
        caption: Group::caption(group),
        curves: data::curves(layout, group, scalar, &x_axis),
        guides: guides(layout, group, scalar),
    };
    let panels: Vec<Panel> = groups.iter().map(panel).collect();
    let frame = Frame { layout, scalar, y_axis: y_axis(&panels, scalar), x_axis };
    let curves = || panels.iter().flat_map(|panel| &panel.curves);
    let is_outside = curves().flat_map(|curve| &curve.points).any(|point| frame.shown(point) != point.y);
    let has_tooltips = groups.iter().map(|group| group.jobs.len()).sum::<usize>() <= super::MAX_TOOLTIPS;
    let columns = panels::columns(panels.len());
    let rows = panels.len().div_ceil(columns) as u32;
    let height = if panels.len() == 1 {
        canvas::HEIGHT
    } else {
        (2 * NAMES + rows * (PANEL + TITLE)).max(canvas::HEIGHT * 2 / 3)
    };
    canvas::sheet((canvas::WIDTH, height), |root| {
        let targets = match panels.as_slice() {
            [panel] => {
                let below = canvas::caption(root, &panel.caption)?;
                let (left, right) = below.split_horizontally(canvas::WIDTH - LEGEND_WIDTH);
                let targets = draw_alone(&left, &frame, panel)?;
                legend::draw(&right, layout, curves(), scalar, is_outside)?;
                targets
            }
            several => {
                let (left, right) = root.split_horizontally(canvas::WIDTH - LEGEND_WIDTH);
                let targets = draw_several(&left, &frame, several, columns)?;
                legend::draw(&right, layout, curves(), scalar, is_outside)?;
                targets
            }
        };
        Ok(if has_tooltips { targets } else { Vec::new() })
    })
}

fn guides(layout: &Layout, group: &Group, scalar: &Scalar) -> Vec<(f64, RGBColor)> {
    if scalar != *MU_STAR {
        return Vec::new();
    }
    let colour = |series: Option<usize>| series.map_or(GREY, |index| colour(layout, &layout.series[index]));
    data::guides(layout, group).into_iter().map(|(mu, series)| (mu, colour(series))).collect()
}

/// Draws the only panel of a figure, with the names of both axes.
fn draw_alone(area: &Area, frame: &Frame, panel: &Panel) -> Result<Vec<TooltipTarget>, DrawError> {
    let x_text = frame.x_text(canvas::WIDTH - LEGEND_WIDTH - Y_LABELS, TEXT);
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .x_label_area_size(X_LABELS)
        .y_label_area_size(Y_LABELS)
        .build_cartesian_2d(frame.x_axis.clone(), frame.y_axis.clone())?;
    let title = frame.scalar.title();
    let mut mesh = canvas::mesh(&mut chart);
    mesh.x_label_style((FONT, x_text)).x_desc(frame.layout.axis_name()).y_desc(title.as_str());
    if frame.scalar == *MU_STAR {
        // The guide lines are horizontal; lines of a grid could cover them.
        mesh.disable_y_mesh();
    }
    mesh.draw()?;
    frame.fill(area, &mut chart, panel)
}

/// Draws panels in `columns`, with the names of the axes above and below all of them.
fn draw_several(
    area: &Area,
    frame: &Frame,
    panels: &[Panel],
    columns: usize,
) -> Result<Vec<TooltipTarget>, DrawError> {
    let (head, below) = area.split_vertically(NAMES);
    canvas::write(&head, &frame.scalar.title(), (MARGIN, NAMES as i32 / 2), TEXT, HPos::Left)?;
    let (middle, foot) = below.split_vertically(below.dim_in_pixel().1 - NAMES);
    let width = area.dim_in_pixel().0 as i32;
    canvas::write(&foot, frame.layout.axis_name(), (width / 2, NAMES as i32 / 3), TEXT, HPos::Center)?;
    let mut targets = Vec::new();
    for (panel, part) in panels.iter().zip(middle.split_evenly((panels.len().div_ceil(columns), columns))) {
        let part_width = part.dim_in_pixel().0;
        let below = panels::title(&part, &panel.caption, part_width as i32 / 2 + 40)?;
        let mut chart = ChartBuilder::on(&below)
            .margin_right(20)
            .margin_left(8)
            .margin_bottom(8)
            .x_label_area_size(52)
            .y_label_area_size(100)
            .build_cartesian_2d(frame.x_axis.clone(), frame.y_axis.clone())?;
        let mut mesh = canvas::mesh(&mut chart);
        mesh.x_label_style((FONT, frame.x_text(part_width - 130, SMALL))).y_label_style((FONT, SMALL));
        if frame.scalar == *MU_STAR {
            mesh.disable_y_mesh();
        }
        mesh.draw()?;
        targets.extend(frame.fill(&below, &mut chart, panel)?);
    }
    Ok(targets)
}

impl Frame<'_> {
    /// The size of the ticks' labels below `width` pixels.
    fn x_text(&self, width: u32, largest: i32) -> i32 {
        let ticks = self.x_axis.labelled_ticks().len().max(1);
        let names = if let Axis::Names(_) = self.x_axis { ticks } else { ticks.min(10) };
        canvas::fitting_size(self.x_axis.longest_label() + 1, width as i32 / names as i32).min(largest)
    }

    /// Draws the content of a panel between its axes.
    fn fill(&self, area: &Area, chart: &mut Chart, panel: &Panel) -> Result<Vec<TooltipTarget>, DrawError> {
        canvas::frame(chart)?;
        for (mu, colour) in &panel.guides {
            let across = chart.x_range();
            let ends = [(across.start, *mu), (across.end, *mu)];
            let style = colour.mix(0.8).stroke_width(GUIDE_WIDTH);
            chart.draw_series(DashedLineSeries::new(ends, DASH, DASH, style))?;
        }
        for curve in &panel.curves {
            band::draw(chart, curve, self.scalar, colour(self.layout, curve.series))?;
        }
        for curve in &panel.curves {
            self.draw_lines(chart, curve)?;
        }
        let mut targets = Vec::new();
        for curve in &panel.curves {
            for point in &curve.points {
                let shown = self.shown(point);
                self.draw_point(area, chart, curve, point, shown)?;
                targets.push(target(chart, point, shown));
            }
        }
        if panel.curves.iter().all(|curve| curve.points.is_empty()) {
            draw_note(chart, self.scalar)?;
        }
        Ok(targets)
    }

    /// The height at which a point is drawn: its value, or the edge of the axis if it is beyond.
    fn shown(&self, point: &Point) -> f64 {
        match &self.y_axis {
            Axis::Linear(range) | Axis::Log(range) | Axis::Signed { range, .. } => {
                point.y.clamp(range.start, range.end)
            }
            Axis::Names(_) => point.y,
        }
    }

    fn draw_lines(&self, chart: &mut Chart, curve: &Curve) -> Result<(), DrawError> {
        let style = colour(self.layout, curve.series).stroke_width(CURVE_WIDTH);
        let dash = SourceStyle::of(self.layout, curve.series.source).dash();
        for stretch in &curve.stretches {
            match dash {
                None => {
                    chart.draw_series(LineSeries::new(stretch.iter().copied(), style))?;
                }
                Some((line, gap)) => {
                    let points = stretch.iter().copied();
                    chart.draw_series(DashedLineSeries::new(points, line as i32, gap as i32, style))?;
                }
            }
        }
        Ok(())
    }

    fn draw_point(
        &self,
        area: &Area,
        chart: &Chart,
        curve: &Curve,
        point: &Point,
        shown: f64,
    ) -> Result<(), DrawError> {
        let colour = colour(self.layout, curve.series);
        let (left, top) = area.get_base_pixel();
        let pixel = |y: f64| {
            let (x, y) = chart.backend_coord(&(point.x, y));
            (x - left, y - top)
        };
        let at = pixel(shown);
        if shown != point.y {
            marker::draw_outside(area, at, point.y > shown, colour)?;
        } else if point.error > 0.0 {
            let (above, below) = (pixel(point.y + point.error), pixel(point.y - point.error));
            if below.1 - at.1 > marker::RADIUS || point.regime.is_none() {
                let line = |ends: [(i32, i32); 2]| area.draw(&PathElement::new(ends, colour.stroke_width(2)));
                line([above, below])?;
                for (x, y) in [above, below] {
                    line([(x - marker::RADIUS, y), (x + marker::RADIUS, y)])?;
                }
            }
        }
        let Some(regime) = point.regime else {
            let style = SourceStyle::of(self.layout, curve.series.source);
            return marker::draw_measured(area, at, style, colour);
        };
        marker::draw(area, at, regime, point.periodic, colour)
    }
}

fn target(chart: &Chart, point: &Point, shown: f64) -> TooltipTarget {
    TooltipTarget {
        shape: Shape::Around { at: chart.backend_coord(&(point.x, shown)), radius: TOOLTIP_RADIUS },
        title: tooltip_text(point.row),
        data: vec![
            ("job", point.row.job.clone()),
            ("x", value::text(point.at)),
            ("y", value::number(point.y)),
            ("mu", if point.row.mu.is_nan() { String::new() } else { value::number(point.row.mu) }),
        ],
    }
}

/// The range of the settled results with their errors; of all results, if none is settled.
fn y_axis(panels: &[Panel], scalar: &Scalar) -> Axis {
    let points = || panels.iter().flat_map(|panel| &panel.curves).flat_map(|curve| &curve.points);
    let any_settled = points().any(|point| point.settled);
    let counted = || points().filter(move |point| point.settled || !any_settled);
    let ends = counted().flat_map(|point| [point.y - point.error, point.y + point.error]);
    let bands = counted().flat_map(|point| band::ends(point, scalar));
    let guides = panels.iter().flat_map(|panel| &panel.guides).map(|(mu, _)| *mu);
    let (low, high) = ends
        .chain(bands)
        .chain(guides)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    if low > high {
        // Without values there are no ticks, because they would suggest a scale.
        return Axis::Names(Vec::new());
    }
    // Smaller differences must not fill the height of the figure.
    let least = if scalar == *MU_STAR {
        0.02
    } else if scalar == *FREQUENCY {
        (0.05 * high).max(1.0)
    } else if high.abs().max(low.abs()) > 0.0 {
        0.05 * high.abs().max(low.abs())
    } else {
        1.0
    };
    Axis::spanning(low, high, least)
}

fn draw_note(chart: &Chart, scalar: &Scalar) -> Result<(), DrawError> {
    let area = chart.plotting_area().strip_coord_spec();
    let (width, height) = area.dim_in_pixel();
    let note = if scalar == *FREQUENCY {
        "no frequencies: no results yet, or all of them stable"
    } else {
        "no results yet"
    };
    let size = canvas::fitting_size(note.chars().count(), width as i32 - MARGIN);
    canvas::write(&area, note, (width as i32 / 2, height as i32 / 3), size, HPos::Center)
}

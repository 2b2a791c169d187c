//! Panels one above the other: curves over bands, marks and levels, with a legend beside each.

use super::axis::Axis;
use super::canvas::{self, Area, Chart, WIDTH, write};
use super::{CURVE_WIDTH, DASH, DrawError, FONT, GUIDE_WIDTH, MARGIN, TEXT};
use crate::publish::error::FigureError;
use crate::publish::value;
use plotters::chart::{ChartBuilder, LabelAreaPosition};
use plotters::prelude::{BLACK, Circle, DashedLineSeries, PathElement, RGBColor, Rectangle};
use plotters::style::text_anchor::HPos;
use plotters::style::{Color, ShapeStyle};

const LEGEND_WIDTH: u32 = 400;
const TITLE_HEIGHT: u32 = 60;
const X_LABELS: u32 = 100;
const Y_LABELS: u32 = 140;
/// Distance of the lines of a legend [px].
const PITCH: i32 = 42;
/// Length of the line in an entry of a legend [px].
const SAMPLE: i32 = 48;
const DOT: i32 = 7;
/// Height of a row of mark labels [px]. There are two rows, because marks may be close to each other.
const MARK_ROW: i32 = 38;

/// An axis with its label.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// The quantity and its unit.
    pub label: String,
    /// The axis.
    pub axis: Axis,
}

impl Scale {
    /// A linear scale around the finite ones of the values, at least `least` wide.
    pub fn spanning(label: &str, values: impl Iterator<Item = f64>, least: f64) -> Self {
        let (low, high) = values
            .filter(|x| x.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let axis = if low <= high { Axis::spanning(low, high, least) } else { Axis::Names(Vec::new()) };
        Self { label: label.to_owned(), axis }
    }

    /// A linear scale from `low` to `high` without a margin.
    pub fn from_to(label: &str, low: f64, high: f64) -> Self {
        Self { label: label.to_owned(), axis: Axis::Linear(low..high) }
    }
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// Joined points. A number that is not finite interrupts the line.
    Line,
    /// As `Line`, but thin.
    Fine,
    /// Points that are not joined.
    Dots,
}

/// A curve or a set of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Its name in the legend; none if it has no entry there.
    pub label: Option<String>,
    /// Its colour.
    pub colour: RGBColor,
    /// How it is drawn.
    pub stroke: Stroke,
    /// Whether it belongs to the scale on the right side.
    pub right: bool,
    /// Its points.
    pub points: Vec<(f64, f64)>,
}

impl Series {
    /// A line on the left scale.
    pub fn line(label: &str, colour: RGBColor, points: Vec<(f64, f64)>) -> Self {
        Self { label: Some(label.to_owned()), colour, stroke: Stroke::Line, right: false, points }
    }
}

/// An interval of the abscissa with a coloured background.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Its name in the legend; equal names have one entry.
    pub label: &'static str,
    /// Its colour; the background is a lighter one.
    pub colour: RGBColor,
    /// Start and end on the abscissa.
    pub span: (f64, f64),
}

/// A rectangle, drawn in its full colour.
#[derive(Debug, Clone, PartialEq)]
pub struct Tile {
    /// Its name in the legend; equal names have one entry.
    pub label: &'static str,
    /// Its colour.
    pub colour: RGBColor,
    /// Start and end on the abscissa.
    pub across: (f64, f64),
    /// Start and end on the ordinate.
    pub up: (f64, f64),
}

/// A vertical line at a position on the abscissa.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Its name, written on top; may be empty.
    pub label: String,
    /// The position.
    pub at: f64,
}

/// A horizontal line at a value of the ordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Its name in the legend.
    pub label: String,
    /// The value.
    pub at: f64,
    /// Whether it belongs to the scale on the right side.
    pub right: bool,
}

impl Level {
    /// What the legend says of a level beyond the axis, which is not drawn; none if it is.
    fn beyond(&self, scale: &Scale) -> Option<String> {
        let is_beyond = matches!(&scale.axis, Axis::Linear(range) if !range.contains(&self.at));
        is_beyond.then(|| format!("{}: {} (off the axis)", self.label, value::significant(self.at, 3)))
    }
}

/// One of the drawings of a figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The title above it.
    pub title: String,
    /// Height [px] without the title.
    pub height: u32,
    /// The abscissa.
    pub x: Scale,
    /// The ordinate.
    pub y: Scale,
    /// A second ordinate.
    pub right: Option<Scale>,
    /// Backgrounds.
    pub bands: Vec<Band>,
    /// Rectangles in front of the backgrounds.
    pub tiles: Vec<Tile>,
    /// Vertical lines.
    pub marks: Vec<Mark>,
    /// Horizontal lines.
    pub levels: Vec<Level>,
    /// The curves.
    pub series: Vec<Series>,
}

impl Panel {
    /// An empty panel of the usual height.
    pub fn new(title: &str, x: Scale, y: Scale) -> Self {
        Self {
            title: title.to_owned(),
            height: 560,
            x,
            y,
            right: None,
            bands: Vec::new(),
            tiles: Vec::new(),
            marks: Vec::new(),
            levels: Vec::new(),
            series: Vec::new(),
        }
    }
}

/// Draws panels one above the other as SVG.
///
/// # Errors
/// Those of the drawing library.
pub fn stack(panels: &[Panel]) -> Result<String, FigureError> {
    let height = panels.iter().map(|panel| panel.height + TITLE_HEIGHT).sum();
    canvas::sheet((WIDTH, height), |root| {
        let mut rest = root.clone();
        for panel in panels {
            let (here, below) = rest.split_vertically(panel.height + TITLE_HEIGHT);
            draw(&here, panel)?;
            rest = below;
        }
        Ok(Vec::new())
    })
}

fn draw(area: &Area, panel: &Panel) -> Result<(), DrawError> {
    let (title, below) = area.split_vertically(TITLE_HEIGHT);
    write(&title, &panel.title, (MARGIN, TITLE_HEIGHT as i32 * 2 / 3), TEXT + 2, HPos::Left)?;
    let (left, legend) = below.split_horizontally(WIDTH - LEGEND_WIDTH);
    let labelled = panel.marks.iter().any(|mark| !mark.label.is_empty());
    let top = if labelled { 2 * MARK_ROW + MARGIN / 4 } else { MARGIN / 2 };
    let mut chart = axes(&left, &panel.x, &panel.y, top, panel.right.is_some(), false)?;
    draw_bands(&mut chart, panel)?;
    draw_curves(&mut chart, panel, false)?;
    if let Some(scale) = &panel.right {
        let mut chart = axes(&left, &panel.x, scale, top, true, true)?;
        draw_curves(&mut chart, panel, true)?;
    }
    draw_marks(&left, &chart, panel)?;
    draw_legend(&legend, panel)
}

/// Axes on the left and below, or the one on the right alone; both cover the same rectangle.
fn axes<'a, 'b>(
    area: &'a Area<'b>,
    x: &Scale,
    y: &Scale,
    top: i32,
    both: bool,
    right: bool,
) -> Result<Chart<'a, 'b>, DrawError> {
    let room = if both { Y_LABELS as i32 } else { 0 };
    let mut builder = ChartBuilder::on(area);
    builder.margin(MARGIN).margin_top(top).set_label_area_size(LabelAreaPosition::Bottom, X_LABELS);
    if right {
        builder.margin_left(MARGIN + Y_LABELS as i32).set_label_area_size(LabelAreaPosition::Right, Y_LABELS);
    } else {
        builder.margin_right(MARGIN + room).set_label_area_size(LabelAreaPosition::Left, Y_LABELS);
    }
    let mut chart = builder.build_cartesian_2d(x.axis.clone(), y.axis.clone())?;
    let mut mesh = canvas::mesh(&mut chart);
    mesh.y_desc(y.label.as_str()).axis_desc_style((FONT, TEXT));
    if right {
        mesh.disable_x_axis().disable_mesh();
    } else {
        mesh.x_desc(x.label.as_str());
    }
    mesh.draw()?;
    Ok(chart)
}

fn draw_bands(chart: &mut Chart, panel: &Panel) -> Result<(), DrawError> {
    let (across, up) = (chart.x_range(), chart.y_range());
    for band in &panel.bands {
        let (from, to) = (band.span.0.max(across.start), band.span.1.min(across.end));
        if from < to {
            let style = ShapeStyle::from(lightened(band.colour)).filled();
            chart.draw_series([Rectangle::new([(from, up.start), (to, up.end)], style)])?;
        }
    }
    for Tile { colour, across, up, .. } in &panel.tiles {
        chart.draw_series([Rectangle::new([(across.0, up.0), (across.1, up.1)], colour.filled())])?;
    }
    Ok(())
}

/// A colour light enough to be the background of curves.
fn lightened(RGBColor(r, g, b): RGBColor) -> RGBColor {
    let mix = |c: u8| (0.25 * f64::from(c) + 0.75 * 255.0).round() as u8;
    RGBColor(mix(r), mix(g), mix(b))
}

fn draw_curves(chart: &mut Chart, panel: &Panel, right: bool) -> Result<(), DrawError> {
    let (across, up) = (chart.x_range(), chart.y_range());
    // At the edge of the axis a line would have another value than its own. The legend says it.
    let is_shown = |level: &&Level| level.right == right && up.contains(&level.at);
    for level in panel.levels.iter().filter(is_shown) {
        let ends = [(across.start, level.at), (across.end, level.at)];
        chart.draw_series(DashedLineSeries::new(ends, DASH, DASH, BLACK.stroke_width(GUIDE_WIDTH)))?;
    }
    for series in panel.series.iter().filter(|series| series.right == right) {
        match series.stroke {
            Stroke::Dots => {
                let dots = series.points.iter().filter(|(_, y)| y.is_finite());
                chart.draw_series(dots.map(|&at| Circle::new(at, DOT, series.colour.filled())))?;
            }
            Stroke::Line | Stroke::Fine => {
                let width = if series.stroke == Stroke::Line { CURVE_WIDTH } else { 2 };
                let style = series.colour.stroke_width(width);
                let paths: Vec<_> = stretches(&series.points)
                    .map(|stretch| PathElement::new(visible(chart, stretch), style))
                    .collect();
                chart.draw_series(paths)?;
            }
        }
    }
    Ok(())
}

/// The points of a line without those that are less than a shown pixel from the one before.
fn visible(chart: &Chart, stretch: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let pixel = |point: &(f64, f64)| chart.backend_coord(point);
    let near = |a: (i32, i32), b: (i32, i32)| (a.0 - b.0).abs() <= 2 && (a.1 - b.1).abs() <= 2;
    let mut points: Vec<(f64, f64)> = Vec::new();
    for point in stretch {
        if points.last().is_none_or(|last| !near(pixel(last), pixel(point))) {
            points.push(*point);
        }
    }
    points.extend(stretch.last());
    points
}

/// The runs of finite points.
fn stretches(points: &[(f64, f64)]) -> impl Iterator<Item = &[(f64, f64)]> {
    points.split(|(x, y)| !x.is_finite() || !y.is_finite()).filter(|stretch| stretch.len() > 1)
}

fn draw_marks(area: &Area, chart: &Chart, panel: &Panel) -> Result<(), DrawError> {
    let (left, top) = area.get_base_pixel();
    let (across, up) = (chart.x_range(), chart.y_range());
    let (_, high) = chart.backend_coord(&(across.start, up.end));
    let (_, low) = chart.backend_coord(&(across.start, up.start));
    let mut taken = [i32::MIN; 2];
    for mark in panel.marks.iter().filter(|mark| (across.start..=across.end).contains(&mark.at)) {
        let x = chart.backend_coord(&(mark.at, up.start)).0 - left;
        for y in (high - top..low - top).step_by(DASH as usize * 2) {
            area.draw(&PathElement::new([(x, y), (x, (y + DASH).min(low - top))], BLACK.stroke_width(2)))?;
        }
        if !mark.label.is_empty() {
            let half = mark.label.chars().count() as i32 * TEXT / 4;
            let row = usize::from(x - half < taken[0]);
            taken[row] = x + half + 8;
            let y = high - top - MARK_ROW / 2 - row as i32 * MARK_ROW;
            write(area, &mark.label, (x, y), TEXT, HPos::Center)?;
        }
    }
    Ok(())
}

fn draw_legend(area: &Area, panel: &Panel) -> Result<(), DrawError> {
    let mut y = MARGIN;
    let beside = SAMPLE + 16;
    let mut line = |area: &Area, label: &str, sample: &dyn Fn(i32) -> Result<(), DrawError>| {
        sample(y)?;
        write(area, label, (beside, y), TEXT - 2, HPos::Left)?;
        y += PITCH;
        Ok::<(), DrawError>(())
    };
    for series in &panel.series {
        let Some(label) = &series.label else { continue };
        line(area, label, &|y| match series.stroke {
            Stroke::Dots => area.draw(&Circle::new((SAMPLE / 2, y), DOT, series.colour.filled())),
            Stroke::Line | Stroke::Fine => {
                area.draw(&PathElement::new([(0, y), (SAMPLE, y)], series.colour.stroke_width(CURVE_WIDTH)))
            }
        })?;
    }
    for level in &panel.levels {
        let scale = panel.right.as_ref().filter(|_| level.right).unwrap_or(&panel.y);
        if let Some(label) = level.beyond(scale) {
            line(area, &label, &|_| Ok(()))?;
            continue;
        }
        line(area, &level.label, &|y| {
            let dash =
                |from| PathElement::new([(from, y), (from + DASH, y)], BLACK.stroke_width(GUIDE_WIDTH));
            area.draw(&dash(0))?;
            area.draw(&dash(SAMPLE - DASH))
        })?;
    }
    let bands = panel.bands.iter().map(|band| (band.label, lightened(band.colour)));
    let mut named = Vec::new();
    for (name, colour) in bands.chain(panel.tiles.iter().map(|tile| (tile.label, tile.colour))) {
        if !named.contains(&name) {
            named.push(name);
            let style = ShapeStyle::from(colour).filled();
            line(area, name, &|y| area.draw(&Rectangle::new([(0, y - 14), (SAMPLE, y + 14)], style)))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a level beyond the axis is named with its value and not drawn at the edge, where a reader would take it for another
    /// value; one on the axis is drawn.
    #[test]
    fn no_level_is_moved_to_the_edge() {
        let drawing = |at: f64| {
            let x = Scale::from_to("time", 0.0, 1.0);
            let mut panel = Panel::new("node", x, Scale::from_to("velocity [mm/s]", -250.0, 250.0));
            panel.levels = vec![Level { label: "disk".to_owned(), at, right: false }];
            stack(&[panel]).unwrap()
        };
        let (within, beyond) = (drawing(67.0), drawing(628.0));
        assert!(beyond.contains("disk: 628 (off the axis)") && !within.contains("off the axis"));
        // Dashes are lines of their own: those of the level, and those of its sample in the legend.
        let lines = |svg: &str| svg.matches("<polyline").count();
        assert!(lines(&within) > lines(&beyond) + 10, "{} {}", lines(&within), lines(&beyond));
    }
}

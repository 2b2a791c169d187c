//! What is in a plot: lines, areas, cells, points and guides, and where they are on the sheet.

use super::measures::{DIGIT, MARK_ROW, TEXT, width_of};
use crate::publish::chart::palette::{self, INK, PAPER};
use crate::publish::chart::svg::{Anchor, At, Pen, Svg};
use crate::publish::chart::{Axis, Cell, Guide, Layer, Marker, Panel, Point, Shape};

/// Points of a line that are nearer to the one before are left out.
const NEAR: f64 = 0.7;

/// The plot of a panel on the sheet, without its labels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plot {
    /// The upper left corner.
    pub from: At,
    /// The lower right corner.
    pub to: At,
}

impl Plot {
    pub fn x(&self, axis: &Axis, value: f64) -> f64 {
        match value {
            f64::NEG_INFINITY => self.from.0,
            f64::INFINITY => self.to.0,
            value => self.from.0 + axis.place(value) * (self.to.0 - self.from.0),
        }
    }

    pub fn y(&self, axis: &Axis, value: f64) -> f64 {
        match value {
            f64::NEG_INFINITY => self.to.1,
            f64::INFINITY => self.from.1,
            value => self.to.1 - axis.place(value) * (self.to.1 - self.from.1),
        }
    }

    fn at(&self, panel: &Panel, (x, y): At, right: bool) -> At {
        let scale = panel.right.as_ref().filter(|_| right).unwrap_or(&panel.y);
        (self.x(&panel.x.axis, x), self.y(&scale.axis, y))
    }
}

pub(super) fn is_outside(panel: &Panel, point: &Point) -> bool {
    let place = panel.y.axis.place(point.at.1);
    point.at.1.is_finite() && !(-1e-9..=1.0 + 1e-9).contains(&place)
}

/// Draws what must not reach beyond the plot.
pub(super) fn draw_ground(svg: &mut Svg, panel: &Panel, plot: Plot, layer: &Layer) {
    match layer {
        Layer::Line { points, pen, right } => {
            for connected in points.split(|(x, y)| !x.is_finite() || !y.is_finite()) {
                let path: Vec<At> = connected.iter().map(|at| plot.at(panel, *at, *right)).collect();
                if path.len() > 1 {
                    svg.lines(&visible(&path), *pen);
                }
            }
        }
        Layer::Area(corners, colour, cover) => {
            let corners: Vec<At> = corners.iter().map(|at| plot.at(panel, *at, false)).collect();
            svg.polygon(&corners, (*colour, *cover), None);
        }
        Layer::Cells(cells) => {
            for cell in cells {
                let (from, to) = corners(panel, plot, cell);
                if let Some(fill) = cell.fill {
                    svg.rectangle(from, to, fill);
                }
            }
        }
        Layer::Guide(guide) if !guide.is_vertical => {
            let scale = panel.right.as_ref().filter(|_| guide.right).unwrap_or(&panel.y);
            if scale.axis.range().contains(&guide.at) {
                let y = plot.y(&scale.axis, guide.at);
                svg.lines(&[(plot.from.0, y), (plot.to.0, y)], guide.pen);
            }
        }
        Layer::Guide(_) | Layer::Points(_) => {}
    }
}

/// The points of a line without those that are nearly at the place of the one before.
fn visible(path: &[At]) -> Vec<At> {
    let mut kept: Vec<At> = Vec::with_capacity(path.len().min(2_000));
    for at in path {
        if kept.last().is_none_or(|last| (last.0 - at.0).abs() > NEAR || (last.1 - at.1).abs() > NEAR) {
            kept.push(*at);
        }
    }
    if kept.len() < 2 || kept.last() != path.last() {
        kept.extend(path.last());
    }
    kept
}

/// Draws vertical lines with their labels.
pub(super) fn draw_marks(svg: &mut Svg, panel: &Panel, plot: Plot, text: f64) {
    let mut taken = [f64::NEG_INFINITY; 2];
    let guides = panel.layers.iter().filter_map(|layer| match layer {
        Layer::Guide(guide) if guide.is_vertical => Some(guide),
        _ => None,
    });
    for Guide { at, pen, label, .. } in guides {
        let x = plot.x(&panel.x.axis, *at);
        if x < plot.from.0 - 0.1 || x > plot.to.0 + 0.1 {
            continue;
        }
        svg.lines(&[(x, plot.from.1), (x, plot.to.1)], *pen);
        if !label.is_empty() {
            let half = width_of(label, text) / 2.0;
            let row = usize::from(x - half < taken[0]);
            taken[row] = x + half + 4.0;
            let y = plot.from.1 - MARK_ROW * (0.5 + row as f64);
            svg.plain((x, y), Anchor::Middle, INK, text, label);
        }
    }
}

pub(super) fn draw_point(svg: &mut Svg, panel: &Panel, plot: Plot, point: &Point) {
    if !point.at.0.is_finite() || !point.at.1.is_finite() {
        return;
    }
    let Marker { colour, radius, shape, .. } = point.marker;
    let (x, y) = plot.at(panel, point.at, false);
    let shown = (x, y.clamp(plot.from.1, plot.to.1));
    if is_outside(panel, point) {
        let sign = if y < shown.1 { -1.0 } else { 1.0 };
        let (near, far) = (shown.1 + sign * (radius + 2.0), shown.1 + sign * (radius + 8.0));
        svg.polygon(&[(x - 4.0, near), (x + 4.0, near), (x, far)], (colour, 1.0), None);
    } else if point.error > 0.0 {
        let ends =
            [1.0, -1.0].map(|sign| plot.at(panel, (point.at.0, point.at.1 + sign * point.error), false).1);
        let ends = ends.map(|y| y.clamp(plot.from.1, plot.to.1));
        // The marker hides a smaller error, but no cross does.
        if ends[1] - shown.1 > radius || matches!(shape, Shape::Cross | Shape::Plus | Shape::Star) {
            let pen = Pen::solid(colour, 1.0);
            svg.lines(&[(x, ends[0]), (x, ends[1])], pen);
            for end in ends {
                svg.lines(&[(x - radius, end), (x + radius, end)], pen);
            }
        }
    }
    draw_marker(svg, shown, point.marker);
    if let Some(tip) = &point.tip {
        svg.hit_circle(shown, (2.0 * radius).max(6.0), tip);
    }
}

/// Draws a marker; a hollow one has the ground inside.
pub(super) fn draw_marker(svg: &mut Svg, (x, y): At, marker: Marker) {
    let Marker { shape, colour, is_hollow, radius } = marker;
    let outline = Pen::solid(colour, (0.35 * radius).clamp(1.0, 2.0));
    let corners: &[At] = match shape {
        Shape::Circle => {
            let fill = if is_hollow { PAPER } else { colour };
            svg.circle((x, y), radius, Some(fill), Some(outline));
            return;
        }
        Shape::Cross => return strokes(svg, (x, y), marker, &[(0.8, 0.8), (0.8, -0.8)]),
        Shape::Plus => return strokes(svg, (x, y), marker, &[(1.0, 0.0), (0.0, 1.0)]),
        Shape::Star => return strokes(svg, (x, y), marker, &[(1.0, 0.0), (0.5, 0.87), (0.5, -0.87)]),
        // All shapes have about the same area.
        Shape::Square => &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
        Shape::Diamond => &[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)],
        Shape::Up => &[(0.0, -1.3), (1.2, 0.8), (-1.2, 0.8)],
        Shape::Down => &[(0.0, 1.3), (1.2, -0.8), (-1.2, -0.8)],
    };
    let corners: Vec<At> = corners.iter().map(|(dx, dy)| (x + dx * radius, y + dy * radius)).collect();
    svg.polygon(&corners, (if is_hollow { PAPER } else { colour }, 1.0), Some(outline));
}

fn strokes(svg: &mut Svg, (x, y): At, marker: Marker, ends: &[At]) {
    for (dx, dy) in ends.iter().map(|(dx, dy)| (1.3 * marker.radius * dx, 1.3 * marker.radius * dy)) {
        svg.lines(&[(x - dx, y - dy), (x + dx, y + dy)], Pen::solid(marker.colour, 2.2));
    }
}

/// The corners of a cell inside of the plot.
fn corners(panel: &Panel, plot: Plot, cell: &Cell) -> (At, At) {
    let x = cell.x.map(|x| plot.x(&panel.x.axis, x).clamp(plot.from.0, plot.to.0));
    let y = cell.y.map(|y| plot.y(&panel.y.axis, y).clamp(plot.from.1, plot.to.1));
    ((x[0].min(x[1]), y[0].min(y[1])), (x[0].max(x[1]), y[0].max(y[1])))
}

/// Draws the dot, the text and the mark of a cell.
pub(super) fn draw_cell_signs(svg: &mut Svg, panel: &Panel, plot: Plot, cell: &Cell) {
    let (from, to) = corners(panel, plot, cell);
    let ink = palette::contrasting(cell.fill.unwrap_or(PAPER));
    let dot = cell.dot.map(|at| plot.at(panel, at, false));
    let middle = dot.unwrap_or(((from.0 + to.0) / 2.0, (from.1 + to.1) / 2.0));
    // The text is centred at the dot, which may be near to a side of the cell.
    let room = 2.0 * (middle.0 - from.0).min(to.0 - middle.0) - 3.0;
    let fitting = room / (DIGIT * cell.text.chars().count().max(1) as f64);
    let (above, below) = (middle.1 - from.1 - 3.0, to.1 - middle.1 - 3.0);
    let high = if dot.is_some() { above.max(below) } else { 0.75 * (to.1 - from.1) };
    let size = fitting.min(high).min(TEXT);
    if let Some(dot) = dot {
        svg.circle(dot, 1.8, Some(ink), None);
    }
    if size >= 8.0 && !cell.text.is_empty() {
        let y = match dot {
            // Both sides of a dot in the middle differ by roundings.
            Some(dot) if above + 0.1 >= size => dot.1 - 3.0 - size / 2.0,
            Some(dot) => dot.1 + 3.0 + size / 2.0,
            None => middle.1,
        };
        svg.plain((middle.0, y), Anchor::Middle, ink, size, &cell.text);
    }
    if let Some(mark) = cell.mark {
        let room = (to.0 - from.0).min(to.1 - from.1);
        let radius = mark.radius.min(room / 4.0).max(2.0);
        draw_marker(svg, (to.0 - radius - 2.5, from.1 + radius + 2.5), mark.sized(radius));
    }
    if let Some(tip) = &cell.tip {
        svg.hit_rectangle(from, (to.0.max(from.0 + 0.5), to.1.max(from.1 + 0.5)), tip);
    }
}

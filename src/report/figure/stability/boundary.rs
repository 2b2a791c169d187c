//! The boundary of linear stability in a plane, and the marks of jobs that it does not explain.

use crate::publish::plot::DrawError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{Area, Chart};
use crate::publish::value;
use crate::report::figure::places;
use crate::report::layout::{Group, Layout};
use crate::report::stability::{Node, Verdict, zero_line};
use crate::report::stability_point::StabilityPoint;
use plotters::prelude::{BLACK, PathElement, Polygon, WHITE};
use plotters::style::Color;

pub(in crate::report::figure) use super::key::{Sign, draw as draw_signs};

/// Width of the zero line [px].
pub(super) const WIDTH: u32 = 6;
/// Width of the white line below it, which keeps it apart from dark cells [px].
const HALO: u32 = 10;
/// Half the size of a mark [px].
pub(super) const MARK: i32 = 11;

/// The points of a group at their places in the plane, with the growth rates [1/s] of their leading modes.
pub(in crate::report::figure) fn nodes(
    layout: &Layout,
    group: &Group,
    points: &[StabilityPoint],
) -> Vec<Node> {
    let x_axis = layout.x_axis();
    let y_of = places::y_of(layout);
    let belongs = |point: &&StabilityPoint| {
        let equal =
            |(name, own): &(&str, serde_json::Value)| value::text(&point.parameter(name)) == value::text(own);
        group.key.iter().all(equal)
    };
    let node = |point: &StabilityPoint| {
        Some(Node {
            x: layout.position(&x_axis, &point.parameter(layout.axis))?,
            y: y_of(&point.parameter(layout.by))?,
            value: point.leading()?.growth_rate_per_s,
        })
    };
    points.iter().filter(belongs).filter_map(node).collect()
}

/// Draws the line on which the growth rate is zero, as far as the points around it are inside of the axes; returns whether
/// there is one.
pub(in crate::report::figure) fn draw(chart: &mut Chart, nodes: &[Node]) -> Result<bool, DrawError> {
    let (across, up) = (chart.x_range(), chart.y_range());
    let is_log = matches!(chart.as_coord_spec().x_spec(), Axis::Log(_));
    let inside: Vec<Node> =
        nodes.iter().copied().filter(|node| across.contains(&node.x) && up.contains(&node.y)).collect();
    let lines = zero_line(&inside, is_log, &across, &up);
    for (colour, width) in [(WHITE, HALO), (BLACK, WIDTH)] {
        let style = colour.stroke_width(width);
        chart.draw_series(lines.iter().map(|line| PathElement::new(line.clone(), style)))?;
    }
    Ok(!lines.is_empty())
}

/// Draws a mark into the upper right corner of a cell, smaller in a small cell.
pub(in crate::report::figure) fn draw_mark_in(
    area: &Area,
    verdict: Verdict,
    upper: (i32, i32),
    lower: (i32, i32),
) -> Result<(), DrawError> {
    let room = (lower.0 - upper.0).min(lower.1 - upper.1);
    let half = MARK.min(room / 4).max(3);
    draw_mark(area, verdict, (lower.0 - half - 3, upper.1 + half + 3), half)
}

/// Draws a mark: a black triangle, or a white diamond.
pub(super) fn draw_mark(
    area: &Area,
    verdict: Verdict,
    (x, y): (i32, i32),
    half: i32,
) -> Result<(), DrawError> {
    let (corners, fill) = match verdict {
        Verdict::CycleBelowThreshold => {
            (vec![(x, y - half), (x + half, y + half), (x - half, y + half)], BLACK)
        }
        Verdict::NoEffect => (vec![(x, y - half), (x + half, y), (x, y + half), (x - half, y)], WHITE),
    };
    area.draw(&Polygon::new(corners.clone(), fill.filled()))?;
    let outline = corners.iter().chain(corners.first()).copied().collect::<Vec<_>>();
    area.draw(&PathElement::new(outline, BLACK.stroke_width(3)))
}

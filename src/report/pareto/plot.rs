//! Error of μ* against solver time, log–log, with the Pareto front.

#![expect(clippy::cast_possible_wrap, reason = "pixels and legend lines: thousands, not billions")]

use super::case::Case;
use super::front::on_front;
use super::page::figure_title;
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area, X_LABELS, write};
use crate::publish::plot::{DASH, DrawError, MARGIN, TEXT, palette};
use plotters::chart::ChartBuilder;
use plotters::prelude::{BLACK, Circle, DashedLineSeries, PathElement, Polygon, RGBColor, WHITE};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;
use serde_json::Value;

const LEGEND_WIDTH: u32 = 440;
const Y_LABELS: u32 = 170;
const RADIUS: i32 = 12;
/// Where labels in the legend begin.
const LABELS: i32 = 3 * RADIUS + 24;
/// Colours of the fronts, by the way to solve a job.
const FRONTS: [RGBColor; 4] =
    [RGBColor(0, 0, 0), RGBColor(0x80, 0x80, 0x80), RGBColor(0x20, 0x60, 0xc0), RGBColor(0xc0, 0x40, 0x20)];
const GREY: RGBColor = RGBColor(0x50, 0x50, 0x50);

struct Point {
    time_s: f64,
    error: f64,
    colour: RGBColor,
    early: bool,
    resolved: bool,
    on_front: bool,
    way: String,
}

/// Draws a case. Jobs without a run time and jobs whose error and resolution are both zero are left out, because the axes
/// are logarithmic.
pub(super) fn draw(case: &Case) -> Result<String, FigureError> {
    let meshes = meshes(case);
    let points = points(case, &meshes);
    canvas::sheet((canvas::WIDTH, canvas::HEIGHT), |root| {
        let below = canvas::caption(root, &case.caption)?;
        let (left, right) = below.split_horizontally(canvas::WIDTH - LEGEND_WIDTH);
        draw_plot(&left, &points)?;
        draw_legend(&right, &meshes, &points)?;
        Ok(Vec::new())
    })
}

/// The meshes of a case, coarsest first.
fn meshes(case: &Case) -> Vec<[usize; 3]> {
    let mut meshes: Vec<_> =
        case.jobs.iter().map(|job| (job.numerics.nodes, job.numerics.elements)).collect();
    meshes.sort_unstable();
    meshes.dedup();
    meshes.into_iter().map(|(_, elements)| elements).collect()
}

fn points(case: &Case, meshes: &[[usize; 3]]) -> Vec<Point> {
    case.jobs
        .iter()
        .zip(&case.scores)
        .filter_map(|(job, score)| {
            let (time_s, error) = (score.wall_s?, score.claimed_error());
            let mesh = meshes.iter().position(|mesh| *mesh == job.numerics.elements)?;
            (time_s > 0.0 && error > 0.0 && time_s.is_finite() && error.is_finite()).then(|| Point {
                time_s,
                error,
                colour: palette::colour(mesh, meshes.len()),
                early: job.numerics.stop_early,
                resolved: score.is_resolved(),
                on_front: score.on_wall_front,
                way: job.numerics.way(),
            })
        })
        .collect()
}

fn axis(values: impl Iterator<Item = f64>) -> Axis {
    let values: Vec<Value> = values.map(Value::from).collect();
    Axis::for_values(&values, Some(true))
}

fn draw_plot(area: &Area, points: &[Point]) -> Result<(), DrawError> {
    if points.is_empty() {
        let (width, height) = area.dim_in_pixel();
        let note = "no job has both a run time and an error above zero";
        return write(area, note, (width as i32 / 2, height as i32 / 3), TEXT, HPos::Center);
    }
    let mut chart = ChartBuilder::on(area)
        .margin(MARGIN)
        .x_label_area_size(X_LABELS)
        .y_label_area_size(Y_LABELS)
        .build_cartesian_2d(
            axis(points.iter().map(|point| point.time_s)),
            axis(points.iter().map(|point| point.error)),
        )?;
    canvas::mesh(&mut chart).x_desc("solver time of the job [s]").y_desc(figure_title()).draw()?;
    for (way, colour) in ways(points).iter().zip(FRONTS.into_iter().cycle()) {
        let own = points.iter().filter(|point| point.way == *way);
        let own: Vec<(f64, f64)> = own.map(|point| (point.time_s, point.error)).collect();
        let on_front = on_front(&own).into_iter();
        let mut front: Vec<(f64, f64)> =
            own.into_iter().zip(on_front).filter_map(|(point, is_on)| is_on.then_some(point)).collect();
        front.sort_by(|a, b| a.0.total_cmp(&b.0));
        chart.draw_series(DashedLineSeries::new(front, DASH, DASH / 2, colour.stroke_width(3)))?;
    }
    let (left, top) = area.get_base_pixel();
    for point in points {
        let (x, y) = chart.backend_coord(&(point.time_s, point.error));
        draw_marker(area, (x - left, y - top), point)?;
    }
    Ok(())
}

/// A circle for a whole run and a triangle for one that stopped early. The marker is hollow if the error is not resolved,
/// and has a ring if the job is on the front.
fn draw_marker(area: &Area, at: (i32, i32), point: &Point) -> Result<(), DrawError> {
    if point.on_front {
        area.draw(&Circle::new(at, RADIUS + 9, BLACK.stroke_width(3)))?;
    }
    shape(area, at, point.early, f64::from(RADIUS), point.colour)?;
    if point.resolved { Ok(()) } else { shape(area, at, point.early, 0.55 * f64::from(RADIUS), WHITE) }
}

fn shape(
    area: &Area,
    (x, y): (i32, i32),
    triangle: bool,
    radius: f64,
    colour: RGBColor,
) -> Result<(), DrawError> {
    let pixels = |offset: f64| (offset * radius).round() as i32;
    if triangle {
        let corners = [(0.0, -1.35), (1.2, 0.8), (-1.2, 0.8)];
        area.draw(&Polygon::new(corners.map(|(dx, dy)| (x + pixels(dx), y + pixels(dy))), colour))
    } else {
        area.draw(&Circle::new((x, y), pixels(1.0), colour.filled()))
    }
}

fn draw_legend(area: &Area, meshes: &[[usize; 3]], points: &[Point]) -> Result<(), DrawError> {
    let sample = |early, resolved, on_front| Point {
        time_s: 0.0,
        error: 0.0,
        colour: GREY,
        early,
        resolved,
        on_front,
        way: String::new(),
    };
    let mut entries: Vec<(Option<Point>, String)> = vec![(None, "mesh".to_owned())];
    for (index, [nx, ny, nz]) in meshes.iter().enumerate() {
        let colour = palette::colour(index, meshes.len());
        entries.push((Some(Point { colour, ..sample(false, true, false) }), format!("{nx} × {ny} × {nz}")));
    }
    entries.push((None, String::new()));
    let any = |test: fn(&Point) -> bool| points.iter().any(test);
    let kinds = [
        (any(|p| !p.early), sample(false, true, false), "run to its limit"),
        (any(|p| p.early), sample(true, true, false), "stopped early"),
        (any(|p| !p.resolved), sample(false, false, false), "hollow: at most this"),
        (any(|p| p.on_front), sample(false, true, true), "Pareto front"),
    ];
    for (there, point, label) in kinds {
        if there {
            entries.push((Some(point), label.to_owned()));
        }
    }
    let ways = ways(points);
    let mut lines_of_ways = Vec::new();
    let mut front = any(|p| p.on_front).then(|| entries.len() - 1);
    if ways.len() > 1 {
        // Each way has a front of its own. The rings show the front of all.
        front = None;
        entries.push((None, "fronts by precision and start".to_owned()));
        for way in ways {
            lines_of_ways.push(entries.len());
            entries.push((None, way));
        }
    }
    let room = area.dim_in_pixel().1 as i32 - 2 * MARGIN;
    let pitch = (room / entries.len() as i32).min(50);
    // A long legend gets smaller text, so that all of it is on the sheet.
    let size = TEXT.min(pitch * 5 / 6);
    for (line, (marker, label)) in entries.iter().enumerate() {
        let y = MARGIN + pitch / 2 + line as i32 * pitch;
        if let Some(point) = marker {
            draw_marker(area, (RADIUS + 12, y), point)?;
        }
        let is_labelled = marker.is_some() || lines_of_ways.contains(&line);
        let x = if is_labelled { LABELS } else { 0 };
        write(area, label, (x, y), size, HPos::Left)?;
    }
    let dash = |line: usize, colour: RGBColor| {
        let y = MARGIN + pitch / 2 + line as i32 * pitch;
        area.draw(&PathElement::new([(0, y), (2 * (RADIUS + 12), y)], colour.stroke_width(3)))
    };
    // The fronts are also drawn as lines.
    if let Some(front) = front {
        dash(front, BLACK)?;
    }
    for (way, colour) in lines_of_ways.into_iter().zip(FRONTS.into_iter().cycle()) {
        dash(way, colour)?;
    }
    Ok(())
}

/// The ways to solve a job that occur.
fn ways(points: &[Point]) -> Vec<String> {
    let mut ways: Vec<String> = points.iter().map(|point| point.way.clone()).collect();
    ways.sort_unstable();
    ways.dedup();
    ways
}

//! The whole contact face over a cycle.

use super::style::{BREAK, MICRO, MILLI, add_cells, cells, colour_of, fine, thick};
use crate::inspect::inspection::{Inspection, node_loop};
use crate::inspect::phases::{Instants, phases};
use crate::inspect::waves::stations;
use crate::publish::chart::palette::{self, INK};
use crate::publish::chart::{At, Chart, Entry, Layer, Marker, Panel, Point, Scale, Shape};

/// Largest width of a loop, relative to the distance of two nodes.
const LOOP_WIDTH: f64 = 0.8;

/// Figure 3a: the loops of all nodes about their means, and the loops along three lines at the positions of the nodes.
pub fn trajectories(inspection: &Inspection) -> Chart {
    let [nx, _] = inspection.face_grid().elements;
    let lines = [("Inner side (−x)", 0), ("Middle", nx / 2), ("Outer side (+x)", nx)];
    let along = lines.map(|(name, i)| along_line(inspection, name, i));
    Chart::stack(std::iter::once(all_loops(inspection)).chain(along).collect())
}

fn mean(path: &[At]) -> f64 {
    path.iter().map(|point| point.0).sum::<f64>() / path.len().max(1) as f64
}

/// A closed path, followed by a point that ends the line. The ordinate is in micrometres.
fn drawn_loop(path: &[At], place: impl Fn(f64) -> f64) -> impl Iterator<Item = At> {
    let closed = path.iter().chain(path.first()).map(move |(y, z)| (place(*y), z * MICRO));
    closed.chain([BREAK])
}

/// A panel of displacements, whose axes have room for all points.
fn panel_of(title: &str, x_label: &str, all: &[At]) -> Panel {
    let x = Scale::spanning(x_label, all.iter().map(|point| point.0), 0.01);
    let y = Scale::spanning("displacement in z [µm]", all.iter().map(|point| point.1), 0.01);
    Panel::new(title, x, y)
}

fn all_loops(inspection: &Inspection) -> Panel {
    let grid = inspection.face_grid();
    let [_, ny] = grid.elements;
    let across = |j: usize| -> Vec<At> {
        let path_of = |slave| node_loop(&inspection.capture.face, slave);
        let loops = grid.across(j).map(path_of).map(|path| {
            let mean = mean(&path);
            drawn_loop(&path, |y| (y - mean) * MICRO).collect::<Vec<At>>()
        });
        loops.flatten().collect()
    };
    let rows: Vec<Vec<At>> = (0..=ny).map(across).collect();
    let title = "All contact nodes, each about its mean";
    let mut panel = panel_of(title, "displacement in y less its mean [µm]", &rows.concat());
    for (j, points) in rows.into_iter().enumerate() {
        // The colour goes from front to rear in a sequence.
        let pen = fine(palette::sequential(j as f64 / ny as f64));
        panel.layers.push(Layer::Line { points, pen, right: false });
        let name = match j {
            0 => "front",
            _ if j == ny => "rear",
            _ if j == ny / 2 => "middle",
            _ => continue,
        };
        panel.explain(Entry::line(pen, name));
    }
    panel
}

fn along_line(inspection: &Inspection, name: &str, i: usize) -> Panel {
    let mesh = inspection.mesh();
    let grid = inspection.face_grid();
    // Fewer loops than nodes, so that a reader can tell them apart.
    let stride = grid.elements[1].div_ceil(15);
    let place = |slave| (mesh.coordinates_m(slave)[1], node_loop(&inspection.capture.face, slave));
    let loops: Vec<(f64, Vec<At>)> = grid.along(i).step_by(stride).map(place).collect();
    let widest_m = loops.iter().map(|(_, path)| extent(path)).fold(f64::MIN_POSITIVE, f64::max);
    let factor = round_down(LOOP_WIDTH * stride as f64 * grid.width_m[1] / widest_m);
    let mut points = Vec::new();
    for (at_m, path) in &loops {
        let mean = mean(path);
        points.extend(drawn_loop(path, |y| (at_m + (y - mean) * factor) * MILLI));
    }
    let label = format!("y [mm], displacements × {factor:.0}: front left, rear right");
    let mut panel = panel_of(&format!("{name}: where the nodes are"), &label, &points);
    panel.layers = vec![Layer::Line { points, pen: thick(palette::BLUE), right: false }];
    panel
}

fn extent(path: &[At]) -> f64 {
    let ends = path
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| [low.min(point.0), high.max(point.0)]);
    ends[1] - ends[0]
}

/// Rounds down to one significant digit.
fn round_down(x: f64) -> f64 {
    let decade = 10f64.powf(x.log10().floor());
    (x / decade).floor() * decade
}

/// The states along the middle of the face over a cycle.
pub fn waves(inspection: &Inspection) -> Chart {
    let mesh = inspection.mesh();
    let grid = inspection.face_grid();
    let [start_s, end_s] = inspection.survey.windows.cycle_s;
    let since = |time_s: f64| (time_s - start_s) * MICRO;
    // A little more than half an element, so that rounding to pixels leaves no gap between the rows.
    let half_m = 0.55 * grid.width_m[1];
    let edge_m = mesh.size_m()[1] / 2.0;
    let rows = grid.middle().flat_map(|slave| {
        let at_m = mesh.coordinates_m(slave)[1];
        let row = [(at_m - half_m).max(-edge_m) * MILLI, (at_m + half_m).min(edge_m) * MILLI];
        let steps = inspection.capture.face.iter().map(|step| (step.time_s, step.nodes[slave].state));
        cells(&phases(steps, end_s), since, row, colour_of).collect::<Vec<_>>()
    });
    let x = Scale::from_to("time [µs]", 0.0, since(end_s));
    let y = Scale::from_to("y [mm]: rear above, front below", -edge_m * MILLI, edge_m * MILLI);
    let mut panel = Panel::new("States along the middle of the contact face over one cycle", x, y);
    add_cells(&mut panel, rows.collect(), colour_of);
    let marker = Marker::new(Shape::Circle, INK).sized(3.0);
    let peaks = stations(inspection).into_iter().filter_map(|station| {
        let Instants { peak_s, .. } = station.instants?;
        let within_s = (peak_s - start_s).rem_euclid(end_s - start_s);
        Some(Point { at: (within_s * MICRO, station.y_m * MILLI), error: 0.0, marker, tip: None })
    });
    panel.layers.push(Layer::Points(peaks.collect()));
    panel.explain(Entry::marker(marker, "largest stress"));
    Chart::of(panel)
}

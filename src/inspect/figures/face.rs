//! The whole contact face over a cycle.

use super::style::{MICRO, MILLI, colour_of, legend_position};
use crate::inspect::inspection::{Inspection, node_loop};
use crate::inspect::phases::{Instants, phases};
use crate::inspect::waves::stations;
use crate::publish::plot::palette;
use crate::publish::plot::panel::{Panel, Scale, Series, Stroke, Tile};

/// Largest width of a loop, relative to the distance of two nodes.
const LOOP_WIDTH: f64 = 0.8;

/// Figure 3a: the loops of all nodes about their means, and the loops along three lines at the positions of the nodes.
pub fn trajectories(inspection: &Inspection) -> Vec<Panel> {
    let [nx, _] = inspection.face_grid().elements;
    let lines = [("inner side (−x)", 0), ("middle", nx / 2), ("outer side (+x)", nx)];
    let along = lines.map(|(name, i)| along_line(inspection, name, i));
    std::iter::once(all_loops(inspection)).chain(along).collect()
}

fn mean(path: &[(f64, f64)]) -> f64 {
    path.iter().map(|point| point.0).sum::<f64>() / path.len().max(1) as f64
}

/// A closed path, followed by a point that ends the line. The ordinate is in micrometres.
fn drawn_loop(path: &[(f64, f64)], place: impl Fn(f64) -> f64) -> impl Iterator<Item = (f64, f64)> {
    let closed = path.iter().chain(path.first()).map(move |(y, z)| (place(*y), z * MICRO));
    closed.chain([(f64::NAN, f64::NAN)])
}

fn all_loops(inspection: &Inspection) -> Panel {
    let grid = inspection.face_grid();
    let [_, ny] = grid.elements;
    // The colour goes from front to rear in a sequence.
    let across = |j: usize| {
        let mut points = Vec::new();
        for slave in grid.across(j) {
            let path = node_loop(&inspection.capture.face, slave);
            let mean = mean(&path);
            points.extend(drawn_loop(&path, |y| (y - mean) * MICRO));
        }
        let label = match j {
            0 => Some("front".to_owned()),
            _ if j == ny => Some("rear".to_owned()),
            _ if j == ny / 2 => Some("middle".to_owned()),
            _ => None,
        };
        let colour = palette::sequential(j as f64 / ny as f64);
        Series { label, colour, stroke: Stroke::Fine, right: false, points }
    };
    let series: Vec<Series> = (0..=ny).map(across).collect();
    panel_of("All contact nodes, each about its mean", "displacement in y less its mean [µm]", series)
}

fn along_line(inspection: &Inspection, name: &str, i: usize) -> Panel {
    let mesh = inspection.mesh();
    let grid = inspection.face_grid();
    // Fewer loops than nodes, so that a reader can tell them apart.
    let stride = grid.elements[1].div_ceil(15);
    let loops: Vec<(f64, Vec<(f64, f64)>)> = grid
        .along(i)
        .step_by(stride)
        .map(|slave| (mesh.coordinates_m(slave)[1], node_loop(&inspection.capture.face, slave)))
        .collect();
    let widest_m = loops.iter().map(|(_, path)| extent(path)).fold(f64::MIN_POSITIVE, f64::max);
    let factor = round_down(LOOP_WIDTH * stride as f64 * grid.width_m[1] / widest_m);
    let mut points = Vec::new();
    for (at_m, path) in &loops {
        let mean = mean(path);
        points.extend(drawn_loop(path, |y| (at_m + (y - mean) * factor) * MILLI));
    }
    let label = format!("y [mm], displacements × {factor:.0}: front left, rear right");
    let title = format!("{}{}: where the nodes are", name[..1].to_uppercase(), &name[1..]);
    panel_of(&title, &label, vec![Series { label: None, ..Series::line("", palette::colour(0, 8), points) }])
}

fn panel_of(title: &str, x_label: &str, series: Vec<Series>) -> Panel {
    let all = || series.iter().flat_map(|series| &series.points);
    let x = Scale::spanning(x_label, all().map(|point| point.0), 0.01);
    let y = Scale::spanning("displacement in z [µm]", all().map(|point| point.1), 0.01);
    Panel { series, ..Panel::new(title, x, y) }
}

fn extent(path: &[(f64, f64)]) -> f64 {
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
pub fn waves(inspection: &Inspection) -> Panel {
    let mesh = inspection.mesh();
    let grid = inspection.face_grid();
    let [start_s, end_s] = inspection.survey.windows.cycle_s;
    let since = |time_s: f64| (time_s - start_s) * MICRO;
    // A little more than half an element, so that rounding to pixels leaves no gap between the rows.
    let half_m = 0.55 * grid.width_m[1];
    let [_, ly, _] = mesh.size_m();
    let x = Scale::from_to("time [µs]", 0.0, since(end_s));
    let y = Scale::from_to("y [mm]: rear above, front below", -ly / 2.0 * MILLI, ly / 2.0 * MILLI);
    let mut panel = Panel::new("States along the middle of the contact face over one cycle", x, y);
    panel.height = 700;
    for slave in grid.middle() {
        let at_m = mesh.coordinates_m(slave)[1];
        let rows = ((at_m - half_m).max(-ly / 2.0) * MILLI, (at_m + half_m).min(ly / 2.0) * MILLI);
        let steps = inspection.capture.face.iter().map(|step| (step.time_s, step.nodes[slave].state));
        for phase in phases(steps, end_s) {
            let (label, colour) = (phase.state.name(), colour_of(phase.state));
            panel.tiles.push(Tile {
                label,
                colour,
                across: (since(phase.start_s), since(phase.end_s)),
                up: rows,
            });
        }
    }
    panel.tiles.sort_by_key(|tile| legend_position(tile.label));
    let period_s = end_s - start_s;
    let peaks = stations(inspection).into_iter().filter_map(|station| {
        let Instants { peak_s, .. } = station.instants?;
        let within_s = (peak_s - start_s).rem_euclid(period_s);
        Some((within_s * MICRO, station.y_m * MILLI))
    });
    panel.series = vec![Series {
        label: Some("largest stress".to_owned()),
        colour: plotters::style::BLACK,
        stroke: Stroke::Dots,
        right: false,
        points: peaks.collect(),
    }];
    panel
}

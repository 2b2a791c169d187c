//! Error of μ\* against solver time, log–log, with the Pareto front.

use super::compare::Case;
use super::page::figure_title;
use super::score::on_front;
use crate::publish::chart::palette::{self, GREY, INK, Rgb};
use crate::publish::chart::{At, Axis, Chart, Entry, Layer, Marker, Panel, Pen, Point, Scale, Shape};
use serde_json::Value;

/// Colours of the fronts, by the way to solve a job.
const FRONTS: [Rgb; 4] = [INK, Rgb(0x80, 0x80, 0x80), Rgb(0x20, 0x60, 0xc0), Rgb(0xc0, 0x40, 0x20)];
/// The ring around a job on the front.
const RING: Marker = Marker { shape: Shape::Circle, colour: INK, is_hollow: true, radius: 9.5 };

/// A job in the figure.
struct Solved {
    at: At,
    marker: Marker,
    is_on_front: bool,
    way: String,
}

/// The marker of a job: a circle for a whole run and a triangle for one that stopped early, hollow if the error is not
/// resolved.
fn marker(colour: Rgb, is_early: bool, is_resolved: bool) -> Marker {
    Marker::new(if is_early { Shape::Up } else { Shape::Circle }, colour).hollow(!is_resolved)
}

/// The figure of a case. Jobs without a run time and jobs whose error and resolution are both zero are left out, because the axes
/// are logarithmic.
pub fn chart(case: &Case) -> Chart {
    let meshes = meshes(case);
    let solved = solved(case, &meshes);
    let axis = |values: Vec<f64>| {
        Axis::for_values(&values.into_iter().map(Value::from).collect::<Vec<_>>(), Some(true))
    };
    let x = Scale::new("solver time of the job [s]", axis(solved.iter().map(|job| job.at.0).collect()));
    let y = Scale::new(&figure_title(), axis(solved.iter().map(|job| job.at.1).collect()));
    let mut panel = Panel::new(&case.caption, x, y);
    panel.note = "no job has both a run time and an error above zero".into();
    let ways = ways(&solved);
    let pens: Vec<Pen> =
        FRONTS.iter().cycle().take(ways.len()).map(|colour| Pen::dashed(*colour, 1.5)).collect();
    for (way, pen) in ways.iter().zip(&pens) {
        let own: Vec<At> = solved.iter().filter(|job| job.way == *way).map(|job| job.at).collect();
        let is_on = on_front(&own);
        let mut points: Vec<At> =
            own.into_iter().zip(is_on).filter_map(|(at, is_on)| is_on.then_some(at)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        panel.layers.push(Layer::Line { points, pen: *pen, right: false });
    }
    let point = |at: At, marker: Marker| Point { at, error: 0.0, marker, tip: None };
    let rings = solved.iter().filter(|job| job.is_on_front).map(|job| point(job.at, RING));
    let markers = solved.iter().map(|job| point(job.at, job.marker));
    if !solved.is_empty() {
        panel.layers.push(Layer::Points(rings.chain(markers).collect()));
    }
    Chart { legend: legend(&meshes, &solved, &ways, &pens), ..Chart::of(panel) }
}

/// The meshes of a case, coarsest first.
fn meshes(case: &Case) -> Vec<[usize; 3]> {
    let mut meshes: Vec<_> =
        case.jobs.iter().map(|job| (job.numerics.nodes, job.numerics.elements)).collect();
    meshes.sort_unstable();
    meshes.dedup();
    meshes.into_iter().map(|(_, elements)| elements).collect()
}

fn solved(case: &Case, meshes: &[[usize; 3]]) -> Vec<Solved> {
    case.jobs
        .iter()
        .zip(&case.scores)
        .filter_map(|(job, score)| {
            let (time_s, error) = (score.wall_s?, score.claimed_error());
            let mesh = meshes.iter().position(|mesh| *mesh == job.numerics.elements)?;
            let colour = palette::colour(mesh, meshes.len());
            (time_s > 0.0 && error > 0.0 && time_s.is_finite() && error.is_finite()).then(|| Solved {
                at: (time_s, error),
                marker: marker(colour, job.numerics.stop_early, score.is_resolved()),
                is_on_front: score.on_wall_front,
                way: job.numerics.way(),
            })
        })
        .collect()
}

fn legend(meshes: &[[usize; 3]], solved: &[Solved], ways: &[String], pens: &[Pen]) -> Vec<Entry> {
    let mut entries = vec![Entry::heading("mesh")];
    for (index, [nx, ny, nz]) in meshes.iter().enumerate() {
        let colour = palette::colour(index, meshes.len());
        entries.push(Entry::marker(marker(colour, false, true), &format!("{nx} × {ny} × {nz}")));
    }
    entries.push(Entry::heading("job"));
    let any = |test: fn(&Solved) -> bool| solved.iter().any(test);
    let kinds = [
        (any(|job| job.marker.shape == Shape::Circle), marker(GREY, false, true), "run to its limit"),
        (any(|job| job.marker.shape == Shape::Up), marker(GREY, true, true), "stopped early"),
        (any(|job| job.marker.is_hollow), marker(GREY, false, false), "hollow: at most this"),
        (any(|job| job.is_on_front), RING, "on the Pareto front"),
    ];
    entries
        .extend(kinds.into_iter().filter(|kind| kind.0).map(|(_, marker, text)| Entry::marker(marker, text)));
    match ways {
        [] => {}
        [_] => entries.push(Entry::line(pens[0], "Pareto front")),
        // Each way has a front of its own. The rings show the front of all.
        _ => {
            entries.push(Entry::heading("fronts by precision and start"));
            entries.extend(ways.iter().zip(pens).map(|(way, pen)| Entry::line(*pen, way)));
        }
    }
    entries
}

/// The ways to solve a job that occur.
fn ways(solved: &[Solved]) -> Vec<String> {
    let mut ways: Vec<String> = solved.iter().map(|job| job.way.clone()).collect();
    ways.sort_unstable();
    ways.dedup();
    ways
}

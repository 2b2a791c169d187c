//! Hysteresis loops: friction over slip, and friction over displacement.

use super::style::{MICRO, STATES, colour_of};
use crate::inspect::inspection::Inspection;
use crate::inspect::loops::{self, LoopEnergies, LoopPoint};
use crate::publish::plot::palette;
use crate::publish::plot::panel::{Panel, Scale, Series, Stroke};
use crate::publish::value::significant;
use crate::solver::interface::ContactState;

/// The abscissa of a panel and what its area is.
struct Abscissa {
    label: &'static str,
    of: fn(&LoopPoint) -> Option<f64>,
    energy: fn(&LoopEnergies) -> f64,
    area: &'static str,
    /// Whether it begins again at zero in every cycle. Otherwise the path of a cycle is closed.
    restarts: bool,
}

const SLIP: Abscissa = Abscissa {
    label: "slip of the disk along the node since the cycle began [µm]",
    of: |point| Some(point.slip_m * MICRO),
    energy: |energies| energies.friction_j,
    area: "dissipated",
    restarts: true,
};
const DISPLACEMENT: Abscissa = Abscissa {
    label: "displacement in y [µm]",
    of: |point| point.y_m.map(|y_m| y_m * MICRO),
    energy: |energies| energies.into_pin_j,
    area: "into the pin",
    restarts: false,
};

/// For every observed node friction over slip and over displacement; the same for the whole face.
pub fn loops(inspection: &Inspection) -> Vec<Panel> {
    let summary = loops::summary(inspection);
    let what = if inspection.survey.windows.has_cycles { "per cycle" } else { "per period" };
    let mut panels = Vec::new();
    for (number, (observed, energies)) in inspection.observed.iter().zip(&summary.nodes).enumerate() {
        let points = loops::of_node(inspection, number);
        for abscissa in [&SLIP, &DISPLACEMENT] {
            let title = title(&observed.node.title, abscissa, energies, what);
            panels.push(of_node(&title, abscissa, &points));
        }
    }
    let points = loops::of_face(inspection);
    for abscissa in [&SLIP, &DISPLACEMENT] {
        let title = title("Whole contact face", abscissa, &summary.face, what);
        panels.push(of_face(&title, abscissa, &points));
    }
    panels
}

fn title(of: &str, abscissa: &Abscissa, energies: &LoopEnergies, what: &str) -> String {
    let microjoules = significant((abscissa.energy)(energies) * MICRO, 3).replace('-', "−");
    format!("{of}: {microjoules} µJ {} {what}", abscissa.area)
}

fn of_node(title: &str, abscissa: &Abscissa, points: &[LoopPoint]) -> Panel {
    let series: Vec<Series> = STATES
        .into_iter()
        .map(|state| Series {
            stroke: Stroke::Fine,
            ..Series::line(state.name(), colour_of(state), path_in(state, abscissa, points))
        })
        .collect();
    panel(title, abscissa, "friction force in y [N]", series)
}

/// The parts of a loop in which a node is in a state. A part ends where the slip begins again at zero.
fn path_in(state: ContactState, abscissa: &Abscissa, points: &[LoopPoint]) -> Vec<(f64, f64)> {
    let place = |point: &LoopPoint| (abscissa.of)(point).map(|x| (x, point.friction_n));
    let mut path = Vec::new();
    for pair in points.windows(2) {
        let is_new_cycle = abscissa.restarts && pair[1].slip_m == 0.0 && pair[0].slip_m != 0.0;
        match (place(&pair[0]), place(&pair[1])) {
            (Some(from), Some(to)) if pair[0].state == Some(state) && !is_new_cycle => {
                path.extend([from, to]);
            }
            _ if path.last().is_some_and(|last: &(f64, f64)| last.0.is_finite()) => {
                path.push((f64::NAN, f64::NAN));
            }
            _ => {}
        }
    }
    path
}

fn of_face(title: &str, abscissa: &Abscissa, points: &[LoopPoint]) -> Panel {
    let path = |force: fn(&LoopPoint) -> Option<f64>| {
        let place = |point: &LoopPoint| Some(((abscissa.of)(point)?, force(point)?));
        let mut path: Vec<(f64, f64)> = points.iter().filter_map(place).collect();
        if !abscissa.restarts {
            path.extend(path.first().copied());
        }
        path
    };
    let series = vec![
        Series::line("friction of the face", palette::colour(3, 8), path(|point| Some(point.friction_n))),
        Series {
            stroke: Stroke::Fine,
            ..Series::line("T at the clamp", palette::colour(1, 8), path(|point| point.clamp_n))
        },
    ];
    let mut panel = panel(title, abscissa, "force in y [N]", series);
    panel.x.label = panel.x.label.replace("the node", "the face");
    panel.x.label = format!("mean {}", panel.x.label);
    panel
}

fn panel(title: &str, abscissa: &Abscissa, y_label: &str, series: Vec<Series>) -> Panel {
    let all = || series.iter().flat_map(|series| &series.points);
    let x = Scale::spanning(abscissa.label, all().map(|point| point.0), 0.01);
    let y = Scale::spanning(y_label, all().map(|point| point.1), 1e-6);
    Panel { series, ..Panel::new(title, x, y) }
}

//! Hysteresis loops: friction over slip, and friction over displacement.

use super::style::{MICRO, STATES, colour_of, fine, joined, thick};
use crate::inspect::inspection::Inspection;
use crate::inspect::loops::{self, LoopEnergies, LoopPoint};
use crate::publish::chart::{At, Chart, Panel, Pen, Scale, palette};
use crate::publish::value::significant;

/// The abscissa of a panel and what its area is.
struct Abscissa {
    of_node: &'static str,
    of_face: &'static str,
    of: fn(&LoopPoint) -> Option<f64>,
    energy: fn(&LoopEnergies) -> f64,
    area: &'static str,
    /// Whether it begins again at zero in every cycle. Otherwise the path of a cycle is closed.
    restarts: bool,
}

const ABSCISSAS: [Abscissa; 2] = [
    Abscissa {
        of_node: "slip of the disk along the node since the cycle began [µm]",
        of_face: "mean slip of the disk along the face since the cycle began [µm]",
        of: |point| Some(point.slip_m * MICRO),
        energy: |energies| energies.friction_j,
        area: "dissipated",
        restarts: true,
    },
    Abscissa {
        of_node: "displacement in y [µm]",
        of_face: "mean displacement in y [µm]",
        of: |point| point.y_m.map(|y_m| y_m * MICRO),
        energy: |energies| energies.into_pin_j,
        area: "into the pin",
        restarts: false,
    },
];

/// For every observed node friction over slip and over displacement; the same for the whole face.
pub fn loops(inspection: &Inspection) -> Chart {
    let summary = loops::summary(inspection);
    let what = if inspection.survey.windows.has_cycles { "per cycle" } else { "per period" };
    let title = |of: &str, abscissa: &Abscissa, energies: &LoopEnergies| {
        let microjoules = significant((abscissa.energy)(energies) * MICRO, 3).replace('-', "−");
        format!("{of}: {microjoules} µJ {} {what}", abscissa.area)
    };
    let mut panels = Vec::new();
    for (number, (observed, energies)) in inspection.observed.iter().zip(&summary.nodes).enumerate() {
        let points = loops::of_node(inspection, number);
        let panel = |abscissa| of_node(&title(&observed.node.title, abscissa, energies), abscissa, &points);
        panels.extend(ABSCISSAS.iter().map(panel));
    }
    let points = loops::of_face(inspection);
    let panel = |abscissa| of_face(&title("Whole contact face", abscissa, &summary.face), abscissa, &points);
    panels.extend(ABSCISSAS.iter().map(panel));
    Chart::stack(panels)
}

/// The parts of a loop in which a node is in each state. A part ends where the slip begins again at zero.
fn of_node(title: &str, abscissa: &Abscissa, points: &[LoopPoint]) -> Panel {
    let place = |point: &LoopPoint| (abscissa.of)(point).map(|x| (x, point.friction_n));
    let lines = STATES.map(|state| {
        let within = |pair: &[LoopPoint]| {
            let is_new_cycle = abscissa.restarts && pair[1].slip_m == 0.0 && pair[0].slip_m != 0.0;
            let is_shown = pair[0].state == Some(state) && !is_new_cycle;
            is_shown.then(|| Some([place(&pair[0])?, place(&pair[1])?])).flatten()
        };
        (state.name(), fine(colour_of(state)), joined(points.windows(2).map(within)))
    });
    panel(title, abscissa.of_node, "friction force in y [N]", lines)
}

fn of_face(title: &str, abscissa: &Abscissa, points: &[LoopPoint]) -> Panel {
    let path = |force: fn(&LoopPoint) -> Option<f64>| {
        let place = |point: &LoopPoint| Some(((abscissa.of)(point)?, force(point)?));
        let mut path: Vec<At> = points.iter().filter_map(place).collect();
        if !abscissa.restarts {
            path.extend(path.first().copied());
        }
        path
    };
    let lines = [
        ("friction of the face", thick(palette::colour(3, 8)), path(|point| Some(point.friction_n))),
        ("T at the clamp", fine(palette::colour(1, 8)), path(|point| point.clamp_n)),
    ];
    panel(title, abscissa.of_face, "force in y [N]", lines)
}

fn panel<const N: usize>(title: &str, x: &str, y: &str, lines: [(&str, Pen, Vec<At>); N]) -> Panel {
    let all = || lines.iter().flat_map(|(.., points)| points);
    let x = Scale::spanning(x, all().map(|point| point.0), 0.01);
    let y = Scale::spanning(y, all().map(|point| point.1), 1e-6);
    let mut panel = Panel::new(title, x, y);
    for (label, pen, points) in lines {
        panel.line(label, pen, points);
    }
    panel
}

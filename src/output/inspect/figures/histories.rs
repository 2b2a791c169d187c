//! Histories of the observed nodes.

use super::style::{
    MEGA, MICRO, MILLI, STATES, add_cells, add_level, add_marks, cells, colour_of, fine, joined, thick,
};
use crate::inspect::capture::NodeStep;
use crate::inspect::inspection::{Inspection, NodeFindings};
use crate::inspect::limit;
use crate::inspect::phases::Phase;
use crate::publish::chart::palette::{self, INK, Rgb};
use crate::publish::chart::{At, Chart, Entry, Layer, Panel, Scale};
use crate::solver::interface::ContactState;

/// A panel for every observed node.
fn of_nodes<'a>(
    inspection: &'a Inspection,
    panel: impl Fn(&'a NodeFindings, &'a [NodeStep]) -> Panel,
) -> Chart {
    let nodes = inspection.observed.iter().zip(&inspection.capture.nodes);
    Chart::stack(nodes.map(|(observed, steps)| panel(observed, steps)).collect())
}

/// Time in microseconds since the start of the time that is shown.
fn time_scale(inspection: &Inspection) -> (impl Fn(f64) -> f64 + Copy + use<>, Scale) {
    let [start_s, end_s] = inspection.survey.windows.shown_s;
    let since = move |time_s: f64| (time_s - start_s) * MICRO;
    (since, Scale::from_to("time [µs]", 0.0, (end_s - start_s) * MICRO))
}

/// Adds the velocity in y with its scale on the right side.
fn add_velocity(panel: &mut Panel, steps: &[NodeStep], since: impl Fn(f64) -> f64) {
    let point = |step: &NodeStep| (since(step.time_s), step.node.y_velocity_m_s * MILLI);
    let points: Vec<At> = steps.iter().map(point).collect();
    let values = points.iter().map(|point| point.1);
    panel.right = Some(Scale::spanning("velocity in y [mm/s]", values, 1.0));
    panel.explain(Entry::line(fine(INK), "velocity in y (right)"));
    panel.layers.push(Layer::Line { points, pen: fine(INK), right: true });
}

/// Adds the velocity of the disk under the node.
fn add_disk(panel: &mut Panel, observed: &NodeFindings, right: bool) {
    add_level(panel, "disk", observed.target_velocity_m_s * MILLI, right);
}

/// Adds the contact states as a ground.
fn add_bands(panel: &mut Panel, phases: &[Phase], since: impl Fn(f64) -> f64) {
    let colour: fn(ContactState) -> Rgb = |state| palette::lightened(colour_of(state));
    let everywhere = [f64::NEG_INFINITY, f64::INFINITY];
    add_cells(panel, cells(phases, since, everywhere, colour).collect(), colour);
}

/// Figure 2a.
pub fn displacements(inspection: &Inspection) -> Chart {
    of_nodes(inspection, |observed, steps| {
        let (since, x) = time_scale(inspection);
        let all = steps.iter().flat_map(|step| step.node.u_m).map(|u_m| u_m * MICRO);
        let y = Scale::spanning("displacement [µm]", all, 0.01);
        let mut panel = Panel::new(&observed.node.title, x, y);
        for (c, name) in ["x", "y", "z"].into_iter().enumerate() {
            let point = |step: &NodeStep| (since(step.time_s), step.node.u_m[c] * MICRO);
            let label = format!("displacement in {name}");
            panel.line(&label, thick(palette::colour(c, 3)), steps.iter().map(point).collect());
        }
        add_disk(&mut panel, observed, true);
        add_velocity(&mut panel, steps, since);
        panel
    })
}

/// Figure 2b.
pub fn friction(inspection: &Inspection) -> Chart {
    of_nodes(inspection, |observed, steps| {
        let (since, x) = time_scale(inspection);
        let most = limit::largest(&inspection.spec, steps.iter().map(|step| &step.node)).max(0.02);
        let mut panel = Panel::new(&observed.node.title, x, Scale::from_to("μ_eq", -0.05 * most, 1.2 * most));
        let point = |step: &NodeStep| (since(step.time_s), step.node.equivalent_friction());
        add_bands(&mut panel, &observed.phases, since);
        panel.line("μ_eq = |τ/σ_n|", thick(palette::colour(3, 8)), steps.iter().map(point).collect());
        add_velocity(&mut panel, steps, since);
        panel
    })
}

/// Figure 3b. Each state has the parts of the path in it, up to the first point of the next part.
pub fn phase_planes(inspection: &Inspection) -> Chart {
    of_nodes(inspection, |observed, steps| {
        let point = |step: &NodeStep| (step.node.u_m[1] * MICRO, step.node.y_velocity_m_s * MILLI);
        let x = Scale::spanning("displacement in y [µm]", steps.iter().map(|step| point(step).0), 0.01);
        let y = Scale::spanning("velocity in y [mm/s]", steps.iter().map(|step| point(step).1), 1.0);
        let mut panel = Panel::new(&observed.node.title, x, y);
        add_disk(&mut panel, observed, false);
        for state in STATES {
            let within =
                |pair: &[NodeStep]| (pair[0].node.state == state).then(|| [point(&pair[0]), point(&pair[1])]);
            panel.line(state.name(), thick(colour_of(state)), joined(steps.windows(2).map(within)));
        }
        panel
    })
}

/// Figure 4.
pub fn cycles(inspection: &Inspection) -> Chart {
    of_nodes(inspection, |observed, steps| {
        let windows = &inspection.survey.windows;
        let wanted_s =
            observed.instants.map_or(windows.shown_s, |instants| instants.span_s(windows.period_s));
        let (start_s, end_s) = (wanted_s[0].max(windows.shown_s[0]), wanted_s[1].min(windows.shown_s[1]));
        let since = |time_s: f64| (time_s - start_s) * MICRO;
        let is_within = |step: &&NodeStep| step.time_s >= start_s && step.time_s <= end_s;
        let within: Vec<NodeStep> = steps.iter().filter(is_within).copied().collect();
        let point = |step: &NodeStep| (since(step.time_s), step.stress_pa[2] * MEGA);
        let stress: Vec<At> = within.iter().map(point).collect();
        let values = stress.iter().map(|point| point.1).chain([0.0]);
        let y = Scale::spanning("normal contact stress [MPa]", values, 0.01);
        let x = Scale::from_to("time [µs]", 0.0, since(end_s));
        let mut panel = Panel::new(&observed.node.title, x, y);
        add_bands(&mut panel, &observed.phases, since);
        panel.line("normal stress", thick(palette::colour(3, 8)), stress);
        add_disk(&mut panel, observed, true);
        add_velocity(&mut panel, &within, since);
        let named = observed.instants.map_or_else(Vec::new, |instants| instants.named());
        add_marks(&mut panel, named.into_iter().map(|(letter, at_s)| (format!("t_{letter}"), since(at_s))));
        panel
    })
}

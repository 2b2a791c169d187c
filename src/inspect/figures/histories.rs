//! Histories of the observed nodes.

use super::style::{MEGA, MICRO, MILLI, STATES, colour_of, legend_position};
use crate::inspect::capture::NodeStep;
use crate::inspect::inspection::{Inspection, NodeFindings};
use crate::inspect::limit;
use crate::inspect::phases::Phase;
use crate::publish::plot::palette;
use crate::publish::plot::panel::{Band, Level, Mark, Panel, Scale, Series, Stroke};
use crate::solver::interface::ContactState;

/// A panel for every observed node.
fn for_each_node<'a>(
    inspection: &'a Inspection,
    panel: impl Fn(&'a NodeFindings, &'a [NodeStep]) -> Panel,
) -> Vec<Panel> {
    inspection
        .observed
        .iter()
        .zip(&inspection.capture.nodes)
        .map(|(observed, steps)| panel(observed, steps))
        .collect()
}

/// Time in microseconds since the start of the time that is shown.
fn time_scale(inspection: &Inspection) -> (impl Fn(f64) -> f64 + use<>, Scale) {
    let [start_s, end_s] = inspection.survey.windows.shown_s;
    let since = move |time_s: f64| (time_s - start_s) * MICRO;
    (since, Scale::from_to("time [µs]", 0.0, (end_s - start_s) * MICRO))
}

fn velocity(steps: &[NodeStep], since: impl Fn(f64) -> f64) -> (Series, Scale) {
    let points: Vec<_> =
        steps.iter().map(|step| (since(step.time_s), step.node.y_velocity_m_s * MILLI)).collect();
    let scale = Scale::spanning("velocity in y [mm/s]", points.iter().map(|point| point.1), 1.0);
    let label = Some("velocity in y (right)".to_owned());
    (Series { label, colour: plotters::style::BLACK, stroke: Stroke::Fine, right: true, points }, scale)
}

fn disk(observed: &NodeFindings, right: bool) -> Level {
    Level { label: "disk".to_owned(), at: observed.target_velocity_m_s * MILLI, right }
}

fn bands(phases: &[Phase], since: impl Fn(f64) -> f64) -> Vec<Band> {
    let band = |phase: &Phase| {
        let (label, colour) = (phase.state.name(), colour_of(phase.state));
        Band { label, colour, span: (since(phase.start_s), since(phase.end_s)) }
    };
    let mut bands: Vec<Band> = phases.iter().map(band).collect();
    bands.sort_by_key(|band| legend_position(band.label));
    bands
}

/// Figure 2a.
pub fn displacements(inspection: &Inspection) -> Vec<Panel> {
    for_each_node(inspection, |observed, steps| {
        let (since, x) = time_scale(inspection);
        let of = |c: usize| -> Vec<(f64, f64)> {
            steps.iter().map(|step| (since(step.time_s), step.node.u_m[c] * MICRO)).collect()
        };
        let components = ["x", "y", "z"].map(|name| format!("displacement in {name}"));
        let series: Vec<Series> = components
            .iter()
            .enumerate()
            .map(|(c, name)| Series::line(name, palette::colour(c, 3), of(c)))
            .collect();
        let all = series.iter().flat_map(|series| &series.points).map(|point| point.1);
        let y = Scale::spanning("displacement [µm]", all, 0.01);
        let (velocity, scale) = velocity(steps, &since);
        let mut panel = Panel::new(&observed.node.title, x, y);
        panel.right = Some(scale);
        panel.levels = vec![disk(observed, true)];
        panel.series = series;
        panel.series.push(velocity);
        panel
    })
}

/// Figure 2b.
pub fn friction(inspection: &Inspection) -> Vec<Panel> {
    for_each_node(inspection, |observed, steps| {
        let (since, x) = time_scale(inspection);
        let most = limit::largest(&inspection.spec, steps.iter().map(|step| &step.node)).max(0.02);
        let points: Vec<_> =
            steps.iter().map(|step| (since(step.time_s), step.node.equivalent_friction())).collect();
        let y = Scale::from_to("μ_eq", -0.05 * most, 1.2 * most);
        let (velocity, scale) = velocity(steps, &since);
        let mut panel = Panel::new(&observed.node.title, x, y);
        panel.right = Some(scale);
        panel.bands = bands(&observed.phases, &since);
        panel.series = vec![Series::line("μ_eq = |τ/σ_n|", palette::colour(3, 8), points), velocity];
        panel
    })
}

/// Figure 3b.
pub fn phase_planes(inspection: &Inspection) -> Vec<Panel> {
    for_each_node(inspection, |observed, steps| {
        let point = |step: &NodeStep| (step.node.u_m[1] * MICRO, step.node.y_velocity_m_s * MILLI);
        let x = Scale::spanning("displacement in y [µm]", steps.iter().map(|step| point(step).0), 0.01);
        let y = Scale::spanning("velocity in y [mm/s]", steps.iter().map(|step| point(step).1), 1.0);
        let mut panel = Panel::new(&observed.node.title, x, y);
        for state in STATES {
            panel.series.push(Series::line(state.name(), colour_of(state), path_in(state, steps, point)));
        }
        panel.levels = vec![disk(observed, false)];
        panel
    })
}

/// The parts of a path in which a node is in a state, each up to the first point of the next part.
fn path_in(
    state: ContactState,
    steps: &[NodeStep],
    point: impl Fn(&NodeStep) -> (f64, f64),
) -> Vec<(f64, f64)> {
    let mut path = Vec::new();
    for pair in steps.windows(2) {
        if pair[0].node.state == state {
            path.extend([point(&pair[0]), point(&pair[1])]);
        } else if path.last().is_some_and(|last: &(f64, f64)| last.0.is_finite()) {
            path.push((f64::NAN, f64::NAN));
        }
    }
    path
}

/// Figure 4.
pub fn cycles(inspection: &Inspection) -> Vec<Panel> {
    for_each_node(inspection, |observed, steps| {
        let [shown_start_s, shown_end_s] = inspection.survey.windows.shown_s;
        let wanted = observed.instants.map_or([shown_start_s, shown_end_s], |instants| {
            instants.span_s(inspection.survey.windows.period_s)
        });
        let (start_s, end_s) = (wanted[0].max(shown_start_s), wanted[1].min(shown_end_s));
        let since = |time_s: f64| (time_s - start_s) * MICRO;
        let x = Scale::from_to("time [µs]", 0.0, since(end_s));
        let within: Vec<NodeStep> =
            steps.iter().filter(|step| step.time_s >= start_s && step.time_s <= end_s).copied().collect();
        let stress: Vec<_> =
            within.iter().map(|step| (since(step.time_s), step.stress_pa[2] * MEGA)).collect();
        let all = stress.iter().map(|point| point.1).chain([0.0]);
        let y = Scale::spanning("normal contact stress [MPa]", all, 0.01);
        let (velocity, scale) = velocity(&within, since);
        let mut panel = Panel::new(&observed.node.title, x, y);
        panel.right = Some(scale);
        panel.bands = bands(&observed.phases, since);
        panel.levels = vec![disk(observed, true)];
        panel.marks = observed.instants.map_or_else(Vec::new, |instants| {
            let mark =
                |(letter, time_s): (char, f64)| Mark { label: format!("t_{letter}"), at: since(time_s) };
            instants.named().into_iter().map(mark).collect()
        });
        panel.series = vec![Series::line("normal stress", palette::colour(3, 8), stress), velocity];
        panel
    })
}

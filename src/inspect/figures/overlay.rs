//! Figure 8: the stresses at a node in several jobs.

use super::style::{MEGA, MICRO};
use crate::inspect::capture::NodeStep;
use crate::inspect::trace::Trace;
use crate::publish::FigureError;
use crate::publish::plot::palette;
use crate::publish::plot::panel::{Panel, Scale, Series, stack};

/// Draws normal and tangential stress over the time since the start of a cycle. `title` names what the jobs have in
/// common.
///
/// # Errors
/// [`FigureError`].
pub fn overlay(title: &str, traces: &[Trace]) -> Result<String, FigureError> {
    let longest_s = traces.iter().map(|trace| trace.duration_s).fold(f64::MIN_POSITIVE, f64::max);
    let panel = |title: &str, label: &str, value: &dyn Fn(&NodeStep) -> f64| {
        let series: Vec<Series> = traces
            .iter()
            .enumerate()
            .map(|(number, trace)| {
                let point = |step: &NodeStep| ((step.time_s - trace.from_s) * MICRO, value(step) * MEGA);
                let points = trace.steps.iter().map(point).collect();
                Series::line(&trace.label, palette::colour(number, traces.len()), points)
            })
            .collect();
        let all = series.iter().flat_map(|series| &series.points).map(|point| point.1).chain([0.0]);
        let y = Scale::spanning(label, all, 0.01);
        let x = Scale::from_to("time since a cycle began [µs]", 0.0, longest_s * MICRO);
        let mut panel = Panel::new(title, x, y);
        panel.series = series;
        panel
    };
    let name = traces.first().map_or("", |trace| trace.node.title.as_str());
    stack(&[
        panel(&format!("{title}; {name}; a) normal stress"), "σ_n [MPa]", &|step| step.stress_pa[2]),
        panel(&format!("{title}; {name}; b) tangential stress in y"), "τ_y [MPa]", &|step| {
            step.stress_pa[1]
        }),
    ])
}

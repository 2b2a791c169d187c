//! Figure 8: the stresses at a node in several jobs.

use super::style::{MEGA, MICRO, thick};
use crate::inspect::capture::NodeStep;
use crate::inspect::trace::Trace;
use crate::publish::chart::{At, Chart, Entry, Layer, Panel, Scale, palette};

/// Normal and tangential stress over the time since the start of a cycle. `title` names what the jobs have in common.
pub fn overlay(title: &str, traces: &[Trace]) -> Chart {
    let longest_s = traces.iter().map(|trace| trace.duration_s).fold(f64::MIN_POSITIVE, f64::max);
    let pen = |number: usize| thick(palette::colour(number, traces.len()));
    let panel = |(title, label, component): (&str, &str, usize)| {
        let line = |trace: &Trace| -> Vec<At> {
            let point =
                |step: &NodeStep| ((step.time_s - trace.from_s) * MICRO, step.stress_pa[component] * MEGA);
            trace.steps.iter().map(point).collect()
        };
        let lines: Vec<Vec<At>> = traces.iter().map(line).collect();
        let values = lines.iter().flatten().map(|point| point.1).chain([0.0]);
        let y = Scale::spanning(label, values, 0.01);
        let x = Scale::from_to("time since a cycle began [µs]", 0.0, longest_s * MICRO);
        let mut panel = Panel::new(title, x, y);
        let lines = lines.into_iter().enumerate();
        panel.layers =
            lines.map(|(number, points)| Layer::Line { points, pen: pen(number), right: false }).collect();
        panel
    };
    let stresses =
        [("a) normal stress", "σ_n [MPa]", 2), ("b) tangential stress in y", "τ_y [MPa]", 1)].map(panel);
    let name = traces.first().map_or("", |trace| trace.node.title.as_str());
    let entries = traces.iter().enumerate();
    Chart {
        title: format!("{title}; {name}"),
        legend: entries.map(|(number, trace)| Entry::line(pen(number), &trace.label)).collect(),
        ..Chart::stack(stresses.into())
    }
}

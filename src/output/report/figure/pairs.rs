//! The region that a calibration leaves, over each pair of its free parameters.

use crate::publish::chart::palette::{BLUE, GREY, VERMILLION};
use crate::publish::chart::{Axis, Chart, Entry, Layer, Marker, Panel, Point, Scale, Shape};
use crate::publish::value;
use crate::report::calibration::{Calibration, Free};
use crate::report::parameters;
use crate::units::name_and_unit;
use serde_json::Value;

impl Calibration {
    /// The region over each pair of parameters, with the points that were run; none with one parameter.
    pub(in crate::report) fn chart(&self) -> Option<Chart> {
        let inside = Marker::new(Shape::Circle, BLUE).sized(2.0);
        let run = Marker::new(Shape::Circle, GREY).sized(3.5).hollow(true);
        let best = Marker::new(Shape::Star, VERMILLION).sized(7.0);
        let unit = |free: &Free| value::multiple(name_and_unit(&free.name).1, free.range[1].abs());
        let scale = |free: &Free| {
            let (factor, unit) = unit(free);
            let values: Vec<Value> = free.range.iter().map(|x| Value::from(x / factor)).collect();
            let name = parameters::symbol(&free.name).unwrap_or(name_and_unit(&free.name).0);
            let label = if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") };
            Scale::new(&label, Axis::for_values(&values, Some(free.is_log)))
        };
        let mut panels = Vec::new();
        for (second, y) in self.free.iter().enumerate() {
            for (first, x) in self.free.iter().enumerate().take(second) {
                let points = |of: &mut dyn Iterator<Item = &Vec<f64>>, marker| {
                    let at = |values: &Vec<f64>| (values[first] / unit(x).0, values[second] / unit(y).0);
                    Layer::Points(
                        of.map(|values| Point { at: at(values), error: 0.0, marker, tip: None }).collect(),
                    )
                };
                let mut panel = Panel::new("", scale(x), scale(y));
                panel.layers.push(points(&mut self.run.iter(), run));
                panel.layers.push(points(&mut self.inside.iter(), inside));
                panel.layers.push(points(&mut self.best.iter().map(|best| &best.values), best));
                panels.push(panel);
            }
        }
        let legend = vec![
            Entry::marker(inside, "not ruled out"),
            Entry::marker(run, "runs"),
            Entry::marker(best, "best run"),
        ];
        (!panels.is_empty()).then(|| Chart { panels, legend, ..Chart::default() })
    }
}

/// The file of [`Calibration::chart`].
pub(in crate::report) const FILE: &str = "calibration.svg";

/// What it shows.
pub(in crate::report) const TITLE: &str = "pairs of the free parameters that are not ruled out";

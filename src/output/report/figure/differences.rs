//! How far a simulation is from other sources, over the axis of the report.

use crate::publish::chart::palette::{self, INK};
use crate::publish::chart::{Axis, Chart, Entry, Guide, Layer, Marker, Panel, Point, Scale, Shape};
use crate::report::comparison::{Comparison, Difference};
use crate::report::scalar::Scalar;
use serde_json::Value;

/// The file of the figure.
pub(in crate::report) const FILE: &str = "differences.svg";

/// What it shows.
pub(in crate::report) const TITLE: &str = "differences between the sources, in per cent";

/// A panel for each quantity; none if the axis has names, or if nothing is compared.
pub(in crate::report) fn draw(comparison: &Comparison) -> Option<Chart> {
    let mut scalars: Vec<&'static Scalar> = Vec::new();
    let mut sources: Vec<&str> = Vec::new();
    for found in &comparison.differences {
        if !scalars.contains(&found.scalar) {
            scalars.push(found.scalar);
        }
        if !sources.contains(&found.source.as_str()) {
            sources.push(&found.source);
        }
    }
    let marker = |source: &str| {
        let at = sources.iter().position(|own| *own == source).unwrap_or(0);
        Marker::new(Shape::Circle, palette::colour(at, sources.len())).sized(4.0)
    };
    let place = |found: &Difference| found.parameters.last().and_then(Value::as_f64);
    let places: Vec<Value> =
        comparison.differences.iter().filter_map(|own| Some(place(own)?.into())).collect();
    if places.is_empty() {
        return None;
    }
    let panel = |scalar: &&'static Scalar| {
        let own = comparison.differences.iter().filter(|found| found.scalar == *scalar);
        let points: Vec<Point> = own
            .filter_map(|found| {
                let error = 100.0 * found.error_of_deviation().unwrap_or(0.0);
                let at = (place(found)?, 100.0 * found.deviation()?);
                Some(Point { at, error, marker: marker(&found.source), tip: None })
            })
            .collect();
        let ends = points.iter().flat_map(|point| [point.at.1 - point.error, point.at.1 + point.error]);
        let y = Scale::spanning(&format!("difference of {} [%]", scalar.words()), ends.chain([0.0]), 1.0);
        let x = Scale::new(comparison.axis_label(), Axis::for_values(&places, None));
        let mut panel = Panel::new("", x, y);
        panel.layers.push(Layer::Guide(Guide::level(0.0, INK)));
        panel.layers.push(Layer::Points(points));
        panel
    };
    let legend = sources.iter().map(|source| Entry::marker(marker(source), source)).collect();
    Some(Chart { legend, ..Chart::stack(scalars.iter().map(panel).collect()) })
}

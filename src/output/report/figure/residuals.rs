//! The residuals of the energy balance and of the identities, for every job of a study.

use crate::analysis::JobRecord;
use crate::publish::chart::palette::{BLUE, VERMILLION};
use crate::publish::chart::{Axis, Chart, Entry, Layer, MAX_TIPS, Marker, Panel, Point, Scale, Shape, Tip};
use crate::publish::value;
use crate::report::row::JobRow;
use crate::report::tooltip::tooltip_text;
use serde_json::Value;

/// A kind of residual and its marker.
struct Kind {
    name: &'static str,
    label: &'static str,
    marker: Marker,
    of: fn(&JobRecord) -> f64,
}

const KINDS: [Kind; 2] = [
    Kind {
        name: "identity_residual",
        label: "identities",
        marker: Marker::new(Shape::Diamond, VERMILLION).sized(4.5),
        of: JobRecord::identity_residual,
    },
    Kind {
        name: "energy_residual",
        label: "energy balance",
        marker: Marker::new(Shape::Circle, BLUE).sized(4.5),
        of: |record| record.energy_residual.abs(),
    },
];

/// The residuals of all rows in their order. A residual of exactly zero is left out, because the axis is logarithmic.
pub(in crate::report) fn draw(rows: &[JobRow]) -> Chart {
    let point = |kind: &Kind, number: usize, row: &JobRow| {
        let residual = (kind.of)(row.record()?);
        let data = vec![
            ("job", row.job.clone()),
            ("x", number.to_string()),
            ("y", value::number(residual)),
            ("kind", kind.name.to_owned()),
        ];
        let tip = (rows.len() <= MAX_TIPS).then(|| Tip { title: tooltip_text(row), data });
        let point = Point { at: (number as f64, residual), error: 0.0, marker: kind.marker, tip };
        (residual.is_finite() && residual > 0.0).then_some(point)
    };
    let of_kind = |kind| rows.iter().enumerate().filter_map(move |(at, row)| point(kind, at + 1, row));
    let points: Vec<Point> = KINDS.iter().flat_map(of_kind).collect();
    let residuals: Vec<Value> = points.iter().map(|point| point.at.1.into()).collect();
    let x = Scale::new("job, in the order of the study", Axis::spanning(1.0, rows.len().max(1) as f64, 1.0));
    let mut panel = Panel::new("", x, Scale::new("residual", Axis::for_values(&residuals, Some(true))));
    panel.note = "no results yet".into();
    if !points.is_empty() {
        panel.layers.push(Layer::Points(points));
    }
    let legend = KINDS.iter().map(|kind| Entry::marker(kind.marker, kind.label)).collect();
    Chart { legend, ..Chart::of(panel) }
}

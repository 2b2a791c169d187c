//! The bifurcation diagram: over the speed, the range of the normal force and the amplitudes of the nodes. Steady sliding
//! has N/F = 1 and no amplitude; a limit cycle has two values of N/F and an amplitude.

use super::places::{self, Place};
use crate::analysis::{JobRecord, Outcome};
use crate::publish::chart::palette::GREY;
use crate::publish::chart::{Axis, Chart, Entry, Guide, Layer, Marker, Panel, Pen, Point, Scale, Shape};
use crate::publish::value;
use crate::report::layout::{Group, Layout};

/// Micrometres per metre.
const MICRO: f64 = 1e6;
/// Half the size of a marker \[px\].
const RADIUS: f64 = 4.0;

/// A figure of a record that a panel shows.
struct Quantity {
    name: &'static str,
    label: &'static str,
    shape: Shape,
    /// Whether a line joins its points.
    joined: bool,
    of: fn(&JobRecord) -> Option<f64>,
}

/// What a panel shows: its ordinate, a level that steady sliding has, and the least height of the ordinate.
struct Kind {
    label: &'static str,
    level: f64,
    least: f64,
    quantities: &'static [Quantity],
}

fn peak_to_peak_um(record: &JobRecord, name: &str) -> Option<f64> {
    record.nodes.iter().find(|node| node.name == name).map(|node| node.y_peak_to_peak_m * MICRO)
}

const HIGHEST: Quantity = Quantity {
    name: "n_over_f_max",
    label: "largest N/F",
    shape: Shape::Up,
    joined: true,
    of: |record| Some(record.n_over_f_max),
};
const LOWEST: Quantity = Quantity {
    name: "n_over_f_min",
    label: "smallest N/F",
    shape: Shape::Down,
    joined: true,
    of: |record| Some(record.n_over_f_min),
};
const FRONT: Quantity = Quantity {
    name: "front_centre_y_peak_to_peak_m",
    label: "front centre",
    shape: Shape::Circle,
    joined: true,
    of: |record| peak_to_peak_um(record, "front_centre"),
};
const REAR: Quantity = Quantity {
    name: "rear_centre_y_peak_to_peak_m",
    label: "rear centre",
    shape: Shape::Square,
    joined: false,
    of: |record| peak_to_peak_um(record, "rear_centre"),
};
const LIFT: Quantity = Quantity {
    name: "lift_max_m",
    label: "largest gap",
    shape: Shape::Circle,
    joined: true,
    of: |record| Some(record.lift_max_m * MICRO),
};
const KINDS: [Kind; 3] = [
    Kind { label: "N/F", level: 1.0, least: 0.1, quantities: &[HIGHEST, LOWEST] },
    Kind { label: "range of y [µm]", level: 0.0, least: 0.01, quantities: &[FRONT, REAR] },
    Kind { label: "lift [µm]", level: 0.0, least: 0.01, quantities: &[LIFT] },
];

/// The panels of a group one above the other, with a common abscissa.
pub(super) fn draw(layout: &Layout, group: &Group) -> Chart {
    let x = places::x_scale(layout);
    let all = places::places(layout, group, &x.axis);
    let looks = places::series(layout);
    let mut legend = vec![Entry::heading(places::series_title(layout))];
    legend.extend(looks.iter().map(|look| Entry::line(Pen::solid(look.colour, 2.0), &look.name)));
    for kind in &KINDS {
        legend.push(Entry::heading(kind.label));
        let shape = |own: &Quantity| Entry::marker(Marker::new(own.shape, GREY).sized(RADIUS), own.label);
        legend.extend(kind.quantities.iter().map(shape));
    }
    if all.iter().any(is_hollow) {
        let marker = Marker::new(Shape::Circle, GREY).sized(RADIUS).hollow(true);
        legend.push(Entry::marker(marker, "hollow: not periodic"));
    }
    let panels = KINDS.iter().map(|kind| kind.panel(&x, &all, &looks)).collect();
    Chart { title: group.caption(), legend, ..Chart::stack(panels) }
}

/// Whether a job has a result and did not become periodic.
fn is_hollow(place: &Place) -> bool {
    place.row.record().is_some_and(|record| record.outcome == Outcome::NotPeriodic)
}

impl Quantity {
    /// The value of a job that has one.
    fn value(&self, place: &Place) -> Option<f64> {
        (self.of)(place.row.record()?).filter(|y| y.is_finite())
    }

    fn point(&self, place: &Place, looks: &[places::SeriesLook]) -> Option<Point> {
        let y = self.value(place)?;
        let marker = Marker::new(self.shape, looks[place.series].colour).sized(RADIUS);
        let tip = place.tip([("y", value::number(y)), ("kind", self.name.to_owned())]);
        Some(Point { at: (place.x, y), error: 0.0, marker: marker.hollow(is_hollow(place)), tip: Some(tip) })
    }
}

impl Kind {
    fn panel(&self, x: &Scale, all: &[Place], looks: &[places::SeriesLook]) -> Panel {
        let value_of = |own: &'static Quantity| all.iter().filter_map(move |place| own.value(place));
        let (low, high) = self
            .quantities
            .iter()
            .flat_map(value_of)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
        // Without values there are no ticks, because they would suggest a scale.
        let axis = if low <= high {
            Axis::spanning(low.min(self.level), high.max(self.level), self.least)
        } else {
            Axis::Names(Vec::new())
        };
        let mut panel = Panel::new("", x.clone(), Scale::new(self.label, axis).without_grid());
        panel.note = "no results yet".into();
        if low > high {
            return panel;
        }
        panel.layers.push(Layer::Guide(Guide::level(self.level, GREY)));
        for own in all.chunk_by(|a, b| a.series == b.series) {
            for quantity in self.quantities.iter().filter(|quantity| quantity.joined) {
                // A job without a result interrupts the line.
                let at = |place: &Place| (place.x, quantity.value(place).unwrap_or(f64::NAN));
                let pen = Pen { cover: 0.7, ..Pen::solid(looks[own[0].series].colour, 1.5) };
                let points = own.iter().map(at).collect();
                panel.layers.push(Layer::Line { points, pen, right: false });
            }
        }
        let points = |place| self.quantities.iter().filter_map(move |own| own.point(place, looks));
        panel.layers.push(Layer::Points(all.iter().flat_map(points).collect()));
        panel
    }
}

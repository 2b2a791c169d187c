//! The bifurcation diagram: over the speed, the range of the normal force and the amplitudes of the nodes. Steady sliding
//! has N/F = 1 and no amplitude; a limit cycle has two values of N/F and an amplitude.

use super::places::{self, Place};
use crate::publish::chart::palette::GREY;
use crate::publish::chart::{Axis, Chart, Entry, Guide, Layer, Marker, Panel, Pen, Point, Scale, Shape};
use crate::publish::value;
use crate::report::layout::{Group, Layout};
use crate::report::scalar::Scalar;

/// Micrometres per metre.
const MICRO: f64 = 1e6;
/// Half the size of a marker \[px\].
const RADIUS: f64 = 4.0;

/// A quantity that a panel shows.
struct Shown {
    scalar: Scalar,
    label: &'static str,
    shape: Shape,
    /// Whether a line joins its points.
    joined: bool,
}

/// What a panel shows: its ordinate, what the quantities are multiplied by there, a level that steady sliding has, and the least height of
/// the ordinate.
struct Kind {
    label: &'static str,
    factor: f64,
    level: f64,
    least: f64,
    quantities: &'static [Shown],
}

const fn shown(name: &str, label: &'static str, shape: Shape, joined: bool) -> Shown {
    Shown { scalar: Scalar::of(name), label, shape, joined }
}

static RANGE: [Shown; 2] = [
    shown("n_over_f_max", "largest N/F", Shape::Up, true),
    shown("n_over_f_min", "smallest N/F", Shape::Down, true),
];
static AMPLITUDES: [Shown; 2] = [
    shown("front_centre_y_peak_to_peak_m", "front centre", Shape::Circle, true),
    shown("rear_centre_y_peak_to_peak_m", "rear centre", Shape::Square, false),
];
static LIFT: [Shown; 1] = [shown("lift_max_m", "largest gap", Shape::Circle, true)];
static KINDS: [Kind; 3] = [
    Kind { label: "N/F", factor: 1.0, level: 1.0, least: 0.1, quantities: &RANGE },
    Kind { label: "range of y [µm]", factor: MICRO, level: 0.0, least: 0.01, quantities: &AMPLITUDES },
    Kind { label: "lift [µm]", factor: MICRO, level: 0.0, least: 0.01, quantities: &LIFT },
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
        let shape = |own: &Shown| Entry::marker(Marker::new(own.shape, GREY).sized(RADIUS), own.label);
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
    place.row.is_open()
}

impl Kind {
    /// The value of a job that has one, in the unit of the ordinate.
    fn value(&self, quantity: &Shown, place: &Place) -> Option<f64> {
        place.row.record()?;
        Some(quantity.scalar.value(place.row)? * self.factor)
    }

    fn point(&self, quantity: &Shown, place: &Place, looks: &[places::SeriesLook]) -> Option<Point> {
        let y = self.value(quantity, place)?;
        let marker = Marker::new(quantity.shape, looks[place.series].colour).sized(RADIUS);
        let tip = place.tip([("y", value::number(y)), ("kind", quantity.scalar.name.to_owned())]);
        Some(Point { at: (place.x, y), error: 0.0, marker: marker.hollow(is_hollow(place)), tip: Some(tip) })
    }

    fn panel(&self, x: &Scale, all: &[Place], looks: &[places::SeriesLook]) -> Panel {
        let value_of = |own| all.iter().filter_map(move |place| self.value(own, place));
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
                let at = |place: &Place| (place.x, self.value(quantity, place).unwrap_or(f64::NAN));
                let pen = Pen { cover: 0.7, ..Pen::solid(looks[own[0].series].colour, 1.5) };
                let points = own.iter().map(at).collect();
                panel.layers.push(Layer::Line { points, pen, right: false });
            }
        }
        let points = |place| self.quantities.iter().filter_map(move |own| self.point(own, place, looks));
        panel.layers.push(Layer::Points(all.iter().flat_map(points).collect()));
        panel
    }
}

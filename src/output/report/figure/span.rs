//! The span of a number where only the parameter along the axis and that of the curves are known: a panel for each curve, with the band
//! between the smallest and the largest value of all jobs that have settled, and the line of the first source if that has one job at each place. A dot is a job in the colour of its source.
//! The mean of a run that is not periodic is a hollow dot, and no part of band and line.

use super::curves::is_periodic;
use super::places::{self, Place};
use crate::publish::chart::palette::{self, GREY, INK};
use crate::publish::chart::{At, Chart, Entry, Guide, Layer, Marker, Panel, Pen, Point, Scale, Shape};
use crate::publish::value;
use crate::report::layout::{Group, Layout};
use crate::report::parameters::MU;
use crate::report::scalar::Scalar;

/// How much the band covers of what is behind it.
const COVER: f64 = 0.25;
/// Half the size of a job's dot \[px\].
const RADIUS: f64 = 3.0;

/// All panels, from the jobs of all groups.
pub(super) fn draw(layout: &Layout, groups: &[Group], scalar: &Scalar) -> Chart {
    let x = places::x_scale(layout);
    let has_value = |place: &Place| scalar.value(place.row).is_some();
    let mut jobs: Vec<Place> =
        groups.iter().flat_map(|group| places::places(layout, group, &x.axis)).filter(has_value).collect();
    let value_of = |place: &Place| layout.series[place.series].value_index;
    jobs.sort_by(|a, b| value_of(a).cmp(&value_of(b)).then(a.x.total_cmp(&b.x)));
    let panel = |own: &[Place]| {
        let series = &layout.series[own[0].series];
        let guide = series.value.as_f64().filter(|_| layout.by == MU);
        let title =
            format!("{} = {}", places::series_title(layout), layout.dimension(layout.by).text(&series.value));
        let values = own.iter().filter_map(|place| scalar.value(place.row));
        let y = Scale::spanning(&scalar.title(), values.chain(guide), 0.02);
        let layers = layers(layout, scalar, own, guide);
        Panel { layers, ..Panel::new(&title, x.clone(), y.without_grid()) }
    };
    let panels = jobs.chunk_by(|a, b| value_of(a) == value_of(b)).map(panel).collect();
    let has_hollow = jobs.iter().any(|place| !is_periodic(place.row));
    Chart { panels, legend: legend(layout, has_hollow), ..Chart::default() }
}

/// The band, the lines and the dots of a panel.
fn layers(layout: &Layout, scalar: &Scalar, own: &[Place], guide: Option<f64>) -> Vec<Layer> {
    let value = |place: &Place| scalar.value(place.row);
    let is_first = |place: &&Place| layout.series[place.series].source == 0;
    let (mut below, mut above, mut line): (Vec<At>, Vec<At>, Vec<At>) = Default::default();
    for here in own.chunk_by(|a, b| a.x == b.x) {
        // Several jobs of the first source have no line of their own, also where only one of them has settled.
        let first = only(here.iter().filter(is_first)).filter(|place| is_periodic(place.row)).and_then(value);
        line.extend(first.map(|y| (here[0].x, y)));
        let here: Vec<&Place> = here.iter().filter(|place| is_periodic(place.row)).collect();
        // Where there is one job alone, nothing is known about the others.
        if here.len() < 2 {
            continue;
        }
        let (low, high) = here
            .iter()
            .filter_map(|place| value(place))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
        below.push((here[0].x, low));
        above.push((here[0].x, high));
    }
    let corners = below.into_iter().chain(above.into_iter().rev()).collect();
    let dot = |place: &Place| {
        let source = layout.series[place.series].source;
        let marker = dot_of(layout, source).hollow(!is_periodic(place.row));
        let tip = place.tip([("y", value::number(value(place)?))]);
        Some(Point { at: (place.x, value(place)?), error: 0.0, marker, tip: Some(tip) })
    };
    let guide = guide.map(|at| Layer::Guide(Guide::level(at, GREY)));
    let line = Layer::Line { points: line, pen: Pen::solid(INK, 2.0), right: false };
    let dots = Layer::Points(own.iter().filter_map(dot).collect());
    guide.into_iter().chain([Layer::Area(corners, GREY, COVER), line, dots]).collect()
}

/// The only item, if there is one alone.
fn only<T>(mut items: impl Iterator<Item = T>) -> Option<T> {
    items.next().filter(|_| items.next().is_none())
}

fn dot_of(layout: &Layout, source: usize) -> Marker {
    let shape = if layout.sources[source].is_measured { Shape::Cross } else { Shape::Circle };
    let colour = if source == 0 { INK } else { palette::colour(source - 1, layout.sources.len() - 1) };
    Marker::new(shape, colour).sized(RADIUS)
}

fn legend(layout: &Layout, has_hollow: bool) -> Vec<Entry> {
    let band = Entry::line(Pen { cover: COVER, ..Pen::solid(GREY, 12.0) }, "smallest to largest");
    let mut entries = vec![band];
    if layout.by == MU {
        entries.push(Entry::line(Guide::level(0.0, GREY).pen, "μ* = μ"));
    }
    entries.push(Entry::heading("source"));
    let of_source = |(index, source): (usize, &crate::report::layout::Source)| {
        Entry::marker(dot_of(layout, index), source.name)
    };
    entries.extend(layout.sources.iter().enumerate().map(of_source));
    if has_hollow {
        let marker = Marker::new(Shape::Circle, GREY).sized(RADIUS).hollow(true);
        entries.push(Entry::marker(marker, "hollow: not periodic"));
    }
    entries
}

//! Curves of a number over a parameter: a panel for each group, and a colour for each value of the curves' parameter. The shape
//! of a marker is the contact regime, and a hollow marker is a state that is not periodic. Measured points have crosses.

use super::places::{self, Place};
use crate::analysis::{Outcome, Regime};
use crate::publish::chart::palette::{GREY, INK};
use crate::publish::chart::{
    At, Axis, Chart, Entry, Guide, Layer, Marker, Panel, Pen, Point, Rgb, Scale, Shape,
};
use crate::publish::value;
use crate::report::layout::{Group, Layout};
use crate::report::parameters::{MU, SOURCE};
use crate::report::row::JobRow;
use crate::report::scalar::{FREQUENCY, MU_STAR, Scalar};

const REGIMES: [Regime; 5] = [
    Regime::Stable,
    Regime::StickSlip,
    Regime::StickSlipSeparation,
    Regime::SlipSeparation,
    Regime::Undecided,
];
/// Width of a curve \[px\].
const CURVE: f64 = 2.0;
/// Dashes of the studies' lines; none for the first study.
const DASHES: [(f64, f64); 4] = [(0.0, 0.0), (14.0, 5.0), (3.0, 4.0), (22.0, 8.0)];
/// Marks of the files of measured points.
const MARKS: [Shape; 3] = [Shape::Cross, Shape::Plus, Shape::Star];
/// How much the band of an error covers of what is behind it.
const COVER: f64 = 0.22;
/// Half the width of the band of a single point, relative to the plot.
const HALF_BAND: f64 = 0.008;

/// The friction coefficients with a line μ\* = μ, and its colour.
type Guides = Vec<(f64, Rgb)>;

/// How the results of a source are drawn: lines of a study, marks of measured points.
#[derive(Clone, Copy)]
enum Source {
    Lines((f64, f64)),
    Marks(Shape),
}

/// What all panels of a figure share.
struct Frame<'a> {
    layout: &'a Layout<'a>,
    scalar: &'a Scalar,
    x: Scale,
    /// So many units of the scalar are one of the ordinate.
    per_unit: f64,
    /// Half the size of a marker \[px\].
    radius: f64,
}

/// The curves of some groups.
pub(super) fn draw(layout: &Layout, groups: &[Group], scalar: &Scalar) -> Chart {
    let x = places::x_scale(layout);
    let results_of = |group| -> Vec<Place> {
        places::places(layout, group, &x.axis).into_iter().filter(|place| place.row.has_result()).collect()
    };
    let results: Vec<Vec<Place>> = groups.iter().map(results_of).collect();
    let counted = counted(scalar, &results);
    let largest =
        counted.iter().filter_map(|place| scalar.value(place.row)).map(f64::abs).fold(0.0, f64::max);
    let (per_unit, unit) = value::multiple(scalar.unit(), largest);
    let frame = Frame { layout, scalar, x, per_unit, radius: radius(&results) };
    let guides: Vec<Guides> = groups.iter().map(|group| frame.guides(group)).collect();
    let label = if unit.is_empty() { scalar.title() } else { format!("{} [{unit}]", scalar.meaning) };
    let y = Scale::new(&label, frame.y_axis(&counted, guides.iter().flatten().map(|guide| guide.0)));
    // The guide lines are horizontal; lines of a grid could be taken for them.
    let y = if scalar == MU_STAR { y.without_grid() } else { y };
    let panel = |(group, (results, guides)): (&Group, (&Vec<Place>, &Guides))| {
        let layers = frame.layers(results, guides);
        let note = note(scalar).to_owned();
        Panel { layers, note, ..Panel::new(&group.caption(), frame.x.clone(), y.clone()) }
    };
    let panels = groups.iter().zip(results.iter().zip(&guides)).map(panel).collect();
    let all: Vec<Place> = results.iter().flatten().copied().collect();
    Chart { panels, legend: frame.legend(&all, guides.iter().any(|own| !own.is_empty())), ..Chart::default() }
}

/// The results that count for the range of the ordinate: the settled ones, and all if there are none.
fn counted<'a>(scalar: &Scalar, results: &[Vec<Place<'a>>]) -> Vec<Place<'a>> {
    let with_value = || results.iter().flatten().filter(|place| scalar.value(place.row).is_some()).copied();
    let settled: Vec<Place> = with_value().filter(|place| scalar.is_settled(place.row)).collect();
    if settled.is_empty() { with_value().collect() } else { settled }
}

/// Half the size of the markers \[px\]: they are smaller where there are many of them.
fn radius(results: &[Vec<Place>]) -> f64 {
    let of_panel = |own: &Vec<Place>| own.chunk_by(|a, b| a.series == b.series).map(<[Place]>::len).max();
    let beside_one_another = match results.len() {
        0 | 1 => 1,
        2..=4 => 2,
        _ => 3,
    };
    match beside_one_another * results.iter().filter_map(of_panel).max().unwrap_or(0) {
        0..=16 => 5.0,
        17..=40 => 4.0,
        41..=90 => 3.0,
        _ => 2.0,
    }
}

fn note(scalar: &Scalar) -> &'static str {
    if scalar == FREQUENCY {
        "no frequencies: no results yet, or all of them stable"
    } else {
        "no results yet"
    }
}

/// The error of the value by the mesh, where it is known.
fn mesh_error(scalar: &Scalar, row: &JobRow) -> Option<f64> {
    scalar.mesh_error(row).filter(|error| *error > 0.0 && scalar.is_settled(row))
}

/// The marker of a job in a regime.
fn marker(regime: Regime, is_periodic: bool, colour: Rgb) -> Marker {
    let shape = match regime {
        Regime::Stable | Regime::Undecided => Shape::Circle,
        Regime::StickSlip => Shape::Up,
        Regime::StickSlipSeparation => Shape::Square,
        Regime::SlipSeparation => Shape::Diamond,
    };
    Marker::new(shape, colour).hollow(!is_periodic || regime == Regime::Undecided)
}

/// Whether a run became periodic or came to rest, as measured points are taken to be.
pub(super) fn is_periodic(row: &JobRow) -> bool {
    row.record().is_none_or(|record| record.outcome != Outcome::NotPeriodic)
}

impl Frame<'_> {
    fn value(&self, place: &Place) -> Option<f64> {
        Some(self.scalar.value(place.row)? / self.per_unit)
    }

    fn error(&self, place: &Place) -> f64 {
        self.scalar.error(place.row).unwrap_or(0.0) / self.per_unit
    }

    fn mesh_error(&self, place: &Place) -> Option<f64> {
        Some(mesh_error(self.scalar, place.row)? / self.per_unit)
    }

    fn source(&self, source: usize) -> Source {
        let is_measured = |index: usize| self.layout.sources.get(index).is_some_and(|own| own.is_measured);
        let number = (0..source).filter(|&other| is_measured(other) == is_measured(source)).count();
        if is_measured(source) {
            Source::Marks(MARKS[number % MARKS.len()])
        } else {
            Source::Lines(DASHES[number % DASHES.len()])
        }
    }

    /// The friction coefficients at which a panel has a line μ\* = μ, each with its colour. There is none where a law has other
    /// coefficients too, and none if the curves have several coefficients but are not curves of a coefficient.
    fn guides(&self, group: &Group) -> Guides {
        if self.scalar != MU_STAR {
            return Vec::new();
        }
        let has_one_mu = |series: Option<usize>| {
            let own = group.jobs.iter().filter(|job| series.is_none_or(|series| job.series == series));
            own.filter(|job| !job.row.is_measured()).all(|job| job.row.has_one_mu)
        };
        if self.layout.by == MU {
            let guide = |(number, series): (usize, &crate::report::layout::Series)| {
                let mu = series.value.as_f64().filter(|_| has_one_mu(Some(number)))?;
                Some((mu, places::colour(self.layout, series)))
            };
            let mut guides: Guides = self.layout.series.iter().enumerate().filter_map(guide).collect();
            guides.dedup_by(|a, b| a.0.to_bits() == b.0.to_bits());
            return guides;
        }
        let mut mus = group.jobs.iter().map(|job| job.row.parameters.mu()).filter(|mu| mu.is_finite());
        let first = mus.next();
        let is_same = mus.all(|mu| Some(mu) == first);
        first.filter(|_| is_same && has_one_mu(None)).map(|mu| (mu, GREY)).into_iter().collect()
    }

    /// Around the results with their errors. Without values there are no ticks, because they would suggest a scale.
    fn y_axis(&self, counted: &[Place], guides: impl Iterator<Item = f64>) -> Axis {
        let with_errors = |place: &Place| {
            let y = self.value(place)?;
            let error = self.error(place).max(self.mesh_error(place).unwrap_or(0.0));
            Some([y - error, y + error])
        };
        let mut ends: Vec<f64> = counted.iter().filter_map(with_errors).flatten().collect();
        if ends.is_empty() {
            return Axis::Names(Vec::new());
        }
        ends.extend(guides);
        let (low, high) = ends
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(*y), high.max(*y)));
        // Smaller differences must not fill the height of the figure.
        let least = match 0.05 * high.abs().max(low.abs()) {
            _ if self.scalar == MU_STAR => 0.02,
            share if self.scalar == FREQUENCY => share.max(1.0 / self.per_unit),
            share if share > 0.0 => share,
            _ => 1.0,
        };
        if self.scalar.is_signed() && low < 0.0 {
            Axis::around_zero(ends.into_iter(), least)
        } else {
            Axis::spanning(low, high, least)
        }
    }

    /// What a panel has: guides, bands, curves, and points on top; nothing if it has no points.
    fn layers(&self, results: &[Place], guides: &[(f64, Rgb)]) -> Vec<Layer> {
        let points: Vec<Point> = results.iter().filter_map(|place| self.point(place)).collect();
        if points.is_empty() {
            return Vec::new();
        }
        let guide = |(mu, colour): &(f64, Rgb)| Layer::Guide(Guide::level(*mu, *colour));
        let (mut bands, mut curves) = (Vec::new(), Vec::new());
        for own in results.chunk_by(|a, b| a.series == b.series) {
            let series = &self.layout.series[own[0].series];
            let colour = places::colour(self.layout, series);
            let curve = self.curve(own);
            let dash = match self.source(series.source) {
                Source::Lines(dash) if self.layout.scattered.is_empty() => Some(dash),
                _ => None,
            };
            bands.extend(self.bands(own, &curve, dash.is_some(), colour));
            let is_line = curve.windows(2).any(|pair| pair.iter().all(|(_, y)| y.is_finite()));
            if let Some(dash) = dash.filter(|_| is_line) {
                curves.push(Layer::Line {
                    points: curve,
                    pen: Pen { dash, ..Pen::solid(colour, CURVE) },
                    right: false,
                });
            }
        }
        let below = guides.iter().map(guide).chain(bands).chain(curves);
        below.chain([Layer::Points(points)]).collect()
    }

    /// The points of a curve. Jobs at the same position are represented by their mean. A job that is done but has no value that
    /// counts (no frequency, because nothing oscillates or because the run is not periodic) interrupts it, because it would
    /// otherwise claim a value there.
    fn curve(&self, own: &[Place]) -> Vec<At> {
        let mean = |here: &[Place]| {
            let settled = here.iter().filter(|place| self.scalar.is_settled(place.row));
            let values: Vec<f64> = settled.filter_map(|place| self.value(place)).collect();
            // Without values this is no number, which interrupts a line.
            (here[0].x, values.iter().sum::<f64>() / values.len() as f64)
        };
        own.chunk_by(|a, b| a.x == b.x).map(mean).collect()
    }

    /// The bands that the mesh error makes along a curve and beside single points.
    fn bands(&self, own: &[Place], curve: &[At], is_joined: bool, colour: Rgb) -> Vec<Layer> {
        let edge = |(here, (x, y)): (&[Place], &At)| {
            let error = here.iter().filter_map(|place| self.mesh_error(place)).reduce(f64::max)?;
            y.is_finite().then_some([(*x, y - error), (*x, y + error)])
        };
        let here = own.chunk_by(|a, b| a.x == b.x);
        let edges: Vec<Option<[At; 2]>> = here.zip(curve).map(edge).collect();
        let alone = |[low, high]: &[At; 2]| {
            let at = self.x.axis.place(low.0);
            let [left, right] = [-HALF_BAND, HALF_BAND].map(|half| self.x.axis.value_at(at + half));
            vec![(left, low.1), (right, low.1), (right, high.1), (left, high.1)]
        };
        let mut bands = Vec::new();
        for run in edges.split(Option::is_none) {
            let run: Vec<&[At; 2]> = run.iter().flatten().collect();
            if !is_joined || run.len() == 1 {
                bands.extend(run.into_iter().map(alone));
            } else if !run.is_empty() {
                let above = run.iter().rev().map(|own| own[1]);
                bands.push(run.iter().map(|own| own[0]).chain(above).collect());
            }
        }
        bands.into_iter().map(|corners| Layer::Area(corners, colour, COVER)).collect()
    }

    fn point(&self, place: &Place) -> Option<Point> {
        let y = self.value(place)?;
        let series = &self.layout.series[place.series];
        let colour = places::colour(self.layout, series);
        let marker = match (place.row.record(), self.source(series.source)) {
            (Some(record), _) => marker(record.regime, is_periodic(place.row), colour),
            (None, Source::Marks(shape)) => Marker::new(shape, colour),
            (None, Source::Lines(_)) => Marker::new(Shape::Cross, colour),
        };
        let mu = place.row.parameters.mu();
        let mu = if mu.is_nan() { String::new() } else { value::number(mu) };
        let tip = place.tip([("y", value::number(self.scalar.value(place.row)?)), ("mu", mu)]);
        let marker = marker.sized(self.radius);
        Some(Point { at: (place.x, y), error: self.error(place), marker, tip: Some(tip) })
    }

    /// Values of the curves' parameter by colour, sources by line or mark, regimes by shape.
    fn legend(&self, results: &[Place], has_guides: bool) -> Vec<Entry> {
        let layout = self.layout;
        let with_value: Vec<&Place> = results.iter().filter(|place| self.value(place).is_some()).collect();
        let is_shown = |series: usize| {
            // Stable jobs have no frequency: a legend with their curves would promise something that is not there.
            self.scalar != FREQUENCY || with_value.iter().any(|place| place.series == series)
        };
        let shown = (0..layout.series.len()).filter(|&series| is_shown(series));
        let mut values: Vec<_> =
            shown.map(|index| &layout.series[index]).filter(|series| !series.value.is_null()).collect();
        values.dedup_by_key(|series| series.value_index);
        // The points of one study need no name.
        values.retain(|_| layout.by != SOURCE || layout.sources.len() > 1);
        let sample = |source: Source, colour: Rgb, text: &str| match source {
            Source::Lines(dash) => Entry::line(Pen { dash, ..Pen::solid(colour, CURVE) }, text),
            Source::Marks(shape) => Entry::marker(Marker::new(shape, colour), text),
        };
        let title = &layout.dimension(layout.by).title;
        let mut entries: Vec<Entry> = values.first().map(|_| Entry::heading(title)).into_iter().collect();
        entries.extend(values.iter().map(|series| {
            let source =
                if layout.has_sources() { Source::Lines(DASHES[0]) } else { self.source(series.source) };
            let text = layout.dimension(layout.by).text(&series.value);
            sample(source, places::colour(layout, series), &text)
        }));
        if has_guides {
            entries.push(Entry::line(Guide::level(0.0, INK).pen, "μ* = μ"));
        }
        if with_value.iter().any(|place| mesh_error(self.scalar, place.row).is_some()) {
            let band = Pen { cover: 2.0 * COVER, ..Pen::solid(GREY, 12.0) };
            entries.push(Entry::line(band, "mesh error"));
        }
        if layout.has_sources() {
            entries.push(Entry::heading("source"));
            let sources = layout.sources.iter().enumerate();
            entries.extend(sources.map(|(index, own)| sample(self.source(index), GREY, own.name)));
        }
        entries.extend(regimes(&with_value));
        entries
    }
}

/// The entries of the shapes that occur.
fn regimes(results: &[&Place]) -> Vec<Entry> {
    let regimes =
        || results.iter().filter_map(|place| Some((place.row.record()?.regime, is_periodic(place.row))));
    let occurs = |regime: &Regime| regimes().any(|(own, _)| own == *regime);
    let entry = |regime| Entry::marker(marker(regime, true, GREY), regime.label());
    let mut entries: Vec<Entry> = REGIMES.into_iter().filter(occurs).map(entry).collect();
    if !entries.is_empty() {
        entries.insert(0, Entry::heading("contact regime"));
    }
    let hollow = regimes().find(|(regime, periodic)| !periodic && *regime != Regime::Undecided);
    entries
        .extend(hollow.map(|(regime, _)| Entry::marker(marker(regime, false, GREY), "hollow: not periodic")));
    entries
}

//! The waterfall: spectra of the normal force over the speed, one strip for each job whose spectrum is stored, and a panel
//! for each friction coefficient.

use super::edges::CellEdges;
use super::places::{self, Place};
use crate::analysis::Outcome;
use crate::publish::chart::palette::{self, INK, PAPER};
use crate::publish::chart::{
    Axis, Cell, Chart, ColourScale, Entry, Layer, Marker, Panel, Point, Rgb, Scale, Shape,
};
use crate::publish::value;
use crate::report::layout::{Group, Layout};
use crate::report::spectra::{Spectra, StoredSpectrum};

/// Number of bands of frequencies in a strip.
const BANDS: usize = 150;
/// The frequencies reach to this multiple of the largest fundamental frequency.
const HARMONICS: f64 = 6.0;
/// Number of colours, and how many decibels each of them stands for.
const COLOURS: u32 = 12;
const DECIBELS: f64 = 5.0;
/// Largest height of a strip relative to the plot.
const STRIP: f64 = 0.31;

/// A job whose spectrum is stored.
struct Strip<'a> {
    place: Place<'a>,
    spectrum: &'a StoredSpectrum,
}

/// The strips of a group, one list for each series that has some.
fn strips<'a>(places: &[Place<'a>], spectra: &'a Spectra) -> Vec<Vec<Strip<'a>>> {
    let strip = |place: &Place<'a>| Some(Strip { place: *place, spectrum: spectra.get(&place.row.job)? });
    let mut all: Vec<Vec<Strip>> = Vec::new();
    for own in places.chunk_by(|a, b| a.series == b.series) {
        let strips: Vec<Strip> = own.iter().filter_map(strip).collect();
        if !strips.is_empty() {
            all.push(strips);
        }
    }
    all
}

/// Largest frequency [Hz] of the figure.
fn last_hz(strips: &[Vec<Strip>]) -> f64 {
    let all = || strips.iter().flatten();
    let is_periodic =
        |strip: &&Strip| strip.place.row.record().is_some_and(|record| record.outcome == Outcome::Periodic);
    let fundamental = all().filter(is_periodic).filter_map(|strip| strip.place.row.record()?.frequency_hz);
    let stored = all().map(|strip| strip.spectrum.last_hz()).fold(0.0, f64::max);
    let wanted = HARMONICS * fundamental.fold(0.0, f64::max);
    // Without a fundamental frequency, the part where the strong lines are.
    let strong = || all().map(|strip| HARMONICS * strongest_hz(strip.spectrum)).fold(0.0, f64::max);
    (if wanted > 0.0 { wanted } else { strong() }).clamp(f64::MIN_POSITIVE, stored.max(f64::MIN_POSITIVE))
}

fn strongest_hz(spectrum: &StoredSpectrum) -> f64 {
    spectrum.lines.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0.0, |line| line.0)
}

/// The level [dB re 1 N] of an amplitude [N].
fn level_db(amplitude_n: f64) -> f64 {
    20.0 * amplitude_n.max(1e-12).log10()
}

/// The colour of a level: the number of the step below the highest level.
fn step_below(level: f64, highest: f64) -> u32 {
    (((highest - level) / DECIBELS).max(0.0) as u32).min(COLOURS - 1)
}

fn colour(step: u32) -> Rgb {
    // Dark is strong: a weak line is nearly white, like the paper.
    if step + 1 == COLOURS { PAPER } else { palette::sequential(f64::from(step) / f64::from(COLOURS - 2)) }
}

/// The panels of a group.
pub(super) fn draw(layout: &Layout, group: &Group, spectra: &Spectra) -> Chart {
    let mut y = places::x_scale(layout).without_grid();
    let own = strips(&places::places(layout, group, &y.axis), spectra);
    // All figures of a report have the same axes and colours.
    let of_group = |group| strips(&places::places(layout, group, &y.axis), spectra);
    let everywhere: Vec<Vec<Strip>> = layout.groups.iter().flat_map(of_group).collect();
    if !matches!(y.axis, Axis::Names(_)) {
        // The strips of the lowest and of the highest speed are as high as the others.
        let places = everywhere.iter().flatten().map(|strip| strip.place.x);
        y.axis = CellEdges::of(places, matches!(y.axis, Axis::Log(_))).axis;
    }
    let last_hz = last_hz(&everywhere);
    let (per_unit, unit) = value::multiple("Hz", last_hz);
    let highest = everywhere
        .iter()
        .flatten()
        .map(|strip| level_db(strip.spectrum.largest_in(0.0, last_hz)))
        .fold(f64::NEG_INFINITY, f64::max);
    let x = Scale::from_to(&format!("frequency [{unit}]"), 0.0, last_hz / per_unit).without_grid();
    let levels = Levels { last_hz, per_unit, highest };
    let looks = places::series(layout);
    let panel = |strips: &Vec<Strip>| {
        let name = &looks[strips[0].place.series].name;
        Panel { layers: levels.layers(strips, &y.axis), ..Panel::new(name, x.clone(), y.clone()) }
    };
    let mut panels: Vec<Panel> = own.iter().map(panel).collect();
    if panels.is_empty() {
        panels.push(Panel { note: "no stored spectra".to_owned(), ..Panel::new("", x, y) });
    }
    Chart {
        title: group.caption(),
        legend: vec![Entry::marker(FUNDAMENTAL, "fundamental")],
        colours: highest.is_finite().then(|| levels.colours()),
        ..Chart::stack(panels)
    }
}

/// The dot at a fundamental frequency.
const FUNDAMENTAL: Marker = Marker { shape: Shape::Circle, colour: INK, is_hollow: false, radius: 2.5 };

/// What all panels share: the frequencies \[Hz\] up to the last one, in so many hertz, and the highest level.
struct Levels {
    last_hz: f64,
    per_unit: f64,
    highest: f64,
}

impl Levels {
    /// The strips, and dots at the fundamental frequencies.
    fn layers(&self, strips: &[Strip], axis: &Axis) -> Vec<Layer> {
        let places: Vec<f64> = strips.iter().map(|strip| axis.place(strip.place.x)).collect();
        let (mut colours, mut tips, mut dots) = (Vec::new(), Vec::new(), Vec::new());
        for (number, strip) in strips.iter().enumerate() {
            let y = extent(&places, number).map(|place| axis.value_at(place));
            colours.extend(self.bands(strip.spectrum, y));
            let x = [0.0, self.last_hz / self.per_unit];
            let tip = strip.place.tip([("y", value::number(strongest_hz(strip.spectrum)))]);
            tips.push(Cell { x, y, tip: Some(tip), ..Cell::default() });
            let frequency_hz = strip.place.row.record().and_then(|record| record.frequency_hz);
            if let Some(frequency_hz) = frequency_hz.filter(|f| *f > 0.0 && *f < self.last_hz) {
                let at = (frequency_hz / self.per_unit, strip.place.x);
                // A ring in the colour of the ground is seen on every colour.
                let markers = [Marker { colour: PAPER, radius: 3.5, ..FUNDAMENTAL }, FUNDAMENTAL];
                dots.extend(markers.map(|marker| Point { at, error: 0.0, marker, tip: None }));
            }
        }
        vec![Layer::Cells(colours), Layer::Points(dots), Layer::Cells(tips)]
    }

    /// The bands of a strip; neighbours of equal colour are one.
    fn bands(&self, spectrum: &StoredSpectrum, y: [f64; 2]) -> Vec<Cell> {
        let width_hz = self.last_hz / BANDS as f64;
        let step = |band: usize| {
            let from_hz = band as f64 * width_hz;
            step_below(level_db(spectrum.largest_in(from_hz, from_hz + width_hz)), self.highest)
        };
        let steps: Vec<(usize, u32)> = (0..BANDS).map(|band| (band, step(band))).collect();
        let cell = |equal: &[(usize, u32)]| {
            let ends = [equal[0].0, equal[equal.len() - 1].0 + 1];
            let x = ends.map(|band| band as f64 * width_hz / self.per_unit);
            Cell { x, y, fill: Some(colour(equal[0].1)), ..Cell::default() }
        };
        steps.chunk_by(|a, b| a.1 == b.1).map(cell).collect()
    }

    fn colours(&self) -> ColourScale {
        let tick = |step: u32| {
            let label = value::fixed(self.highest - f64::from(step) * DECIBELS, 0).replace('-', "−");
            (1.0 - f64::from(step) / f64::from(COLOURS), label)
        };
        ColourScale {
            title: "amplitude of N\n[dB re 1 N]".to_owned(),
            colours: (0..COLOURS).rev().map(colour).collect(),
            ticks: (0..COLOURS).step_by(2).map(tick).collect(),
        }
    }
}

/// The ends of a strip, as places on the axis: half-way to its neighbours, and not too far. At the ends it is symmetric.
fn extent(places: &[f64], number: usize) -> [f64; 2] {
    let distance = |sign: f64| {
        let others = places.iter().map(|other| sign * (other - places[number]));
        others.filter(|distance| *distance > 0.0).min_by(f64::total_cmp)
    };
    let (below, above) = (distance(-1.0), distance(1.0));
    let half = |own: Option<f64>, other: Option<f64>| own.or(other).unwrap_or(STRIP).min(STRIP) / 2.0;
    [places[number] - half(below, above), places[number] + half(above, below)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a colour stands for 5 dB: the strongest line has the first one, and a line of a thousandth, 60 dB less,
    /// the last one.
    #[test]
    fn colours_are_levels() {
        let highest = level_db(20.0);
        let step = |amplitude_n: f64| step_below(level_db(amplitude_n), highest);
        assert_eq!((step(20.0), step(20.0 * 10f64.powf(-0.3)), step(0.02), step(0.0)), (0, 1, 11, 11));
        assert_eq!(colour(11), PAPER);
    }
}

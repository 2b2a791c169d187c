//! The lock-in plot: frequencies of the modes over μ (or what is varied in its place) and, below them, their growth rates, at up
//! to six speeds.

use super::GREY;
use crate::analysis::branches::{Branch, BranchPoint, crossing};
use crate::publish::chart::palette::{self, INK};
use crate::publish::chart::{
    At, Axis, Chart, Entry, Guide, Layer, Marker, Panel, Pen, Point, Scale, Shape, Tip,
};
use crate::publish::value;
use crate::report::layout::{Group, Layout};
use crate::report::stability::{GroupModes, Speed};
use std::f64::consts::TAU;

/// Largest number of speeds.
const MAX_SPEEDS: usize = 6;
/// Heights of frequencies and growth rates of a single speed \[px\].
const HEIGHTS: [f64; 2] = [260.0, 220.0];
const DOT: f64 = 3.0;
const CURVE: f64 = 2.0;

/// What all panels share.
struct Frame<'a> {
    layout: &'a Layout<'a>,
    modes: &'a GroupModes,
    x: Scale,
    frequency: Scale,
    /// Hertz per unit of the frequency axis.
    per_unit_hz: f64,
    growth: Scale,
}

/// The panels of a group: of all speeds, or of some that are spread over them.
pub(super) fn chart(layout: &Layout, group: &Group, modes: &GroupModes) -> Chart {
    let speeds = chosen(&modes.speeds);
    let branches = || speeds.iter().flat_map(|speed| &speed.branches);
    let frequencies = || branches().flat_map(|branch| &branch.points).map(|point| point.mode.frequency_hz);
    let largest_hz = frequencies().fold(0.0, f64::max);
    let (per_unit_hz, unit) = if largest_hz >= 1000.0 { (1000.0, "kHz") } else { (1.0, "Hz") };
    let least = 0.02 * largest_hz / per_unit_hz;
    let along = layout.dimension(layout.by);
    let frame = Frame {
        layout,
        modes,
        x: Scale::new(&along.title, along.axis(false)),
        frequency: Scale::spanning(
            &format!("frequency [{unit}]"),
            frequencies().map(|hz| hz / per_unit_hz),
            least,
        ),
        per_unit_hz,
        growth: Scale::new("growth rate [1/s]", Axis::around_zero(branches().flat_map(extremes), 1.0)),
    };
    let across = match speeds.len() {
        0 | 1 => 1,
        2..=4 => 2,
        _ => 3,
    };
    let heights = if speeds.len() > 1 { [0.0; 2] } else { HEIGHTS };
    let mut panels = Vec::with_capacity(2 * speeds.len());
    for row in speeds.chunks(across) {
        for (is_growth, height) in [false, true].into_iter().zip(heights) {
            let panel = |speed: &&Speed| Panel { height, ..frame.panel(speed, is_growth) };
            let blanks = if speeds.len() > across { across - row.len() } else { 0 };
            panels.extend(row.iter().map(panel).chain((0..blanks).map(|_| Panel::blank())));
        }
    }
    let legend = frame.legend(&speeds);
    Chart { title: group.caption(), panels, columns: across, legend, colours: None }.with_few_tips()
}

/// Up to six speeds, the lowest and the highest among them.
fn chosen(speeds: &[Speed]) -> Vec<&Speed> {
    let count = speeds.len().min(MAX_SPEEDS);
    let at = |k: usize| k * (speeds.len() - 1) / (count - 1).max(1);
    (0..count).map(|k| &speeds[at(k)]).collect()
}

/// The growth rates of a branch that a reader must be able to tell from zero: the largest on both sides of it.
fn extremes(branch: &Branch) -> Vec<f64> {
    let rates = || branch.points.iter().map(|point| point.mode.growth_rate_per_s).filter(|x| x.is_finite());
    let ends = [rates().fold(0.0, f64::min), rates().fold(0.0, f64::max)];
    ends.into_iter().filter(|end| *end != 0.0).collect()
}

/// The mode that locks in with a mode that grows: its frequency comes so near that both eigenvalues differ less in their
/// imaginary parts than in their real parts, though elsewhere they differ more. Two equal oscillators that friction couples
/// differ in the imaginary parts alone before they lock in, and in the real parts alone after that; damping turns the
/// difference between both.
fn partner(speed: &Speed, branch: usize) -> Option<usize> {
    let own = &speed.branches[branch];
    let nearest = |other: &Branch| {
        let at = |mu: f64| other.points.iter().find(|point| point.mu == mu);
        let common = own.points.iter().filter_map(|point| Some((&point.mode, &at(point.mu)?.mode)));
        let [mut nearest, mut furthest] = [f64::INFINITY, 0.0_f64];
        for (a, b) in common {
            let parts = a.growth_rate_per_s - b.growth_rate_per_s;
            let ratio = TAU * (a.frequency_hz - b.frequency_hz).abs() / parts.abs();
            furthest = furthest.max(ratio);
            if parts > 0.0 {
                nearest = nearest.min(ratio);
            }
        }
        (nearest < 1.0 && furthest > 1.0).then_some(nearest)
    };
    let others = speed.branches.iter().enumerate().filter(|(number, _)| *number != branch);
    let found = others.filter_map(|(number, other)| Some((nearest(other)?, number)));
    found.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, number)| number)
}

impl Frame<'_> {
    /// A place on the axis of the parameter along which modes are followed.
    fn x(&self, at: f64) -> f64 {
        self.layout.dimension(self.layout.by).scaled(at)
    }

    fn colour(&self, family: usize) -> palette::Rgb {
        palette::colour(family, self.modes.families.len())
    }

    /// How the branches of a speed are drawn: those that grow in their colours, those that lock in with them dashed, and the
    /// other ones fine and grey.
    fn pens(&self, speed: &Speed) -> Vec<Pen> {
        let mut pens = vec![Pen::solid(GREY, CURVE / 2.0); speed.branches.len()];
        for onset in &speed.onsets {
            if let Some(partner) = partner(speed, onset.branch) {
                pens[partner] = Pen::dashed(self.colour(onset.family), CURVE);
            }
        }
        // Of several onsets of a branch, the first one counts.
        for onset in speed.onsets.iter().rev() {
            pens[onset.branch] = Pen::solid(self.colour(onset.family), CURVE);
        }
        pens
    }

    /// Frequencies or growth rates of a speed.
    fn panel(&self, speed: &Speed, is_growth: bool) -> Panel {
        let omega = self.layout.dimension(self.layout.axis).assignment(&speed.omega);
        let title = if is_growth { String::new() } else { omega };
        let y = if is_growth { &self.growth } else { &self.frequency };
        let mut panel = Panel::new(&title, self.x.clone(), y.clone());
        if is_growth {
            panel.layers.push(Layer::Guide(Guide::level(0.0, INK)));
        }
        for onset in speed.onsets.iter().filter(|onset| onset.below.is_some()) {
            let pen = Pen::solid(self.colour(onset.family), 1.0);
            let ends = [Some(onset.mu), onset.ends.map(|ends| ends.at)];
            let guide = |at| Guide { pen, ..Guide::mark(self.x(at), "") };
            panel.layers.extend(ends.into_iter().flatten().map(|at| Layer::Guide(guide(at))));
        }
        let pens = self.pens(speed);
        // Modes that grow are drawn over the other ones.
        let mut order: Vec<usize> = (0..pens.len()).collect();
        order.sort_by_key(|branch| speed.onset_of(*branch).is_some());
        let mut dots = Vec::new();
        for number in order {
            let points = &speed.branches[number].points;
            let line = if is_growth {
                self.growth_line(points)
            } else {
                points.iter().map(|own| self.at(own, false)).collect()
            };
            panel.layers.push(Layer::Line { points: line, pen: pens[number], right: false });
            dots.extend(points.iter().map(|point| self.dot(speed, number, point, pens[number], is_growth)));
        }
        panel.layers.push(Layer::Points(dots));
        panel
    }

    fn at(&self, point: &BranchPoint, is_growth: bool) -> At {
        let mode = &point.mode;
        let y = if is_growth { mode.growth_rate_per_s } else { mode.frequency_hz / self.per_unit_hz };
        (self.x(point.mu), y)
    }

    /// The growth rates of a branch, with the places at which they are zero: these are on the line on every axis.
    fn growth_line(&self, points: &[BranchPoint]) -> Vec<At> {
        let mut line: Vec<At> = points.iter().take(1).map(|point| self.at(point, true)).collect();
        for pair in points.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|point| point.mode.growth_rate_per_s);
            line.extend((from * to < 0.0).then(|| (self.x(crossing([pair[0], pair[1]])), 0.0)));
            line.push(self.at(&pair[1], true));
        }
        line
    }

    fn dot(&self, speed: &Speed, branch: usize, point: &BranchPoint, pen: Pen, is_growth: bool) -> Point {
        let mode = &point.mode;
        let colour = if mode.is_converged { pen.colour } else { GREY };
        let note = if mode.is_converged { "" } else { "\nnot converged" };
        let title = format!(
            "{}\n{}, growth rate {} 1/s{note}",
            self.layout.dimension(self.layout.by).near(point.mu),
            value::quantity(mode.frequency_hz, "Hz"),
            value::significant(mode.growth_rate_per_s, 3).replace('-', "−")
        );
        let data = vec![
            ("branch", branch.to_string()),
            ("omega", value::text(&speed.omega)),
            ("x", value::number(point.mu)),
            ("frequency", value::number(mode.frequency_hz)),
            ("growth", value::number(mode.growth_rate_per_s)),
        ];
        let marker = Marker::new(Shape::Circle, colour).hollow(!mode.is_converged).sized(DOT);
        Point { at: self.at(point, is_growth), error: 0.0, marker, tip: Some(Tip { title, data }) }
    }

    /// What occurs at these speeds.
    fn legend(&self, speeds: &[&Speed]) -> Vec<Entry> {
        let mut legend = Vec::new();
        let onsets = || speeds.iter().flat_map(|speed| &speed.onsets);
        let families = self.modes.families.iter().enumerate();
        let shown: Vec<_> = families.filter(|(n, _)| onsets().any(|onset| onset.family == *n)).collect();
        if !shown.is_empty() {
            legend.push(Entry::heading("modes that grow, by frequency there"));
        }
        legend.extend(shown.into_iter().map(|(number, frequency_hz)| {
            Entry::line(Pen::solid(self.colour(number), CURVE), &value::quantity(*frequency_hz, "Hz"))
        }));
        let pens: Vec<Pen> = speeds.iter().flat_map(|speed| self.pens(speed)).collect();
        if pens.iter().any(|pen| pen.dash.0 > 0.0) {
            legend.push(Entry::line(Pen::dashed(GREY, CURVE), "locks in with the mode of this colour"));
        }
        if pens.iter().any(|pen| pen.colour == GREY) {
            legend.push(Entry::line(Pen::solid(GREY, CURVE / 2.0), "decays at every point"));
        }
        if onsets().any(|onset| onset.below.is_some()) {
            legend.push(Entry::heading("vertical: it begins or ceases to grow"));
        }
        let mut points = speeds.iter().flat_map(|speed| &speed.branches).flat_map(|branch| &branch.points);
        if points.any(|point| !point.mode.is_converged) {
            let marker = Marker::new(Shape::Circle, GREY).hollow(true).sized(DOT);
            legend.push(Entry::marker(marker, "not converged"));
        }
        legend.push(Entry::line(Guide::level(0.0, INK).pen, "zero growth rate"));
        legend
    }
}

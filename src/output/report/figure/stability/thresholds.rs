//! Thresholds: the friction coefficients at which modes begin to grow, over ω.

use super::GREY;
use crate::publish::chart::palette::{self, INK};
use crate::publish::chart::{Chart, Entry, Layer, Marker, Panel, Pen, Point, Rgb, Scale, Shape, Tip};
use crate::publish::value;
use crate::report::layout::{Group, Layout};
use crate::report::parameters::MU;
use crate::report::stability::{GroupModes, Onset, Speed};

const DOT: f64 = 4.0;
/// The dot of the lowest threshold.
const LARGE_DOT: f64 = 5.5;
const CURVE: f64 = 2.0;
/// The line of the lowest threshold, below the dots.
const FIRST: Pen = Pen::solid(Rgb(0xC4, 0xC4, 0xC4), 8.0);

/// A panel for each group, with the same axes.
pub(super) fn chart(layout: &Layout, groups: &[Group], modes: &[GroupModes]) -> Chart {
    let along = layout.dimension(layout.by);
    let label =
        if layout.by == MU { "threshold of μ".to_owned() } else { format!("threshold: {}", along.title) };
    let (x, y) = (Scale::new(layout.axis_name(), layout.x_axis()), Scale::new(&label, along.axis(false)));
    let is_alone = groups.len() == 1;
    let panel = |(group, modes): (&Group, &GroupModes)| {
        let title = if is_alone { String::new() } else { group.caption() };
        let layers = layers(layout, modes);
        Panel { layers, ..Panel::new(&title, x.clone(), y.clone()) }
    };
    let title = if is_alone { groups[0].caption() } else { String::new() };
    let panels = groups.iter().zip(modes).map(panel).collect();
    Chart { title, panels, columns: 0, legend: legend(modes), colours: None }.with_few_tips()
}

fn layers(layout: &Layout, modes: &GroupModes) -> Vec<Layer> {
    let (x_axis, along) = (layout.x_axis(), layout.dimension(layout.by));
    let colour = |family: usize| palette::colour(family, modes.families.len());
    // A speed without a threshold interrupts the line.
    let joined = |of: &dyn Fn(&Speed) -> Option<f64>, pen: Pen| {
        let at = |speed: &Speed| {
            Some((layout.position(&x_axis, &speed.omega)?, along.scaled(of(speed).unwrap_or(f64::NAN))))
        };
        Layer::Line { points: modes.speeds.iter().filter_map(at).collect(), pen, right: false }
    };
    let begins = |onset: &Onset| onset.below.map(|_| onset.mu);
    let mut layers = vec![joined(&|speed| speed.lowest().and_then(begins), FIRST)];
    layers.extend((0..modes.families.len()).map(|family| {
        let own = |speed: &Speed| speed.onsets.iter().filter(|onset| onset.family == family).find_map(begins);
        joined(&own, Pen::solid(colour(family), CURVE))
    }));
    let mut points = Vec::new();
    for speed in &modes.speeds {
        let Some(x) = layout.position(&x_axis, &speed.omega) else { continue };
        let omega = layout.dimension(layout.axis).assignment(&speed.omega);
        let mut add = |at: f64, marker, tip| {
            points.push(Point { at: (x, along.scaled(at)), error: 0.0, marker, tip });
        };
        for onset in &speed.onsets {
            let is_lowest = speed.lowest() == Some(onset);
            let of_family = if onset.is_converged { colour(onset.family) } else { GREY };
            let note = if onset.is_converged { "" } else { "\nnot converged" };
            let tip = |words: &str, at: f64| Tip {
                title: format!(
                    "{omega}\n{words}{}\n{}{note}",
                    along.near(at),
                    value::quantity(onset.frequency_hz, "Hz")
                ),
                data: vec![
                    ("x", value::text(&speed.omega)),
                    ("y", value::number(at)),
                    ("frequency", value::number(onset.frequency_hz)),
                    ("family", onset.family.to_string()),
                ],
            };
            let dot = Marker::new(Shape::Circle, of_family).sized(if is_lowest { LARGE_DOT } else { DOT });
            if onset.below.is_some() {
                add(onset.mu, dot.hollow(!onset.is_converged), Some(tip("threshold: ", onset.mu)));
            } else if is_lowest {
                add(onset.mu, UNSTABLE, None);
            }
            if let Some(end) = onset.ends {
                let dot = Marker::new(Shape::Circle, colour(onset.family)).sized(DOT).hollow(true);
                add(end.at, dot, Some(tip("ceases to grow: ", end.at)));
            }
        }
        if speed.onsets.is_empty() && speed.mus[1].is_finite() {
            add(speed.mus[1], STABLE, None);
        }
    }
    layers.push(Layer::Points(points));
    layers
}

/// At the first point, if sliding is unstable there already.
const UNSTABLE: Marker = Marker::new(Shape::Down, INK).sized(DOT);
/// At the last point, if no mode grows.
const STABLE: Marker = Marker::new(Shape::Up, INK).sized(DOT);

/// What occurs. Several panels have families of their own, so that their colours are the order of the thresholds.
fn legend(modes: &[GroupModes]) -> Vec<Entry> {
    let speeds = || modes.iter().flat_map(|group| &group.speeds);
    let onsets = || speeds().flat_map(|speed| &speed.onsets);
    let crossings = || onsets().filter(|onset| onset.below.is_some());
    let dot = |colour: Rgb| Marker::new(Shape::Circle, colour).sized(DOT).hollow(true);
    let mut legend = Vec::new();
    if crossings().next().is_some() {
        legend.push(Entry::line(FIRST, "first: steady sliding becomes unstable"));
    }
    if let [group] = modes {
        let occurs = |number: usize| crossings().any(|onset| onset.family == number);
        let own = group.families.iter().enumerate().filter(|(number, _)| occurs(*number));
        legend.extend(own.map(|(number, frequency_hz)| {
            let pen = Pen::solid(palette::colour(number, group.families.len()), CURVE);
            Entry::line(pen, &format!("mode at {}", value::quantity(*frequency_hz, "Hz")))
        }));
    } else if crossings().next().is_some() {
        legend.push(Entry::heading("A colour is a mode, in each panel in the order of the thresholds."));
    }
    if crossings().any(|onset| !onset.is_converged) {
        legend.push(Entry::marker(dot(GREY), "not converged"));
    }
    if onsets().any(|onset| onset.ends.is_some()) {
        legend.push(Entry::marker(dot(INK), "ceases to grow"));
    }
    if speeds().any(|speed| speed.lowest().is_some_and(|onset| onset.below.is_none())) {
        legend.push(Entry::marker(UNSTABLE, "unstable at the first point already"));
    }
    if speeds().any(|speed| speed.onsets.is_empty()) {
        legend.push(Entry::marker(STABLE, "no mode grows at any point"));
    }
    legend
}

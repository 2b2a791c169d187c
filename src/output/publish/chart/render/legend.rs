//! Legends and colour scales.

use super::marks::{draw_marker, is_outside};
use super::measures::{LEGEND, SMALL, TEXT, width_of, wrapped};
use crate::publish::chart::palette::{self, GREY, INK};
use crate::publish::chart::svg::{Anchor, At, Pen, Svg};
use crate::publish::chart::{Chart, ColourScale, Entry, Layer, Marker, Panel, Sample, Shape};
use crate::publish::value;

/// Length of a sample.
const SAMPLE: f64 = 26.0;
/// Height of the colours of a scale.
pub(super) const COLOURS: f64 = 170.0;

pub(super) fn entries_of(panel: &Panel) -> Vec<Entry> {
    let guide = |layer: &Layer| match layer {
        Layer::Guide(guide) if !guide.is_vertical && !guide.label.is_empty() => {
            let scale = panel.right.as_ref().filter(|_| guide.right).unwrap_or(&panel.y);
            // At the edge of the axis a line would have another value than its own.
            Some(if scale.axis.range().contains(&guide.at) {
                Entry::line(guide.pen, &guide.label)
            } else {
                Entry::heading(&format!(
                    "{}: {} (off the axis)",
                    guide.label,
                    value::significant(guide.at, 3).replace('-', "−")
                ))
            })
        }
        _ => None,
    };
    panel.legend.iter().cloned().chain(panel.layers.iter().filter_map(guide)).collect()
}

/// Whether the legend has to explain arrows at the edge.
fn has_outside(chart: &Chart) -> bool {
    let of_panel = |panel: &Panel| {
        let outside = |layer: &Layer| matches!(layer, Layer::Points(points) if points.iter().any(|point| is_outside(panel, point)));
        panel.layers.iter().any(outside)
    };
    chart.panels.iter().any(of_panel)
}

pub(super) fn legend_entries(chart: &Chart) -> Vec<Entry> {
    let outside = has_outside(chart)
        .then(|| Entry::marker(Marker::new(Shape::Up, GREY).sized(3.3), "outside of the axis"));
    chart.legend.iter().cloned().chain(outside).collect()
}

pub(super) fn legend_width(chart: &Chart, text: f64) -> f64 {
    let own = chart.panels.iter().flat_map(entries_of);
    let longest = legend_entries(chart)
        .into_iter()
        .chain(own)
        .flat_map(|entry| {
            let beside = if entry.sample == Sample::Heading { 0.0 } else { SAMPLE + 8.0 };
            entry.text.split('\n').map(|line| beside + width_of(line, text)).collect::<Vec<_>>()
        })
        .fold(0.0, f64::max);
    let colours = chart.colours.as_ref().map_or(0.0, |scale| {
        let lines = wrapped(&scale.title, TEXT, LEGEND[1]);
        lines.iter().map(|line| width_of(line, TEXT)).fold(LEGEND[0], f64::max)
    });
    match longest.max(colours) {
        0.0 => 0.0,
        width => width.clamp(LEGEND[0], LEGEND[1]),
    }
}

fn lines_of(entry: &Entry, width: f64, text: f64) -> Vec<String> {
    let beside = if entry.sample == Sample::Heading { 0.0 } else { SAMPLE + 8.0 };
    wrapped(&entry.text, text, width - beside)
}

pub(super) fn pitch(text: f64) -> f64 {
    text * 1.28
}

/// The space above an entry: headings stand apart from what is above them.
fn space_above(entries: &[Entry], number: usize, text: f64) -> f64 {
    if number > 0 && entries[number].sample == Sample::Heading { 0.6 * text } else { 0.0 }
}

pub(super) fn entries_height(entries: &[Entry], width: f64, text: f64) -> f64 {
    let height = |(number, entry): (usize, &Entry)| {
        let lines = lines_of(entry, width, text).len() as f64;
        space_above(entries, number, text) + lines * pitch(text) + 4.0
    };
    entries.iter().enumerate().map(height).sum()
}

/// Draws the entries below one another and returns where they end.
pub(super) fn draw_entries(svg: &mut Svg, entries: &[Entry], (x, top): At, width: f64, text: f64) -> f64 {
    let mut y = top;
    for (number, entry) in entries.iter().enumerate() {
        y += space_above(entries, number, text);
        let lines = lines_of(entry, width, text);
        let middle = y + pitch(text) * lines.len() as f64 / 2.0;
        match &entry.sample {
            Sample::Heading => {}
            Sample::Line(pen) => svg.lines(&[(x, middle), (x + SAMPLE, middle)], *pen),
            Sample::Marker(marker) => draw_marker(svg, (x + SAMPLE / 2.0, middle), *marker),
            Sample::Cell(fill, letters) => {
                let half = 0.55 * text;
                svg.rectangle((x, middle - half), (x + SAMPLE, middle + half), *fill);
                let ink = palette::contrasting(*fill);
                svg.plain((x + SAMPLE / 2.0, middle), Anchor::Middle, ink, text - 2.0, letters);
            }
        }
        let beside = if entry.sample == Sample::Heading { 0.0 } else { SAMPLE + 8.0 };
        for line in &lines {
            svg.plain((x + beside, y + pitch(text) / 2.0), Anchor::Start, INK, text, line);
            y += pitch(text);
        }
        y += 4.0;
    }
    y
}

pub(super) fn draw_colours(svg: &mut Svg, scale: &ColourScale, (x, top): At) {
    let title = wrapped(&scale.title, TEXT, LEGEND[1]);
    for (line, words) in title.iter().enumerate() {
        svg.plain((x, top + TEXT / 2.0 + line as f64 * pitch(TEXT)), Anchor::Start, INK, TEXT, words);
    }
    let (top, width) = (top + title.len() as f64 * pitch(TEXT) + 8.0, SAMPLE);
    let y = |share: f64| top + (1.0 - share) * COLOURS;
    let count = scale.colours.len() as f64;
    for (step, colour) in scale.colours.iter().enumerate() {
        // Each colour reaches into the next one below, so that rounding leaves no gap.
        let [low, high] = [step as f64 / count, (step + 1) as f64 / count];
        svg.rectangle((x, y(high)), (x + width, (y(low) + 0.6).min(y(0.0))), *colour);
    }
    let corners = [(x, y(1.0)), (x + width, y(1.0)), (x + width, y(0.0)), (x, y(0.0)), (x, y(1.0))];
    svg.lines(&corners, Pen::solid(GREY, 0.8));
    for (share, label) in &scale.ticks {
        svg.lines(&[(x + width, y(*share)), (x + width + 4.0, y(*share))], Pen::solid(INK, 1.0));
        svg.plain((x + width + 8.0, y(*share)), Anchor::Start, INK, SMALL, label);
    }
}

//! Maps: a cell for every job at its values of two parameters.
//!
//! The cells are of equal size at names of the values, or on true axes: then each job has the part of the plane that is nearer
//! to its values than to those of its neighbours.

use super::edges::CellEdges;
use crate::analysis::Outcome;
use crate::publish::chart::{
    At, Axis, Cell, Chart, ColourScale, Entry, Layer, MAX_TIPS, Marker, Panel, Pen, Rgb, Scale, Shape, Tip,
    palette,
};
use crate::publish::value;
use crate::report::glyph::{StatusGlyph, status_glyph};
use crate::report::layout::{Group, Layout, PlacedJob};
use crate::report::row::JobRow;
use crate::report::scalar::FREQUENCY;
use crate::report::stability::{Node, Verdict, Verdicts, zero_line};
use crate::report::stability_point::StabilityPoint;
use crate::report::tooltip::tooltip_text;
use palette::{DARK, INK, LIGHT, NO_VALUE, PAPER};
use serde_json::Value;
use std::collections::BTreeSet;

/// Height of all rows of equal cells, and the smallest and the largest height of one \[px\].
const ROWS_HEIGHT: f64 = 440.0;
const ROW_HEIGHT: [f64; 2] = [12.0, 48.0];
/// Height of a plot with true axes \[px\].
const HEIGHT: f64 = 420.0;
/// The side of a cell of a job that is not on a grid, relative to the width and the height of the plot: about 17 px.
const ALONE: [f64; 2] = [0.035, 0.04];
/// Up to so many values along an axis, its ticks are at them.
const MAX_TICKS: usize = 12;
/// Number of colours in a scale.
const STEPS: usize = 60;
/// Smallest distance of labels beside a scale of colours, relative to its height.
const LABELS_APART: f64 = 0.085;

/// Where cells are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axes {
    /// Beside one another, at names of the values.
    Equal,
    /// At the values themselves.
    True,
}

/// How the cell of a job looks.
pub(super) struct Look {
    pub fill: Rgb,
    pub text: String,
    /// The value in full precision, for the attribute `data-value`.
    pub value: String,
    /// The tooltip, if it is not that of the job.
    pub title: Option<String>,
    /// A mark in the corner.
    pub mark: Option<Verdict>,
    /// Whether the row is a job, whose key a program may want.
    pub is_job: bool,
}

impl Look {
    /// A cell with the tooltip of its job.
    pub fn new(fill: Rgb, text: String, value: String) -> Self {
        Self { fill, text, value, title: None, mark: None, is_job: true }
    }

    /// The letter of a job's status on its own colour, or on that of cells without a value.
    fn letter(row: &JobRow, fill: Option<Rgb>) -> Self {
        let glyph = status_glyph(row);
        let letter = glyph.letter.to_string();
        let value = if fill.is_none() { letter.clone() } else { String::new() };
        Self::new(fill.unwrap_or(glyph.fill), letter, value)
    }
}

/// Whether a layout has numbers on both axes. Otherwise there is no map on true axes.
pub(super) fn has_true_axes(layout: &Layout) -> bool {
    let has_jobs = layout.groups.iter().any(|group| !group.jobs.is_empty());
    let is_named = |axis: &Axis| matches!(axis, Axis::Names(_));
    !has_jobs || !is_named(&layout.x_axis()) && !is_named(&layout.dimension(layout.by).axis(false))
}

/// Whether there are two columns of cells or more, and two rows: another map shows nothing that no curve or table does.
fn is_map(layout: &Layout, axes: Axes) -> bool {
    let rows = match axes {
        Axes::Equal => layout.series.len(),
        Axes::True => layout.series.iter().map(|series| series.value_index).collect::<BTreeSet<_>>().len(),
    };
    rows > 1 && layout.groups.iter().any(|group| group.axis_values.len() > 1)
}

/// The contact regimes in equal cells, a panel for each group.
pub(super) fn regimes(layout: &Layout, groups: &[Group]) -> Option<Chart> {
    let chart = equal(layout, groups, |row| Look::letter(row, None))?;
    Some(Chart { legend: statuses(rows_of(groups), None), ..chart })
}

/// The frequencies as colours and numbers in equal cells. The colours span the frequencies of limit cycles; a job that is not
/// periodic has its number, but no colour.
pub(super) fn frequencies(layout: &Layout, groups: &[Group]) -> Option<Chart> {
    let frequency = |row: &JobRow| FREQUENCY.value(row);
    let settled = |row: &JobRow| frequency(row).filter(|_| FREQUENCY.is_settled(row));
    let (low, high) = rows_of(groups)
        .filter_map(settled)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), f| (low.min(f), high.max(f)));
    let share = |f: f64| if high > low { (f - low) / (high - low) } else { 0.5 };
    let largest = rows_of(groups).filter_map(frequency).fold(0.0, f64::max);
    let (unit, per_unit) = if largest >= 1000.0 { ("kHz", 1000.0) } else { ("Hz", 1.0) };
    let is_periodic = |row: &JobRow| row.record().is_none_or(|record| record.outcome != Outcome::NotPeriodic);
    let look = |row: &JobRow| match frequency(row) {
        Some(f) => Look::new(
            settled(row).map_or(NO_VALUE, |f| palette::sequential(share(f))),
            value::fixed(f / per_unit, 1) + if is_periodic(row) { "" } else { "~" },
            value::number(f),
        ),
        None => Look::letter(row, Some(NO_VALUE)),
    };
    let chart = equal(layout, groups, look)?;
    let unsettled = rows_of(groups).any(|row| frequency(row).is_some() && settled(row).is_none());
    let mut legend =
        Vec::from_iter(unsettled.then(|| Entry::cell(NO_VALUE, "~", &format!("not periodic [{unit}]"))));
    legend.extend(statuses(rows_of(groups).filter(|row| frequency(row).is_none()), Some(NO_VALUE)));
    let ticks = if high > low {
        let ticks = Axis::Linear(low / per_unit..high / per_unit).labelled_ticks();
        ticks.into_iter().map(|(at, label)| (share(at * per_unit), label)).collect()
    } else {
        vec![(0.5, value::fixed(low / per_unit, 1))]
    };
    // If all values are equal, the scale has the one colour of the cells.
    let colour = |at: f64| palette::sequential(if high > low { at } else { 0.5 });
    let scale = || ColourScale::new(&format!("frequency [{unit}]"), STEPS, colour, ticks);
    Some(Chart { legend, colours: (low <= high).then(scale), ..chart })
}

/// The contact regimes on true axes. If the linear stability of steady sliding is known, its boundary is drawn into them, and the
/// jobs that it does not explain are marked.
pub(super) fn regimes_on_true_axes(
    layout: &Layout,
    group: &Group,
    points: &[StabilityPoint],
) -> Option<Chart> {
    // Points of one study say nothing about the jobs of another one.
    let points = if layout.sources.len() > 1 { &[] } else { points };
    let verdicts = Verdicts::new(points);
    let look = |row: &JobRow| {
        let mark = verdicts.of(row);
        let title = mark.map(|verdict| format!("{}\n{}", tooltip_text(row), verdict.words()));
        Look { title, mark, ..Look::letter(row, None) }
    };
    let mut chart = is_map(layout, Axes::True).then(|| on_true_axes(layout, group, look))?;
    chart.legend = statuses(group.jobs.iter().map(|job| job.row), None);
    add_boundary(&mut chart, &nodes(layout, group, points));
    let occurs = |verdict: &Verdict| group.jobs.iter().any(|job| verdicts.of(job.row) == Some(*verdict));
    let entry = |verdict: Verdict| Entry::marker(marker(verdict), verdict.words());
    chart.legend.extend(Verdict::ALL.into_iter().filter(occurs).map(entry));
    Some(chart)
}

/// The growth rates of jobs in steady sliding on true axes, as colours and numbers, and a letter for a job that has none.
pub(super) fn growth_rates(layout: &Layout, group: &Group) -> Option<Chart> {
    let rate = |row: &JobRow| row.record()?.growth_rate_per_s.filter(|rate| rate.is_finite());
    // All figures of a report have the same colours.
    let largest = rows_of(&layout.groups).filter_map(rate).map(f64::abs).fold(0.0, f64::max);
    let look = |row: &JobRow| match rate(row) {
        Some(rate) => Look::new(growth_colour(rate, largest), rate_text(rate), value::number(rate)),
        None => Look::letter(row, Some(NO_VALUE)),
    };
    let mut chart = is_map(layout, Axes::True).then(|| on_true_axes(layout, group, look))?;
    add_growth_scale(&mut chart, largest);
    let others = group.jobs.iter().map(|job| job.row).filter(|row| rate(row).is_none());
    chart.legend.extend(statuses(others, Some(NO_VALUE)));
    Some(chart)
}

/// A growth rate in a cell.
pub(super) fn rate_text(rate: f64) -> String {
    value::significant(rate, 3).replace('-', "−")
}

/// The place of a rate in the colours from −1 to 1. The root shows the sign of small rates beside large ones.
fn growth_share(rate: f64, largest: f64) -> f64 {
    if largest > 0.0 { rate.signum() * (rate.abs() / largest).sqrt() } else { 0.0 }
}

/// The colour of a growth rate among rates up to `largest`.
pub(super) fn growth_colour(rate: f64, largest: f64) -> Rgb {
    palette::diverging(growth_share(rate, largest))
}

/// Explains the colours of growth rates from −`largest` to `largest`.
pub(super) fn add_growth_scale(chart: &mut Chart, largest: f64) {
    if largest <= 0.0 {
        chart.legend.push(Entry::heading("no growth rates"));
        return;
    }
    let mut ticks: Vec<(f64, String)> = Vec::new();
    // The largest rates are close to each other under the root. Some of them have no label.
    for (rate, label) in Axis::Linear(0.0..largest).labelled_ticks().into_iter().rev() {
        let at = growth_share(rate, largest) / 2.0;
        if ticks.last().is_none_or(|(last, _)| last - 0.5 - at >= LABELS_APART) {
            ticks.extend((rate > 0.0).then(|| (0.5 - at, format!("−{label}"))));
            ticks.push((0.5 + at, label));
        }
    }
    let colour = |at: f64| palette::diverging(2.0 * at - 1.0);
    chart.colours = Some(ColourScale::new("growth rate [1/s]", STEPS, colour, ticks));
    let entry = |share: f64, sign, words| Entry::cell(palette::diverging(share), sign, words);
    chart.legend.extend([entry(0.5, "+", "grows"), entry(-0.5, "−", "decays")]);
}

/// The points of a group at their places on the true axes, with the growth rates \[1/s\] of their leading modes.
pub(super) fn nodes(layout: &Layout, group: &Group, points: &[StabilityPoint]) -> Vec<Node> {
    let (x_axis, by) = (layout.x_axis(), layout.dimension(layout.by));
    let y_axis = by.axis(false);
    let belongs = |point: &&StabilityPoint| {
        let equal = |(name, own): &(&str, Value)| value::text(&point.parameter(name)) == value::text(own);
        group.key.iter().all(equal)
    };
    let node = |point: &StabilityPoint| {
        Some(Node {
            x: layout.position(&x_axis, &point.parameter(layout.axis))?,
            y: by.position(&y_axis, &point.parameter(layout.by))?,
            value: point.leading()?.growth_rate_per_s,
        })
    };
    points.iter().filter(belongs).filter_map(node).collect()
}

/// Adds the line on which the growth rate is zero, as far as the points around it are inside of the axes.
pub(super) fn add_boundary(chart: &mut Chart, nodes: &[Node]) {
    let Some(panel) = chart.panels.first_mut() else { return };
    let (across, up) = (panel.x.axis.range(), panel.y.axis.range());
    let is_log = matches!(panel.x.axis, Axis::Log(_));
    let inside = nodes.iter().copied().filter(|node| across.contains(&node.x) && up.contains(&node.y));
    let lines = zero_line(&inside.collect::<Vec<_>>(), is_log, &across, &up);
    // The wider line keeps the boundary apart from dark cells. Cells have the same colours on every ground.
    for pen in [Pen::solid(LIGHT, 5.0), Pen::solid(DARK, 3.0)] {
        let layer = |line: &Vec<At>| Layer::Line { points: line.clone(), pen, right: false };
        panel.layers.extend(lines.iter().map(layer));
    }
    if !lines.is_empty() {
        let words = "threshold: the leading growth rate is zero";
        chart.legend.push(Entry::line(Pen::solid(INK, 3.0), words));
    }
}

/// The jobs of all panels.
fn rows_of<'a>(groups: &'a [Group]) -> impl Iterator<Item = &'a JobRow> {
    groups.iter().flat_map(|group| &group.jobs).map(|job| job.row)
}

/// The letters of all statuses in the order of the legend.
const ORDER: &str = "SKkXxPpUC?!>.-M";

/// The meaning of the letters of these rows, on their own colours or on another one.
fn statuses<'a>(rows: impl Iterator<Item = &'a JobRow>, fill: Option<Rgb>) -> Vec<Entry> {
    let mut used: Vec<StatusGlyph> = Vec::new();
    for glyph in rows.map(status_glyph) {
        if !used.contains(&glyph) {
            used.push(glyph);
        }
    }
    used.sort_by_key(|glyph| ORDER.find(glyph.letter));
    let entry = |glyph: &StatusGlyph| {
        Entry::cell(fill.unwrap_or(glyph.fill), &glyph.letter.to_string(), glyph.meaning)
    };
    used.iter().map(entry).collect()
}

/// The mark of a verdict: a black triangle, or a hollow diamond.
fn marker(verdict: Verdict) -> Marker {
    match verdict {
        Verdict::CycleBelowThreshold => Marker::new(Shape::Up, INK),
        Verdict::NoEffect => Marker::new(Shape::Diamond, INK).hollow(true),
    }
}

/// Equal cells, a panel for each group.
fn equal(layout: &Layout, groups: &[Group], look: impl Fn(&JobRow) -> Look) -> Option<Chart> {
    if !is_map(layout, Axes::Equal) {
        return None;
    }
    let columns = match groups.len() {
        0 | 1 => 1,
        2..=4 => 2,
        _ => 3,
    };
    let rows = (layout.series.len() * groups.len().div_ceil(columns)) as f64;
    let height = layout.series.len() as f64 * (ROWS_HEIGHT / rows).clamp(ROW_HEIGHT[0], ROW_HEIGHT[1]);
    let is_alone = groups.len() == 1;
    let panel = |group: &Group| {
        let title = if is_alone { String::new() } else { group.caption() };
        Panel { title, height, ..panel(layout, group, Axes::Equal, &look) }
    };
    let title = if is_alone { groups[0].caption() } else { String::new() };
    let panels = groups.iter().map(panel).collect();
    Some(Chart { title, panels, columns, ..Chart::default() }.with_few_tips())
}

/// The cells of a group on true axes.
pub(super) fn on_true_axes(layout: &Layout, group: &Group, look: impl Fn(&JobRow) -> Look) -> Chart {
    let panel = Panel { height: HEIGHT, ..panel(layout, group, Axes::True, &look) };
    Chart { title: group.caption(), ..Chart::of(panel) }.with_few_tips()
}

/// A job with its place on the axes and its values of both parameters.
struct Spot<'a> {
    row: &'a JobRow,
    at: At,
    values: [&'a Value; 2],
}

/// The jobs from the lower left to the upper right.
fn spots<'a>(layout: &'a Layout, group: &'a Group, axes: Axes) -> Vec<Spot<'a>> {
    let (x_axis, by) = (layout.x_axis(), layout.dimension(layout.by));
    let y_axis = by.axis(false);
    let spot = |job: &PlacedJob<'a>| {
        let values = [&group.axis_values[job.axis_index], &layout.series[job.series].value];
        let at = match axes {
            Axes::Equal => (job.axis_index as f64, job.series as f64),
            Axes::True => (layout.position(&x_axis, values[0])?, by.position(&y_axis, values[1])?),
        };
        Some(Spot { row: job.row, at, values })
    };
    let mut spots: Vec<Spot> = group.jobs.iter().filter_map(spot).collect();
    spots.sort_by(|a, b| a.at.1.total_cmp(&b.at.1).then(a.at.0.total_cmp(&b.at.0)));
    spots
}

fn panel(layout: &Layout, group: &Group, axes: Axes, look: &impl Fn(&JobRow) -> Look) -> Panel {
    let spots = spots(layout, group, axes);
    let [along, by] = [layout.axis, layout.by].map(|name| layout.dimension(name));
    let columns = CellEdges::of(spots.iter().map(|spot| spot.at.0), matches!(layout.x_axis(), Axis::Log(_)));
    let rows = CellEdges::of(spots.iter().map(|spot| spot.at.1), false);
    let places = spots.chunk_by(|a, b| a.at == b.at).count();
    // Points that are not on a grid have no neighbours in rows and columns. A cell between neighbours would say nothing.
    let is_grid = 2 * places >= columns.values.len() * rows.values.len();
    let x = match axes {
        Axes::Equal => Axis::Names(group.axis_values.iter().map(|value| along.text(value)).collect()),
        Axes::True if is_grid => columns.axis.clone(),
        Axes::True => layout.x_axis(),
    };
    let y = match axes {
        Axes::Equal => Axis::Names(layout.series.iter().map(|own| layout.series_value(own)).collect()),
        Axes::True if is_grid => rows.axis.clone(),
        Axes::True => by.axis(false),
    };
    let ends = |at: At| match axes {
        Axes::Equal => [[at.0 - 0.5, at.0 + 0.5], [at.1 - 0.5, at.1 + 0.5]],
        Axes::True if is_grid => [columns.around(at.0), rows.around(at.1)],
        Axes::True => [square(&x, at.0, ALONE[0]), square(&y, at.1, ALONE[1])],
    };
    let has_dots = is_grid && axes == Axes::True;
    let mut cells = Vec::with_capacity(spots.len());
    for here in spots.chunk_by(|a, b| a.at == b.at) {
        let [across, up] = ends(here[0].at);
        // Several jobs at one place share a cell.
        let share = |number: usize| between(&x, across, number as f64 / here.len() as f64);
        for (number, spot) in here.iter().enumerate() {
            let own = [share(number), share(number + 1)];
            let middle = if here.len() == 1 { spot.at.0 } else { between(&x, own, 0.5) };
            cells.push(cell(spot, [own, up], has_dots.then_some((middle, spot.at.1)), look(spot.row)));
        }
    }
    let source = if layout.has_sources() { " and source" } else { "" };
    let mut x = Scale::new(layout.axis_name(), x).without_grid();
    let mut y = Scale::new(&format!("{}{source}", by.title), y).without_grid();
    if axes == Axes::True {
        x.ticks = ticks(spots.iter().map(|spot| (spot.at.0, along.text(spot.values[0]))).collect());
        y.ticks = ticks(spots.iter().map(|spot| (spot.at.1, by.text(spot.values[1]))).collect());
    }
    let edges = (cells.len() <= MAX_TIPS).then(|| outlines(&cells));
    let layers = [Layer::Cells(cells)].into_iter().chain(edges).collect();
    Panel { layers, ..Panel::new("", x, y) }
}

fn cell(spot: &Spot, [x, y]: [[f64; 2]; 2], dot: Option<At>, look: Look) -> Cell {
    let Look { fill, text, value, title, mark, is_job } = look;
    let mut data = Vec::from_iter(is_job.then(|| ("job", spot.row.job.clone())));
    data.extend([("x", value::text(spot.values[0])), ("y", value::text(spot.values[1])), ("value", value)]);
    data.extend(mark.map(|verdict| ("mark", verdict.name().to_owned())));
    let title = title.unwrap_or_else(|| tooltip_text(spot.row));
    let tip = Some(Tip { title, data });
    Cell {
        x,
        y,
        fill: Some(fill),
        text,
        dot,
        mark: mark.map(|own| Marker { colour: DARK, ..marker(own) }),
        tip,
    }
}

/// Thin lines between the cells.
fn outlines(cells: &[Cell]) -> Layer {
    let outline = |Cell { x: [left, right], y: [low, high], .. }: &Cell| {
        let corners = [(*left, *low), (*right, *low), (*right, *high), (*left, *high), (*left, *low)];
        corners.into_iter().chain([(f64::NAN, f64::NAN)])
    };
    let points = cells.iter().flat_map(outline).collect();
    Layer::Line { points, pen: Pen::solid(PAPER, 1.0), right: false }
}

/// Ticks at values that jobs have, if they are few; otherwise none, so that the axis chooses.
fn ticks(mut values: Vec<(f64, String)>) -> Vec<(f64, String)> {
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    values.dedup_by(|b, a| a.0 == b.0);
    if values.len() <= MAX_TICKS { values } else { Vec::new() }
}

/// The value at a share of the way between two values, as it is drawn.
fn between(axis: &Axis, [from, to]: [f64; 2], share: f64) -> f64 {
    match share {
        0.0 => from,
        1.0 => to,
        _ if matches!(axis, Axis::Log(_)) => from * (to / from).powf(share),
        _ => from + share * (to - from),
    }
}

/// The ends of a cell around a value that is so wide, relative to the axis.
fn square(axis: &Axis, at: f64, share: f64) -> [f64; 2] {
    let range = axis.range();
    match axis {
        Axis::Log(_) => [-0.5, 0.5].map(|side| at * (range.end / range.start).powf(side * share)),
        _ => [-0.5, 0.5].map(|side| at + side * share * (range.end - range.start)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the colours are symmetric about zero, a rate of zero has none, and the labels of their scale are at the places
    /// of their colours and do not overlap.
    #[test]
    fn colours_show_the_sign() {
        assert_eq!(
            (growth_share(-4.0, 16.0), growth_share(16.0, 16.0), growth_share(0.0, 16.0)),
            (-0.5, 1.0, 0.0)
        );
        assert_eq!(growth_share(-3.0, 0.0), 0.0);
        let (cold, warm) = (growth_colour(-1.0, 1.0), growth_colour(1.0, 1.0));
        assert!(cold.2 > cold.0 && warm.0 > warm.2);
        let mut chart = Chart::default();
        add_growth_scale(&mut chart, 845.0);
        let mut ticks = chart.colours.expect("colours").ticks;
        ticks.sort_by(|a, b| a.0.total_cmp(&b.0));
        let labels: Vec<&str> = ticks.iter().map(|(_, label)| label.as_str()).collect();
        assert_eq!(labels, ["−800", "−400", "−200", "0", "200", "400", "800"]);
        assert!(ticks.windows(2).all(|pair| pair[1].0 - pair[0].0 >= LABELS_APART), "{ticks:?}");
        let rate = ticks.iter().find(|(_, label)| label == "200").expect("a tick").0;
        assert!((2.0 * rate - 1.0 - growth_share(200.0, 845.0)).abs() < 1e-12);
    }
}

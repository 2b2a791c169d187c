//! The layout of a chart: panels in rows and columns, ticks, names of axes, and the legend on the right side.
//!
//! Neighbouring panels with the same axis share its ticks and its name. All lengths are in pixels of the drawing, which is
//! made for a page of [`WIDTH`] and is readable at half of it.

use super::palette::{self, GREY, GRID, INK, PAPER};
use super::svg::{Anchor, At, Pen, Svg};
use super::{
    Axis, Cell, Chart, ColourScale, Entry, Guide, Layer, Marker, Panel, Point, Sample, Scale, Shape,
};
use crate::publish::value;

/// Width of a drawing.
const WIDTH: f64 = 780.0;
/// Space around everything.
const MARGIN: f64 = 10.0;
/// Space between neighbouring panels.
const GAP: f64 = 14.0;
/// Size of text, where panels are large and where they are small.
const TEXT: f64 = 15.0;
const SMALL: f64 = 12.5;
/// Width of a character relative to the size of the text; a little more than the mean of the usual fonts.
const CHARACTER: f64 = 0.54;
/// Width of a digit relative to the size of the text in the widest of the fonts. The texts of neighbouring cells must not touch.
const DIGIT: f64 = 0.64;
/// Length of a tick.
const TICK: f64 = 5.0;
/// Length of a sample in the legend.
const SAMPLE: f64 = 26.0;
/// Smallest and largest width of the legend.
const LEGEND: [f64; 2] = [90.0, 235.0];
/// Height of a row of labels on top of vertical lines. There are two rows, because the lines may be close to each other.
const MARK_ROW: f64 = 17.0;
/// Height of the colours of a scale.
const COLOURS: f64 = 170.0;
/// Points of a line that are nearer to the one before are left out.
const NEAR: f64 = 0.7;

fn width_of(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * CHARACTER
}

/// Words in lines that are not wider than `room`.
fn wrapped(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for given in text.split('\n') {
        let mut line = String::new();
        for word in given.split(' ') {
            let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
            if line.is_empty() || width_of(&longer, size) <= room {
                line = longer;
            } else {
                lines.push(std::mem::replace(&mut line, word.to_owned()));
            }
        }
        lines.push(line);
    }
    lines
}

/// The plot of a panel on the sheet, without its labels.
#[derive(Debug, Clone, Copy)]
struct Plot {
    from: At,
    to: At,
}

/// What a panel shows of its axes, because its neighbours do not.
#[derive(Debug, Clone, Copy)]
struct Labels {
    x_ticks: bool,
    x_name: bool,
    y_ticks: bool,
    y_name: bool,
}

struct Layout<'a> {
    chart: &'a Chart,
    columns: usize,
    text: f64,
    labels: Vec<Labels>,
    plots: Vec<Plot>,
    /// Where the legend begins.
    legend: At,
    legend_width: f64,
    size: At,
}

/// Draws a chart.
pub(super) fn svg(chart: &Chart, alternative: &str) -> String {
    let layout = Layout::of(chart);
    let mut svg = Svg::new(layout.size);
    layout.draw(&mut svg);
    svg.finish(alternative)
}

fn entries_of(panel: &Panel) -> Vec<Entry> {
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

fn is_outside(panel: &Panel, point: &Point) -> bool {
    let place = panel.y.axis.place(point.at.1);
    point.at.1.is_finite() && !(-1e-9..=1.0 + 1e-9).contains(&place)
}

/// Whether the legend has to explain arrows at the edge.
fn has_outside(chart: &Chart) -> bool {
    let of_panel = |panel: &Panel| {
        let outside = |layer: &Layer| matches!(layer, Layer::Points(points) if points.iter().any(|point| is_outside(panel, point)));
        panel.layers.iter().any(outside)
    };
    chart.panels.iter().any(of_panel)
}

impl<'a> Layout<'a> {
    fn of(chart: &'a Chart) -> Self {
        let count = chart.panels.len();
        let columns = match (chart.columns, count) {
            (0, 0 | 1) => 1,
            (0, 2..=4) => 2,
            (0, 5..=9) => 3,
            (0, _) => 4,
            (given, _) => given,
        };
        let text = if columns > 2 { SMALL } else { TEXT };
        let rows = count.div_ceil(columns);
        let labels: Vec<Labels> = (0..count).map(|number| labels(chart, columns, number)).collect();
        let legend_width = legend_width(chart, text);
        let left = |number: usize| {
            let (panel, labels) = (&chart.panels[number], labels[number]);
            let longest = |scale: &Scale| {
                let ticks = scale.labelled_ticks();
                ticks.iter().map(|(_, label)| width_of(label, text)).fold(0.0, f64::max)
            };
            let ticks = if labels.y_ticks { TICK + 5.0 + longest(&panel.y) } else { 0.0 };
            ticks + if labels.y_name { text + 10.0 } else { 0.0 }
        };
        let of_column = |column: usize, room: &dyn Fn(usize) -> f64| {
            (column..count).step_by(columns).map(room).fold(0.0, f64::max)
        };
        let right = |number: usize| match &chart.panels[number].right {
            Some(scale) => {
                let ticks = scale.labelled_ticks();
                TICK + 12.0 + text + ticks.iter().map(|(_, label)| width_of(label, text)).fold(0.0, f64::max)
            }
            // The last label of the abscissa reaches beyond the plot.
            None => 10.0,
        };
        let sides: Vec<[f64; 2]> =
            (0..columns).map(|c| [of_column(c, &left), of_column(c, &right)]).collect();
        let labelled: f64 = sides.iter().flatten().sum();
        let gaps = GAP * (columns - 1) as f64;
        let beside = if legend_width > 0.0 { legend_width + GAP } else { 0.0 };
        let width = (WIDTH - 2.0 * MARGIN - beside - labelled - gaps) / columns as f64;
        let usual = match (columns, count) {
            (1, 0 | 1) => 360.0,
            (1, _) => 200.0,
            (2, _) => 220.0,
            (3, _) => 170.0,
            _ => 140.0,
        };
        let mut top = MARGIN;
        let mut plots = Vec::with_capacity(count);
        top += if chart.title.is_empty() {
            0.0
        } else {
            TEXT * 1.6 * wrapped(&chart.title, TEXT, WIDTH).len() as f64
        };
        let first = top;
        for row in 0..rows {
            let here = row * columns..(row * columns + columns).min(count);
            let above = |number: usize| {
                let panel = &chart.panels[number];
                let title = if panel.title.is_empty() {
                    0.0
                } else {
                    wrapped(&panel.title, text, width).len() as f64 * text * 1.25 + 4.0
                };
                let has_marks = panel.layers.iter().any(
                    |layer| matches!(layer, Layer::Guide(guide) if guide.is_vertical && !guide.label.is_empty()),
                );
                title + if has_marks { 2.0 * MARK_ROW } else { 5.0 }
            };
            let below = |number: usize| {
                let ticks = if labels[number].x_ticks { TICK + text + 5.0 } else { 3.0 };
                ticks + if labels[number].x_name { text + 8.0 } else { 0.0 }
            };
            let height = |number: usize| match chart.panels[number].height {
                0.0 => usual,
                own => own,
            };
            let largest = |of: &dyn Fn(usize) -> f64| here.clone().map(of).fold(0.0, f64::max);
            let (above, height, below) = (largest(&above), largest(&height), largest(&below));
            let own = |number: usize| entries_height(&entries_of(&chart.panels[number]), legend_width, text);
            // A panel is as high as its own legend.
            let height = height.max(largest(&own) - above);
            let mut x = MARGIN;
            for (number, [left, right]) in here.clone().zip(&sides) {
                let from = (x + left, top + above);
                plots.push(Plot { from, to: (from.0 + width, from.1 + height) });
                x += left + width + right + GAP;
                debug_assert!(number < count);
            }
            top += above + height + below + if row + 1 < rows { GAP / 2.0 } else { 0.0 };
        }
        let legend = (WIDTH - MARGIN - legend_width, first + 6.0);
        let beside = entries_height(&legend_entries(chart), legend_width, text)
            + chart.colours.as_ref().map_or(0.0, |_| COLOURS + 3.5 * TEXT);
        let height = (top + MARGIN).max(legend.1 + beside + MARGIN);
        Self { chart, columns, text, labels, plots, legend, legend_width, size: (WIDTH, height.ceil()) }
    }

    fn draw(&self, svg: &mut Svg) {
        let title = wrapped(&self.chart.title, TEXT, WIDTH);
        for (line, words) in title.iter().enumerate().filter(|(_, words)| !words.is_empty()) {
            let y = MARGIN + TEXT * (0.8 + 1.5 * line as f64);
            svg.plain((WIDTH / 2.0, y), Anchor::Middle, INK, TEXT, words);
        }
        let blank = Panel::blank();
        for (number, panel) in self.chart.panels.iter().enumerate().filter(|(_, panel)| **panel != blank) {
            self.draw_panel(svg, panel, self.plots[number], self.labels[number]);
        }
        let end = draw_entries(svg, &legend_entries(self.chart), self.legend, self.legend_width, self.text);
        if let Some(scale) = &self.chart.colours {
            draw_colours(svg, scale, (self.legend.0, end + TEXT));
        }
    }

    fn draw_panel(&self, svg: &mut Svg, panel: &Panel, plot: Plot, labels: Labels) {
        let (Plot { from, to }, text) = (plot, self.text);
        if !panel.title.is_empty() {
            let lines = wrapped(&panel.title, text, to.0 - from.0);
            let marks = panel.layers.iter().any(
                |layer| matches!(layer, Layer::Guide(guide) if guide.is_vertical && !guide.label.is_empty()),
            );
            let bottom = from.1 - if marks { 2.0 * MARK_ROW } else { 5.0 };
            for (line, words) in lines.iter().enumerate() {
                let y = bottom - (lines.len() - line) as f64 * text * 1.25 + text * 0.5;
                svg.plain(((from.0 + to.0) / 2.0, y), Anchor::Middle, INK, text, words);
            }
        }
        self.draw_axes(svg, panel, plot, labels);
        if panel.layers.is_empty() && !panel.note.is_empty() {
            let middle = ((from.0 + to.0) / 2.0, (from.1 + to.1) / 2.0);
            let size = text.min((to.0 - from.0) / (CHARACTER * panel.note.chars().count() as f64));
            svg.plain(middle, Anchor::Middle, GREY, size, &panel.note);
        }
        svg.clipped(from, to, |svg| {
            for layer in &panel.layers {
                draw_ground(svg, panel, plot, layer);
            }
        });
        let frame = [from, (to.0, from.1), to, (from.0, to.1), from];
        svg.lines(&frame, Pen::solid(INK, 1.0));
        draw_marks(svg, panel, plot, text);
        for layer in &panel.layers {
            match layer {
                Layer::Points(points) => points.iter().for_each(|point| draw_point(svg, panel, plot, point)),
                Layer::Cells(cells) => cells.iter().for_each(|cell| draw_cell_signs(svg, panel, plot, cell)),
                _ => {}
            }
        }
        let own = entries_of(panel);
        if !own.is_empty() {
            draw_entries(svg, &own, (self.legend.0, from.1 + 4.0), self.legend_width, text);
        }
    }

    fn draw_axes(&self, svg: &mut Svg, panel: &Panel, plot: Plot, labels: Labels) {
        let (Plot { from, to }, text) = (plot, self.text);
        let pitch = (to.0 - from.0) / panel.x.labelled_ticks().len().max(1) as f64;
        let mut free = f64::NEG_INFINITY;
        for (at, label) in panel.x.labelled_ticks() {
            let x = plot.x(&panel.x.axis, at);
            if x < from.0 - 0.1 || x > to.0 + 0.1 {
                continue;
            }
            if panel.x.has_grid && !matches!(panel.x.axis, Axis::Names(_)) {
                svg.lines(&[(x, from.1), (x, to.1)], Pen::solid(GRID, 1.0));
            }
            svg.lines(&[(x, to.1), (x, to.1 + TICK)], Pen::solid(INK, 1.0));
            // Names are written smaller where they are long; other labels are left out where there is no room for them.
            let size = match &panel.x.axis {
                Axis::Names(_) => {
                    text.min(pitch / (CHARACTER * label.chars().count().max(1) as f64)).max(9.0)
                }
                _ => text,
            };
            let half = width_of(&label, size) / 2.0;
            if labels.x_ticks && x - half > free {
                svg.plain((x, to.1 + TICK + 2.0 + text / 2.0), Anchor::Middle, INK, size, &label);
                free = x + half + 4.0;
            }
        }
        if labels.x_name {
            let y = to.1 + 1.5 * text + 12.0;
            svg.plain(((from.0 + to.0) / 2.0, y), Anchor::Middle, INK, text, &panel.x.label);
        }
        draw_ordinate(svg, &panel.y, plot, text, labels, false);
        if let Some(right) = &panel.right {
            let all = Labels { y_ticks: true, y_name: true, ..labels };
            draw_ordinate(svg, right, plot, text, all, true);
        }
    }
}

fn draw_ordinate(svg: &mut Svg, scale: &Scale, plot: Plot, text: f64, labels: Labels, is_right: bool) {
    let Plot { from, to } = plot;
    let (edge, side, anchor) =
        if is_right { (to.0, 1.0, Anchor::Start) } else { (from.0, -1.0, Anchor::End) };
    let mut longest = 0.0_f64;
    let mut free = f64::INFINITY;
    for (at, label) in scale.labelled_ticks() {
        let y = plot.y(&scale.axis, at);
        if y < from.1 - 0.1 || y > to.1 + 0.1 {
            continue;
        }
        if scale.has_grid && !is_right && !matches!(scale.axis, Axis::Names(_)) {
            svg.lines(&[(from.0, y), (to.0, y)], Pen::solid(GRID, 1.0));
        }
        svg.lines(&[(edge, y), (edge + side * TICK, y)], Pen::solid(INK, 1.0));
        longest = longest.max(width_of(&label, text));
        if labels.y_ticks
            && (y + text / 2.0 < free || matches!(scale.axis, Axis::Names(_)) && y - text / 2.0 > free)
        {
            svg.plain((edge + side * (TICK + 3.0), y), anchor, INK, text, &label);
            free = y - text / 2.0;
        }
    }
    if labels.y_name {
        // A name that is longer than the plot reaches below it, and hardly above it, where the sheet may end.
        let height = to.1 - from.1;
        let room = width_of(&scale.label, text);
        let size = if room > height + 60.0 { text * (height + 60.0) / room } else { text };
        let beyond = (room * size / text - height) / 2.0;
        let x = edge + side * (TICK + 11.0 + longest + text / 2.0);
        svg.upwards((x, (from.1 + to.1) / 2.0 + (beyond - 8.0).max(0.0)), size, &scale.label);
    }
}

impl Plot {
    fn x(&self, axis: &Axis, value: f64) -> f64 {
        match value {
            f64::NEG_INFINITY => self.from.0,
            f64::INFINITY => self.to.0,
            value => self.from.0 + axis.place(value) * (self.to.0 - self.from.0),
        }
    }

    fn y(&self, axis: &Axis, value: f64) -> f64 {
        match value {
            f64::NEG_INFINITY => self.to.1,
            f64::INFINITY => self.from.1,
            value => self.to.1 - axis.place(value) * (self.to.1 - self.from.1),
        }
    }

    fn at(&self, panel: &Panel, (x, y): At, right: bool) -> At {
        let scale = panel.right.as_ref().filter(|_| right).unwrap_or(&panel.y);
        (self.x(&panel.x.axis, x), self.y(&scale.axis, y))
    }
}

fn labels(chart: &Chart, columns: usize, number: usize) -> Labels {
    let panel = &chart.panels[number];
    let below = chart.panels.get(number + columns);
    let before = (number % columns > 0).then(|| &chart.panels[number - 1]);
    let shares_x = below.is_some_and(|below| below.x == panel.x);
    // A title between two panels would separate the ticks from the upper one.
    let is_joined = shares_x && below.is_some_and(|below| below.title.is_empty() || columns > 1);
    let shares_y = before.is_some_and(|before| before.y == panel.y && before.right.is_none());
    let has_same_name = before.is_some_and(|before| before.y.label == panel.y.label);
    Labels {
        x_ticks: !is_joined,
        x_name: !shares_x && !panel.x.label.is_empty(),
        y_ticks: !shares_y,
        y_name: !shares_y && !has_same_name && !panel.y.label.is_empty(),
    }
}

fn legend_entries(chart: &Chart) -> Vec<Entry> {
    let outside = has_outside(chart).then(|| Entry::shape(Shape::Up, "outside of the axis"));
    chart.legend.iter().cloned().chain(outside).collect()
}

fn legend_width(chart: &Chart, text: f64) -> f64 {
    let own = chart.panels.iter().flat_map(entries_of);
    let longest = legend_entries(chart)
        .into_iter()
        .chain(own)
        .flat_map(|entry| {
            let beside = if entry.sample == Sample::Heading { 0.0 } else { SAMPLE + 8.0 };
            entry.text.split('\n').map(|line| beside + width_of(line, text)).collect::<Vec<_>>()
        })
        .fold(0.0, f64::max);
    let colours = chart.colours.as_ref().map_or(0.0, |scale| width_of(&scale.title, text).max(LEGEND[0]));
    match longest.max(colours) {
        0.0 => 0.0,
        width => width.clamp(LEGEND[0], LEGEND[1]),
    }
}

fn lines_of(entry: &Entry, width: f64, text: f64) -> Vec<String> {
    let beside = if entry.sample == Sample::Heading { 0.0 } else { SAMPLE + 8.0 };
    wrapped(&entry.text, text, width - beside)
}

fn pitch(text: f64) -> f64 {
    text * 1.28
}

fn entries_height(entries: &[Entry], width: f64, text: f64) -> f64 {
    let lines: usize = entries.iter().map(|entry| lines_of(entry, width, text).len()).sum();
    lines as f64 * pitch(text) + entries.len() as f64 * 4.0
}

/// Draws the entries below one another and returns where they end.
fn draw_entries(svg: &mut Svg, entries: &[Entry], (x, top): At, width: f64, text: f64) -> f64 {
    let mut y = top;
    for entry in entries {
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

fn draw_colours(svg: &mut Svg, scale: &ColourScale, (x, top): At) {
    svg.plain((x, top + TEXT / 2.0), Anchor::Start, INK, TEXT, &scale.title);
    let (top, width) = (top + 1.6 * TEXT, SAMPLE);
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

/// Draws what must not reach beyond the plot.
fn draw_ground(svg: &mut Svg, panel: &Panel, plot: Plot, layer: &Layer) {
    match layer {
        Layer::Line { points, pen, right } => {
            for connected in points.split(|(x, y)| !x.is_finite() || !y.is_finite()) {
                let path: Vec<At> = connected.iter().map(|at| plot.at(panel, *at, *right)).collect();
                if path.len() > 1 {
                    svg.lines(&visible(&path), *pen);
                }
            }
        }
        Layer::Area(corners, colour, cover) => {
            let corners: Vec<At> = corners.iter().map(|at| plot.at(panel, *at, false)).collect();
            svg.polygon(&corners, (*colour, *cover), None);
        }
        Layer::Cells(cells) => {
            for cell in cells {
                let (from, to) = corners(panel, plot, cell);
                if let Some(fill) = cell.fill {
                    svg.rectangle(from, to, fill);
                }
            }
        }
        Layer::Guide(guide) if !guide.is_vertical => {
            let scale = panel.right.as_ref().filter(|_| guide.right).unwrap_or(&panel.y);
            if scale.axis.range().contains(&guide.at) {
                let y = plot.y(&scale.axis, guide.at);
                svg.lines(&[(plot.from.0, y), (plot.to.0, y)], guide.pen);
            }
        }
        Layer::Guide(_) | Layer::Points(_) => {}
    }
}

/// The points of a line without those that are nearly at the place of the one before.
fn visible(path: &[At]) -> Vec<At> {
    let mut kept: Vec<At> = Vec::with_capacity(path.len().min(2_000));
    for at in path {
        if kept.last().is_none_or(|last| (last.0 - at.0).abs() > NEAR || (last.1 - at.1).abs() > NEAR) {
            kept.push(*at);
        }
    }
    if kept.len() < 2 || kept.last() != path.last() {
        kept.extend(path.last());
    }
    kept
}

/// Draws vertical lines with their labels.
fn draw_marks(svg: &mut Svg, panel: &Panel, plot: Plot, text: f64) {
    let mut taken = [f64::NEG_INFINITY; 2];
    let guides = panel.layers.iter().filter_map(|layer| match layer {
        Layer::Guide(guide) if guide.is_vertical => Some(guide),
        _ => None,
    });
    for Guide { at, pen, label, .. } in guides {
        let x = plot.x(&panel.x.axis, *at);
        if x < plot.from.0 - 0.1 || x > plot.to.0 + 0.1 {
            continue;
        }
        svg.lines(&[(x, plot.from.1), (x, plot.to.1)], *pen);
        if !label.is_empty() {
            let half = width_of(label, text) / 2.0;
            let row = usize::from(x - half < taken[0]);
            taken[row] = x + half + 4.0;
            let y = plot.from.1 - MARK_ROW * (0.5 + row as f64);
            svg.plain((x, y), Anchor::Middle, INK, text, label);
        }
    }
}

fn draw_point(svg: &mut Svg, panel: &Panel, plot: Plot, point: &Point) {
    if !point.at.0.is_finite() || !point.at.1.is_finite() {
        return;
    }
    let Marker { colour, radius, shape, .. } = point.marker;
    let (x, y) = plot.at(panel, point.at, false);
    let shown = (x, y.clamp(plot.from.1, plot.to.1));
    if is_outside(panel, point) {
        let sign = if y < shown.1 { -1.0 } else { 1.0 };
        let (near, far) = (shown.1 + sign * (radius + 2.0), shown.1 + sign * (radius + 8.0));
        svg.polygon(&[(x - 4.0, near), (x + 4.0, near), (x, far)], (colour, 1.0), None);
    } else if point.error > 0.0 {
        let ends =
            [1.0, -1.0].map(|sign| plot.at(panel, (point.at.0, point.at.1 + sign * point.error), false).1);
        let ends = ends.map(|y| y.clamp(plot.from.1, plot.to.1));
        // The marker hides a smaller error, but no cross does.
        if ends[1] - shown.1 > radius || matches!(shape, Shape::Cross | Shape::Plus | Shape::Star) {
            let pen = Pen::solid(colour, 1.0);
            svg.lines(&[(x, ends[0]), (x, ends[1])], pen);
            for end in ends {
                svg.lines(&[(x - radius, end), (x + radius, end)], pen);
            }
        }
    }
    draw_marker(svg, shown, point.marker);
    if let Some(tip) = &point.tip {
        svg.hit_circle(shown, (2.0 * radius).max(6.0), tip);
    }
}

/// Draws a marker; a hollow one has the ground inside.
fn draw_marker(svg: &mut Svg, (x, y): At, marker: Marker) {
    let Marker { shape, colour, is_hollow, radius } = marker;
    let outline = Pen::solid(colour, (0.35 * radius).clamp(1.0, 2.0));
    let corners: &[At] = match shape {
        Shape::Circle => {
            let fill = if is_hollow { PAPER } else { colour };
            svg.circle((x, y), radius, Some(fill), Some(outline));
            return;
        }
        Shape::Cross => return strokes(svg, (x, y), marker, &[(0.8, 0.8), (0.8, -0.8)]),
        Shape::Plus => return strokes(svg, (x, y), marker, &[(1.0, 0.0), (0.0, 1.0)]),
        Shape::Star => return strokes(svg, (x, y), marker, &[(1.0, 0.0), (0.5, 0.87), (0.5, -0.87)]),
        // All shapes have about the same area.
        Shape::Square => &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
        Shape::Diamond => &[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)],
        Shape::Up => &[(0.0, -1.3), (1.2, 0.8), (-1.2, 0.8)],
        Shape::Down => &[(0.0, 1.3), (1.2, -0.8), (-1.2, -0.8)],
    };
    let corners: Vec<At> = corners.iter().map(|(dx, dy)| (x + dx * radius, y + dy * radius)).collect();
    svg.polygon(&corners, (if is_hollow { PAPER } else { colour }, 1.0), Some(outline));
}

fn strokes(svg: &mut Svg, (x, y): At, marker: Marker, ends: &[At]) {
    for (dx, dy) in ends.iter().map(|(dx, dy)| (1.3 * marker.radius * dx, 1.3 * marker.radius * dy)) {
        svg.lines(&[(x - dx, y - dy), (x + dx, y + dy)], Pen::solid(marker.colour, 2.2));
    }
}

/// The corners of a cell inside of the plot.
fn corners(panel: &Panel, plot: Plot, cell: &Cell) -> (At, At) {
    let x = cell.x.map(|x| plot.x(&panel.x.axis, x).clamp(plot.from.0, plot.to.0));
    let y = cell.y.map(|y| plot.y(&panel.y.axis, y).clamp(plot.from.1, plot.to.1));
    ((x[0].min(x[1]), y[0].min(y[1])), (x[0].max(x[1]), y[0].max(y[1])))
}

/// Draws the dot, the text and the mark of a cell.
fn draw_cell_signs(svg: &mut Svg, panel: &Panel, plot: Plot, cell: &Cell) {
    let (from, to) = corners(panel, plot, cell);
    let ink = palette::contrasting(cell.fill.unwrap_or(PAPER));
    let dot = cell.dot.map(|at| plot.at(panel, at, false));
    let middle = dot.unwrap_or(((from.0 + to.0) / 2.0, (from.1 + to.1) / 2.0));
    // The text is centred at the dot, which may be near to a side of the cell.
    let room = 2.0 * (middle.0 - from.0).min(to.0 - middle.0) - 3.0;
    let fitting = room / (DIGIT * cell.text.chars().count().max(1) as f64);
    let (above, below) = (middle.1 - from.1 - 3.0, to.1 - middle.1 - 3.0);
    let high = if dot.is_some() { above.max(below) } else { 0.75 * (to.1 - from.1) };
    let size = fitting.min(high).min(TEXT);
    if let Some(dot) = dot {
        svg.circle(dot, 1.8, Some(ink), None);
    }
    if size >= 8.0 && !cell.text.is_empty() {
        let y = match dot {
            // Both sides of a dot in the middle differ by roundings.
            Some(dot) if above + 0.1 >= size => dot.1 - 3.0 - size / 2.0,
            Some(dot) => dot.1 + 3.0 + size / 2.0,
            None => middle.1,
        };
        svg.plain((middle.0, y), Anchor::Middle, ink, size, &cell.text);
    }
    if let Some(mark) = cell.mark {
        let room = (to.0 - from.0).min(to.1 - from.1);
        let radius = mark.radius.min(room / 4.0).max(2.0);
        draw_marker(svg, (to.0 - radius - 2.5, from.1 + radius + 2.5), mark.sized(radius));
    }
    if let Some(tip) = &cell.tip {
        svg.hit_rectangle(from, (to.0.max(from.0 + 0.5), to.1.max(from.1 + 0.5)), tip);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Rgb, Tip};
    use super::*;

    fn panel() -> Panel {
        let x = Scale::from_to("time", 0.0, 1.0);
        Panel::new("node", x, Scale::from_to("velocity [mm/s]", -250.0, 250.0))
    }

    fn count(svg: &str, text: &str) -> usize {
        svg.matches(text).count()
    }

    /// Protects: a level beyond the axis is named with its value and not drawn at the edge, where a reader would take it for
    /// another value; one on the axis is drawn.
    #[test]
    fn no_level_is_moved_to_the_edge() {
        let drawing = |at: f64| {
            let mut panel = panel();
            panel.layers.push(Layer::Guide(Guide { label: "disk".to_owned(), ..Guide::level(at, INK) }));
            Chart::of(panel).svg("")
        };
        let (within, beyond) = (drawing(67.0), drawing(628.0));
        assert!(beyond.contains("off the axis") && !within.contains("off the axis"));
        assert_eq!((count(&within, "stroke-dasharray"), count(&beyond, "stroke-dasharray")), (2, 0));
    }

    /// Protects: a point beyond the axis is at its edge, has an arrow, and the legend says what that means; the attributes of
    /// its tooltip have its own value.
    #[test]
    fn a_point_beyond_the_axis_has_an_arrow() {
        let drawing = |y: f64| {
            let mut panel = panel();
            let marker = Marker::new(Shape::Circle, Rgb(0, 114, 178));
            let tip = Tip { title: "job".to_owned(), data: vec![("y", y.to_string())] };
            panel.layers.push(Layer::Points(vec![Point {
                at: (0.5, y),
                error: 0.0,
                marker,
                tip: Some(tip),
            }]));
            Chart::of(panel).svg("")
        };
        let (within, beyond) = (drawing(200.0), drawing(900.0));
        assert!(!within.contains("outside of the axis") && beyond.contains("outside of the axis"));
        assert!(beyond.contains("data-y=\"900\""));
        assert_eq!(count(&beyond, "<polygon"), count(&within, "<polygon") + 2, "an arrow, and its entry");
    }

    /// Protects: panels with the same axes share names and ticks, and panels with different ones have their own.
    #[test]
    fn equal_axes_are_labelled_once() {
        let texts = |other: Scale| {
            let panels = vec![panel(), panel(), panel(), Panel { y: other, ..panel() }];
            let svg = Chart { panels, ..Chart::default() }.svg("");
            ["velocity [mm/s]", "time", ">−200<"].map(|text| count(&svg, &format!("{text}")))
        };
        assert_eq!(texts(panel().y), [2, 2, 2]);
        assert_eq!(texts(Scale::from_to("velocity [mm/s]", -300.0, 250.0))[2], 3);
    }

    /// Protects: a line is interrupted where a value is missing, and a long one has no more points than a reader can see.
    #[test]
    fn lines_have_what_can_be_seen() {
        let mut panel = panel();
        let points = (0..100_000).map(|i| (f64::from(i) / 1e5, if i == 50_000 { f64::NAN } else { 0.0 }));
        panel.line("v", Pen::solid(INK, 1.0), points.collect());
        let svg = Chart::of(panel).svg("");
        assert!(svg.len() < 40_000, "{}", svg.len());
        let long = svg.lines().filter(|line| line.starts_with("<polyline") && line.len() > 1_000).count();
        assert_eq!(long, 2);
    }
}

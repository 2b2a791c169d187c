//! The layout of a chart: panels in rows and columns, ticks, names of axes, and the legend on the right side.
//!
//! Neighbouring panels with the same axis share its ticks and its name. All lengths are in pixels of the drawing, which is
//! made for a page of [`WIDTH`] and is readable at half of it.

mod axes;
mod legend;
mod marks;
mod measures;

use super::palette::{GREY, INK};
use super::svg::{Anchor, At, Pen, Svg};
use super::{Chart, Layer, Panel};
use axes::Labels;
use legend::{
    COLOURS, draw_colours, draw_entries, entries_height, entries_of, legend_entries, legend_width, pitch,
};
use marks::{Plot, draw_cell_signs, draw_ground, draw_marks, draw_point};
use measures::{CHARACTER, GAP, LEGEND, MARGIN, MARK_ROW, SMALL, TEXT, TICK, WIDTH, ticks_width, wrapped};

struct Layout<'a> {
    chart: &'a Chart,
    columns: usize,
    text: f64,
    labels: Vec<Labels>,
    plots: Vec<Plot>,
    /// Where the legend begins.
    legend: At,
    legend_width: f64,
    /// Whether panels in several columns have one name for all abscissas, and one for all ordinates.
    common: [bool; 2],
    /// The height of the common name of the abscissas.
    foot: f64,
    size: At,
}

/// Draws a chart.
pub(super) fn svg(chart: &Chart, alternative: &str) -> String {
    let layout = Layout::of(chart);
    let mut svg = Svg::new(layout.size);
    layout.draw(&mut svg);
    svg.finish(alternative)
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
        let common = common_names(chart, columns);
        let own_labels = |number| {
            let own = labels(chart, columns, number);
            Labels { x_name: own.x_name && !common[0], y_name: own.y_name && !common[1], ..own }
        };
        let labels: Vec<Labels> = (0..count).map(own_labels).collect();
        let legend_width = legend_width(chart, text);
        let left = |number: usize| {
            let (panel, labels) = (&chart.panels[number], labels[number]);
            let ticks = if labels.y_ticks { TICK + 5.0 + ticks_width(&panel.y, text) } else { 0.0 };
            let has_name = labels.y_name || common[1] && number.is_multiple_of(columns);
            ticks + if has_name { text + 12.0 } else { 0.0 }
        };
        let of_column = |column: usize, room: &dyn Fn(usize) -> f64| {
            (column..count).step_by(columns).map(room).fold(0.0, f64::max)
        };
        let right = |number: usize| match &chart.panels[number].right {
            Some(scale) => TICK + 14.0 + text + ticks_width(scale, text),
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
                    wrapped(&panel.title, text, width + 2.0 * GAP).len() as f64 * text * 1.25 + 4.0
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
        let foot = top + 0.5 * text + 3.0;
        top += if common[0] { text + 10.0 } else { 0.0 };
        let legend = (WIDTH - MARGIN - legend_width, first + 6.0);
        let beside = entries_height(&legend_entries(chart), legend_width, text)
            + chart.colours.as_ref().map_or(0.0, |scale| {
                COLOURS + wrapped(&scale.title, TEXT, LEGEND[1]).len() as f64 * pitch(TEXT) + 2.5 * TEXT
            });
        let height = (top + MARGIN).max(legend.1 + beside + MARGIN);
        let size = (WIDTH, height.ceil());
        Self { chart, columns, text, labels, plots, legend, legend_width, common, foot, size }
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
        self.draw_common_names(svg);
        let end = draw_entries(svg, &legend_entries(self.chart), self.legend, self.legend_width, self.text);
        if let Some(scale) = &self.chart.colours {
            draw_colours(svg, scale, (self.legend.0, end + TEXT));
        }
    }

    /// Writes the names that all panels have in common once, in the middle of all of them.
    fn draw_common_names(&self, svg: &mut Svg) {
        let Some(panel) = self.chart.panels.first() else { return };
        let from = self.plots[0].from;
        let to = self.plots.iter().fold(from, |to, plot| (to.0.max(plot.to.0), to.1.max(plot.to.1)));
        if self.common[0] {
            svg.plain(((from.0 + to.0) / 2.0, self.foot), Anchor::Middle, INK, self.text, &panel.x.label);
        }
        if self.common[1] {
            let x = MARGIN + 0.5 * self.text;
            axes::upwards(svg, (x, (from.1 + to.1) / 2.0), to.1 - from.1, self.text, &panel.y.label);
        }
    }

    fn draw_panel(&self, svg: &mut Svg, panel: &Panel, plot: Plot, labels: Labels) {
        let (Plot { from, to }, text) = (plot, self.text);
        if !panel.title.is_empty() {
            let lines = wrapped(&panel.title, text, to.0 - from.0 + 2.0 * GAP);
            let marks = panel.layers.iter().any(
                |layer| matches!(layer, Layer::Guide(guide) if guide.is_vertical && !guide.label.is_empty()),
            );
            let bottom = from.1 - if marks { 2.0 * MARK_ROW } else { 5.0 };
            for (line, words) in lines.iter().enumerate() {
                let y = bottom - (lines.len() - line) as f64 * text * 1.25 + text * 0.5;
                svg.plain(((from.0 + to.0) / 2.0, y), Anchor::Middle, INK, text, words);
            }
        }
        axes::draw(svg, panel, plot, labels, text, self.columns == 1);
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
}

fn labels(chart: &Chart, columns: usize, number: usize) -> Labels {
    let panel = &chart.panels[number];
    let below = chart.panels.get(number + columns);
    let before = (!number.is_multiple_of(columns)).then(|| &chart.panels[number - 1]);
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

/// Whether panels in several columns have the same name of the abscissa, and the same of the ordinate.
fn common_names(chart: &Chart, columns: usize) -> [bool; 2] {
    let is_common = |name: &dyn Fn(&Panel) -> String| {
        let mut names = chart.panels.iter().map(name);
        let first = names.next().unwrap_or_default();
        columns > 1 && !first.is_empty() && names.all(|own| own == first)
    };
    let has_right = chart.panels.iter().any(|panel| panel.right.is_some());
    [is_common(&|panel| panel.x.label.clone()), !has_right && is_common(&|panel| panel.y.label.clone())]
}

#[cfg(test)]
mod tests {
    use super::super::{Guide, Marker, Point, Rgb, Scale, Shape, Tip};
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

    /// Protects: panels with the same names of axes have them once, those with the same axes share ticks, and panels with different
    /// ones have their own.
    #[test]
    fn equal_axes_are_labelled_once() {
        let texts = |other: Scale| {
            let panels = vec![panel(), panel(), panel(), Panel { y: other, ..panel() }];
            let svg = Chart { panels, ..Chart::default() }.svg("");
            ["velocity [mm/s]", "time", ">−200<"].map(|text| count(&svg, text))
        };
        assert_eq!(texts(panel().y), [1, 1, 2]);
        assert_eq!(texts(Scale::from_to("velocity [mm/s]", -300.0, 250.0)), [1, 1, 3]);
        assert_eq!(texts(Scale::from_to("force [N]", -250.0, 250.0))[..2], [2, 1]);
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

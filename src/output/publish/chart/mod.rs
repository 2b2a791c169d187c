//! Charts as data, and their drawing as SVG.
//!
//! ```text
//! rows ──► Chart { panels: [Panel { x, y, layers }], legend } ──► render ──► one SVG
//! ```
//!
//! A figure is a function from rows to a [`Chart`], which a test compares as data. Only the renderer knows about pixels: it
//! lays out panels, ticks, texts and the legend. A point beyond its axis is drawn at the edge with an arrow, and the legend
//! says so.

mod axis;
pub mod palette;
mod render;
mod svg;

pub use axis::Axis;
pub use palette::Rgb;
pub use svg::{Anchor, At, Pen, Svg};

use palette::{GREY, INK};
use std::collections::HashMap;

/// A figure: panels with a common legend.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Chart {
    /// A line above the panels; may be empty.
    pub title: String,
    /// The drawings.
    pub panels: Vec<Panel>,
    /// So many panels stand beside one another; 0 means as many as fit.
    pub columns: usize,
    /// Beside all panels.
    pub legend: Vec<Entry>,
    /// The colours of values, below the legend.
    pub colours: Option<ColourScale>,
}

/// One of the drawings of a figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The title above it; may be empty.
    pub title: String,
    /// Height of the plot \[px\]; 0 means the usual height for the number of panels.
    pub height: f64,
    /// The abscissa.
    pub x: Scale,
    /// The ordinate.
    pub y: Scale,
    /// A second ordinate on the right side.
    pub right: Option<Scale>,
    /// What is drawn, the last on top.
    pub layers: Vec<Layer>,
    /// Its own legend, beside it. All panels have one, or none.
    pub legend: Vec<Entry>,
    /// Words in place of the layers if these are empty: `no results yet`.
    pub note: String,
}

/// An axis with its name and its ticks.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// The quantity and its unit.
    pub label: String,
    /// The axis.
    pub axis: Axis,
    /// The ticks with their labels; without any, the axis chooses round numbers.
    pub ticks: Vec<(f64, String)>,
    /// Whether there are lines across the plot at the ticks.
    pub has_grid: bool,
}

/// Something drawn in a panel.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// A line through points. A number that is not finite interrupts it.
    Line {
        /// The points.
        points: Vec<At>,
        /// How it is drawn.
        pen: Pen,
        /// Whether it belongs to the scale on the right side.
        right: bool,
    },
    /// A filled polygon: its corners, its colour, and how much it covers, from 0 to 1.
    Area(Vec<At>, Rgb, f64),
    /// Points that are not joined.
    Points(Vec<Point>),
    /// Rectangles.
    Cells(Vec<Cell>),
    /// A line across the plot at a value.
    Guide(Guide),
}

/// A point with a marker.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Its values.
    pub at: At,
    /// The error of the ordinate on both sides; 0 if there is none.
    pub error: f64,
    /// How it is drawn.
    pub marker: Marker,
    /// Its tooltip.
    pub tip: Option<Tip>,
}

/// How a point is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marker {
    /// Its shape.
    pub shape: Shape,
    /// Its colour.
    pub colour: Rgb,
    /// Whether only its outline is drawn.
    pub is_hollow: bool,
    /// Half its size \[px\].
    pub radius: f64,
}

/// The shape of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "shapes")]
pub enum Shape {
    Circle,
    Square,
    Diamond,
    Up,
    Down,
    Cross,
    Plus,
    Star,
}

/// A rectangle with a text.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cell {
    /// Its ends along the abscissa. Infinite ends are at the edges of the plot.
    pub x: [f64; 2],
    /// Its ends along the ordinate.
    pub y: [f64; 2],
    /// Its colour; `None` for a part of the plot that only has a tooltip.
    pub fill: Option<Rgb>,
    /// A few characters in it, left out if they do not fit.
    pub text: String,
    /// A dot at a place in it, with the text above.
    pub dot: Option<At>,
    /// A mark in its corner.
    pub mark: Option<Marker>,
    /// Its tooltip.
    pub tip: Option<Tip>,
}

/// A line across the plot.
#[derive(Debug, Clone, PartialEq)]
pub struct Guide {
    /// The value.
    pub at: f64,
    /// Whether it is vertical, at a value of the abscissa.
    pub is_vertical: bool,
    /// How it is drawn.
    pub pen: Pen,
    /// A few characters, on top of a vertical line, and in the legend for a horizontal one; may be empty.
    pub label: String,
    /// Whether it belongs to the scale on the right side.
    pub right: bool,
}

/// What a reader sees who points at something.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Tip {
    /// The text in lines; the first is the heading.
    pub title: String,
    /// Names and values of the attributes `data-NAME`, for programs; names are lower-case ASCII letters.
    pub data: Vec<(&'static str, String)>,
}

/// An entry of a legend: a sample, and what it means, in one or more lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// What it shows.
    pub sample: Sample,
    /// What it means.
    pub text: String,
}

/// The sample of an entry.
#[derive(Debug, Clone, PartialEq)]
pub enum Sample {
    /// Nothing: the entry is a heading.
    Heading,
    /// A line.
    Line(Pen),
    /// A marker.
    Marker(Marker),
    /// A cell with a few characters.
    Cell(Rgb, String),
}

/// The colours of values.
#[derive(Debug, Clone, PartialEq)]
pub struct ColourScale {
    /// The quantity and its unit.
    pub title: String,
    /// The colours from the bottom to the top.
    pub colours: Vec<Rgb>,
    /// Places from 0 (bottom) to 1 (top) with their labels.
    pub ticks: Vec<(f64, String)>,
}

/// A tooltip for each of more marks would make a figure too large for a browser.
pub const MAX_TIPS: usize = 2_000;

impl Chart {
    /// A chart of one panel.
    pub fn of(panel: Panel) -> Self {
        Self { panels: vec![panel], ..Self::default() }
    }

    /// Panels one above the other.
    pub fn stack(panels: Vec<Panel>) -> Self {
        Self { panels, columns: 1, ..Self::default() }
    }

    /// The drawing. `alternative` says in words what it shows.
    pub fn svg(&self, alternative: &str) -> String {
        render::svg(self, alternative)
    }

    /// All tooltips.
    pub fn tips(&self) -> impl Iterator<Item = &Tip> {
        self.panels.iter().flat_map(|panel| &panel.layers).flat_map(Layer::tips).flatten()
    }

    fn tips_mut(&mut self) -> impl Iterator<Item = &mut Option<Tip>> {
        self.panels.iter_mut().flat_map(|panel| &mut panel.layers).flat_map(Layer::tips_mut)
    }

    /// Removes the tooltips if there are more than [`MAX_TIPS`].
    #[must_use]
    pub fn with_few_tips(self) -> Self {
        if self.tips().count() > MAX_TIPS { self.without_tips() } else { self }
    }

    /// Removes the tooltips.
    #[must_use]
    pub fn without_tips(mut self) -> Self {
        self.tips_mut().for_each(|tip| *tip = None);
        self
    }

    /// Lets the marks of jobs lead to pages: `pages` has an address for some values of `data-job`. Returns whether there is one.
    pub fn link(&mut self, pages: &HashMap<String, String>) -> bool {
        let mut has_link = false;
        for tip in self.tips_mut().flatten() {
            let job = tip.data.iter().position(|(name, _)| *name == "job");
            if let Some((at, page)) = job.and_then(|at| Some((at, pages.get(&tip.data[at].1)?))) {
                tip.data.insert(at + 1, ("page", page.clone()));
                has_link = true;
            }
        }
        has_link
    }
}

impl Layer {
    fn tips(&self) -> Box<dyn Iterator<Item = &Option<Tip>> + '_> {
        match self {
            Self::Points(points) => Box::new(points.iter().map(|point| &point.tip)),
            Self::Cells(cells) => Box::new(cells.iter().map(|cell| &cell.tip)),
            _ => Box::new(std::iter::empty()),
        }
    }

    fn tips_mut(&mut self) -> Box<dyn Iterator<Item = &mut Option<Tip>> + '_> {
        match self {
            Self::Points(points) => Box::new(points.iter_mut().map(|point| &mut point.tip)),
            Self::Cells(cells) => Box::new(cells.iter_mut().map(|cell| &mut cell.tip)),
            _ => Box::new(std::iter::empty()),
        }
    }
}

impl Panel {
    /// An empty panel of the usual height.
    pub fn new(title: &str, x: Scale, y: Scale) -> Self {
        Self {
            title: title.to_owned(),
            height: 0.0,
            x,
            y,
            right: None,
            layers: Vec::new(),
            legend: Vec::new(),
            note: String::new(),
        }
    }

    /// A place without a drawing, which fills a row of panels.
    pub fn blank() -> Self {
        let scale = || Scale::new("", Axis::Names(Vec::new()));
        Self::new("", scale(), scale())
    }

    /// Adds a line with an entry in the panel's legend.
    pub fn line(&mut self, label: &str, pen: Pen, points: Vec<At>) {
        self.layers.push(Layer::Line { points, pen, right: false });
        self.legend.push(Entry::line(pen, label));
    }

    /// Adds an entry to the panel's legend, unless it has one with the same words.
    pub fn explain(&mut self, entry: Entry) {
        if !self.legend.iter().any(|own| own.text == entry.text) {
            self.legend.push(entry);
        }
    }
}

impl Scale {
    /// An axis with a name.
    pub fn new(label: &str, axis: Axis) -> Self {
        Self { label: label.to_owned(), axis, ticks: Vec::new(), has_grid: true }
    }

    /// A linear scale around the finite ones of the values, at least `least` wide; without ticks if there are none.
    pub fn spanning(label: &str, values: impl Iterator<Item = f64>, least: f64) -> Self {
        let (low, high) = values
            .filter(|x| x.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let axis = if low <= high { Axis::spanning(low, high, least) } else { Axis::Names(Vec::new()) };
        Self::new(label, axis)
    }

    /// A linear scale from `low` to `high` without a margin.
    pub fn from_to(label: &str, low: f64, high: f64) -> Self {
        Self::new(label, Axis::Linear(low..high))
    }

    /// Without lines across the plot.
    #[must_use]
    pub fn without_grid(mut self) -> Self {
        self.has_grid = false;
        self
    }

    /// The ticks with their labels.
    pub fn labelled_ticks(&self) -> Vec<(f64, String)> {
        if self.ticks.is_empty() { self.axis.labelled_ticks() } else { self.ticks.clone() }
    }
}

impl Marker {
    /// A filled marker of the usual size.
    pub const fn new(shape: Shape, colour: Rgb) -> Self {
        Self { shape, colour, is_hollow: false, radius: 5.0 }
    }

    /// With only its outline, if that is asked for.
    #[must_use]
    pub const fn hollow(mut self, is_hollow: bool) -> Self {
        self.is_hollow = is_hollow;
        self
    }

    /// With half the size \[px\].
    #[must_use]
    pub const fn sized(mut self, radius: f64) -> Self {
        self.radius = radius;
        self
    }
}

impl Guide {
    /// A dashed line at a value of the ordinate.
    pub fn level(at: f64, colour: Rgb) -> Self {
        Self { at, is_vertical: false, pen: Pen::dashed(colour, 1.5), label: String::new(), right: false }
    }

    /// A dashed line at a value of the abscissa, with a few characters at its upper end.
    pub fn mark(at: f64, label: &str) -> Self {
        Self { is_vertical: true, label: label.to_owned(), ..Self::level(at, INK) }
    }
}

impl Entry {
    /// A heading.
    pub fn heading(text: &str) -> Self {
        Self { sample: Sample::Heading, text: text.to_owned() }
    }

    /// The meaning of a line.
    pub fn line(pen: Pen, text: &str) -> Self {
        Self { sample: Sample::Line(pen), text: text.to_owned() }
    }

    /// The meaning of a marker.
    pub fn marker(marker: Marker, text: &str) -> Self {
        Self { sample: Sample::Marker(marker), text: text.to_owned() }
    }

    /// The meaning of a marker's shape, whatever its colour.
    pub fn shape(shape: Shape, text: &str) -> Self {
        Self::marker(Marker::new(shape, GREY), text)
    }

    /// The meaning of a cell.
    pub fn cell(fill: Rgb, letters: &str, text: &str) -> Self {
        Self { sample: Sample::Cell(fill, letters.to_owned()), text: text.to_owned() }
    }
}

impl ColourScale {
    /// A scale of so many colours that `colour` gives for shares from 0 to 1.
    pub fn new(title: &str, steps: usize, colour: impl Fn(f64) -> Rgb, ticks: Vec<(f64, String)>) -> Self {
        let share = |step: usize| (step as f64 + 0.5) / steps as f64;
        Self { title: title.to_owned(), colours: (0..steps).map(|step| colour(share(step))).collect(), ticks }
    }
}

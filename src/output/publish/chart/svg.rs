//! Drawings as SVG: polygons, lines, circles, arrows, dimensions and texts at any position.
//!
//! Black, white and the grey of grids have classes, so that a page can swap them where the reader's system is dark. In a
//! file of its own a drawing is black on white.

use super::Tip;
use super::palette::{GRID, INK, PAPER, Rgb};
use std::fmt::Write;

/// A position, in pixels with y downwards, or in the units of two axes.
pub type At = (f64, f64);

/// Where a text is in relation to its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// The text begins there.
    Start,
    /// The text is centred there.
    Middle,
    /// The text ends there.
    End,
}

/// A line: its colour, its width \[px\], the lengths of dash and gap \[px\], and how much it covers, from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pen {
    /// Colour.
    pub colour: Rgb,
    /// Width \[px\].
    pub width: f64,
    /// Lengths of dash and gap \[px\]; both are 0 for a continuous line.
    pub dash: (f64, f64),
    /// How much it covers, from 0 to 1.
    pub cover: f64,
}

impl Pen {
    /// A continuous line.
    pub const fn solid(colour: Rgb, width: f64) -> Self {
        Self { colour, width, dash: (0.0, 0.0), cover: 1.0 }
    }

    /// A dashed line.
    pub const fn dashed(colour: Rgb, width: f64) -> Self {
        Self { dash: (6.0, 5.0), ..Self::solid(colour, width) }
    }
}

/// Fonts with Greek letters and dashes. Every system has one of them.
const FONT: &str = "Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";
/// Size of text \[px\].
pub const TEXT: f64 = 14.0;
/// Length of the head of an arrow \[px\].
const HEAD: f64 = 9.0;

/// A drawing.
#[derive(Debug, Clone)]
pub struct Svg {
    size: At,
    body: String,
    hits: String,
}

/// A coordinate with at most one decimal, in tenths. A report has hundreds of thousands of them.
struct Px(i64);

impl std::fmt::Display for Px {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let sign = if self.0 < 0 { "-" } else { "" };
        let (whole, tenths) = (self.0.unsigned_abs() / 10, self.0.unsigned_abs() % 10);
        if tenths == 0 { write!(f, "{sign}{whole}") } else { write!(f, "{sign}{whole}.{tenths}") }
    }
}

fn px(x: f64) -> Px {
    Px((10.0 * x).round() as i64)
}

/// The attributes of a shape that is filled, as far as the fill covers (0 to 1), and has an outline. Colours that change with
/// the ground have classes, for fills (`f`) and strokes (`s`).
fn paint(fill: Option<(Rgb, f64)>, pen: Option<Pen>) -> String {
    let named = |colour: Option<Rgb>, kind: char| {
        let name = match colour? {
            INK => "ink",
            PAPER => "paper",
            GRID => "grid",
            _ => return None,
        };
        Some(format!("{name}-{kind}"))
    };
    let classes = [named(fill.map(|fill| fill.0), 'f'), named(pen.map(|pen| pen.colour), 's')];
    let classes: Vec<String> = classes.into_iter().flatten().collect();
    let mut text = String::new();
    if !classes.is_empty() {
        let _ = write!(text, " class=\"{}\"", classes.join(" "));
    }
    match fill {
        Some((colour, cover)) if cover < 1.0 => {
            let _ = write!(text, " fill=\"{colour}\" fill-opacity=\"{cover}\"");
        }
        Some((colour, _)) => {
            let _ = write!(text, " fill=\"{colour}\"");
        }
        None => text.push_str(" fill=\"none\""),
    }
    let Some(pen) = pen else { return text };
    let _ =
        write!(text, " stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"", pen.colour, pen.width);
    if pen.dash.0 > 0.0 {
        let _ = write!(text, " stroke-dasharray=\"{} {}\"", pen.dash.0, pen.dash.1);
    }
    if pen.cover < 1.0 {
        let _ = write!(text, " stroke-opacity=\"{}\"", pen.cover);
    }
    text
}

fn points(corners: &[At]) -> String {
    let mut text = String::new();
    for (number, (x, y)) in corners.iter().enumerate() {
        let _ = write!(text, "{}{},{}", if number == 0 { "" } else { " " }, px(*x), px(*y));
    }
    text
}

impl Svg {
    /// An empty sheet of so many pixels.
    pub fn new(size: At) -> Self {
        Self { size, body: String::new(), hits: String::new() }
    }

    /// Fills a polygon with a colour, as far as it covers (0 to 1), and draws its outline.
    pub fn polygon(&mut self, corners: &[At], fill: (Rgb, f64), outline: Option<Pen>) {
        let _ =
            writeln!(self.body, "<polygon points=\"{}\"{}/>", points(corners), paint(Some(fill), outline));
    }

    /// Fills the rectangle between two corners. Its sides are sharp, so that nothing is seen between neighbours.
    pub fn rectangle(&mut self, from: At, to: At, colour: Rgb) {
        let (x, y) = (px(from.0.min(to.0)), px(from.1.min(to.1)));
        let (width, height) = (px((to.0 - from.0).abs()), px((to.1 - from.1).abs()));
        let _ = writeln!(
            self.body,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" shape-rendering=\"crispEdges\"{}/>",
            paint(Some((colour, 1.0)), None)
        );
    }

    /// Draws straight lines from point to point.
    pub fn lines(&mut self, corners: &[At], pen: Pen) {
        let _ = writeln!(self.body, "<polyline points=\"{}\"{}/>", points(corners), paint(None, Some(pen)));
    }

    /// Draws a circle, filled with a colour unless that is `None`, with its outline.
    pub fn circle(&mut self, (x, y): At, radius: f64, fill: Option<Rgb>, outline: Option<Pen>) {
        let (x, y, radius) = (px(x), px(y), px(radius));
        let paint = paint(fill.map(|colour| (colour, 1.0)), outline);
        let _ = writeln!(self.body, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"{paint}/>");
    }

    /// Draws an arrow along straight lines; its head is at the last point, and not longer than 0.4 of all lines.
    pub fn arrow(&mut self, corners: &[At], pen: Pen) {
        self.lines(corners, pen);
        if let [.., before, tip] = corners {
            let length =
                corners.windows(2).map(|pair| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1)).sum();
            self.head(*before, *tip, length, pen.colour);
        }
    }

    /// The head of an arrow of a length \[px\], which comes from the direction of `from`.
    fn head(&mut self, from: At, tip: At, arrow: f64, colour: Rgb) {
        let (dx, dy) = (tip.0 - from.0, tip.1 - from.1);
        let length = dx.hypot(dy);
        if length > 0.0 {
            let head = HEAD.min(0.4 * arrow.max(2.0));
            let (ux, uy) = (dx / length * head, dy / length * head);
            let corner = |side: f64| (tip.0 - ux - side * uy, tip.1 - uy + side * ux);
            self.polygon(&[tip, corner(0.4), corner(-0.4)], (colour, 1.0), None);
        }
    }

    /// Draws a dimension: a line with a head at both ends, and its text beside it.
    pub fn dimension(&mut self, from: At, to: At, colour: Rgb, text: &str, at: (At, Anchor)) {
        self.lines(&[from, to], Pen::solid(colour, 1.2));
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        self.head(from, to, length, colour);
        self.head(to, from, length, colour);
        self.text(at.0, at.1, colour, text);
    }

    /// Writes one line of text with its middle at the height of the position. The character after a `_` is lowered. A seam in
    /// the colour of the ground keeps it readable on lines.
    pub fn text(&mut self, (x, y): At, anchor: Anchor, colour: Rgb, text: &str) {
        let _ = writeln!(
            self.body,
            "<text x=\"{}\" y=\"{}\" dy=\"0.35em\"{} font-family=\"{FONT}\" font-size=\"{TEXT}\"{}>{}</text>",
            px(x),
            px(y),
            named(anchor),
            seam(colour),
            with_subscripts(text)
        );
    }

    /// Writes one line of text of this size \[px\] as it is, without a seam.
    pub fn plain(&mut self, (x, y): At, anchor: Anchor, colour: Rgb, size: f64, text: &str) {
        let _ = writeln!(
            self.body,
            "<text x=\"{}\" y=\"{}\" dy=\"0.35em\"{} font-size=\"{}\"{}>{}</text>",
            px(x),
            px(y),
            named(anchor),
            px(size),
            paint(Some((colour, 1.0)), None),
            escape(text)
        );
    }

    /// As [`Svg::plain`], in black, upwards along the left side of the position.
    pub fn upwards(&mut self, (x, y): At, size: f64, text: &str) {
        let (x, y) = (px(x), px(y));
        let _ = writeln!(
            self.body,
            "<text x=\"{x}\" y=\"{y}\" dy=\"0.35em\" text-anchor=\"middle\" transform=\"rotate(-90 {x} {y})\" font-size=\"{}\"{}>{}</text>",
            px(size),
            paint(Some((INK, 1.0)), None),
            escape(text)
        );
    }

    /// Restricts what `draw` draws to a rectangle.
    pub fn clipped(&mut self, from: At, to: At, draw: impl FnOnce(&mut Self)) {
        // The inner drawing has a viewport of its own, which needs no name that is unique in a page.
        let (width, height) = (to.0 - from.0, to.1 - from.1);
        let _ = writeln!(
            self.body,
            "<svg x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" viewBox=\"{0} {1} {2} {3}\">",
            px(from.0),
            px(from.1),
            px(width),
            px(height)
        );
        draw(self);
        self.body.push_str("</svg>\n");
    }

    /// Adds an invisible circle with a tooltip, on top of everything.
    pub fn hit_circle(&mut self, (x, y): At, radius: f64, tip: &Tip) {
        let _ = write!(self.hits, "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"", px(x), px(y), px(radius));
        self.hit("circle", tip);
    }

    /// Adds an invisible rectangle with a tooltip, on top of everything.
    pub fn hit_rectangle(&mut self, from: At, to: At, tip: &Tip) {
        let (x, y) = (px(from.0.min(to.0)), px(from.1.min(to.1)));
        let (width, height) = (px((to.0 - from.0).abs()), px((to.1 - from.1).abs()));
        let _ = write!(self.hits, "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"");
        self.hit("rect", tip);
    }

    fn hit(&mut self, name: &str, tip: &Tip) {
        for (attribute, value) in &tip.data {
            let _ = write!(self.hits, " data-{attribute}=\"{}\"", escape(value));
        }
        let _ = writeln!(self.hits, "><title>{}</title></{name}>", escape(&tip.title));
    }

    /// The drawing. `alternative` says in words what it shows; it may be empty.
    pub fn finish(self, alternative: &str) -> String {
        let (width, height) = (px(self.size.0), px(self.size.1));
        let label = if alternative.is_empty() {
            String::new()
        } else {
            format!(" role=\"graphics-document\" aria-label=\"{}\"", escape(alternative))
        };
        let hits = if self.hits.is_empty() {
            String::new()
        } else {
            format!("<g class=\"hits\" fill=\"none\" pointer-events=\"all\">\n{}</g>\n", self.hits)
        };
        format!(
            "<svg{label} width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"{FONT}\" \
             xmlns=\"http://www.w3.org/2000/svg\">\n<rect width=\"{width}\" height=\"{height}\"{}/>\n{}{hits}</svg>\n",
            paint(Some((PAPER, 1.0)), None),
            self.body
        )
    }
}

fn named(anchor: Anchor) -> &'static str {
    match anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    }
}

/// The colour of a text with a seam.
fn seam(colour: Rgb) -> String {
    let class = if colour == INK { "ink-f paper-s" } else { "paper-s" };
    format!(
        " class=\"{class}\" fill=\"{colour}\" stroke=\"{PAPER}\" stroke-width=\"3.5\" stroke-linejoin=\"round\" \
         paint-order=\"stroke\""
    )
}

/// Text for XML in which the character after a `_` is a subscript.
fn with_subscripts(text: &str) -> String {
    let mut parts = text.split('_');
    let mut marked = escape(parts.next().unwrap_or_default());
    for part in parts {
        let mut characters = part.chars();
        let index = characters.next().map_or_else(String::new, String::from);
        let rest = escape(characters.as_str());
        // The next text goes up again, so there is always one, which may be invisible.
        let _ = write!(
            marked,
            "<tspan dy=\"3.5\" font-size=\"10.5\">{}</tspan><tspan dy=\"-3.5\">{rest}</tspan>",
            escape(&index)
        );
    }
    marked
}

/// Text for XML, in an element or an attribute.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '"' => escaped.push_str("&quot;"),
            '\n' => escaped.push('\n'),
            // XML does not allow control characters.
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a text cannot become markup, and the character after a `_` is lowered.
    #[test]
    fn texts_are_texts() {
        let mut svg = Svg::new((10.0, 10.0));
        svg.text((1.0, 2.0), Anchor::End, Rgb(0, 0, 255), "l_x < <b>");
        let tip = Tip { title: "<script>\u{1}".to_owned(), data: vec![("job", "\"><b>".to_owned())] };
        svg.hit_circle((3.0, 4.0), 5.0, &tip);
        let svg = svg.finish("a \"b\"");
        let expected = ">l<tspan dy=\"3.5\" font-size=\"10.5\">x</tspan><tspan dy=\"-3.5\"> &lt; &lt;b&gt;</tspan></text>";
        assert!(svg.contains(expected) && svg.contains("fill=\"#0000FF\""), "{svg}");
        let hit = "<circle cx=\"3\" cy=\"4\" r=\"5\" data-job=\"&quot;&gt;&lt;b&gt;\"><title>&lt;script&gt; </title></circle>";
        assert!(svg.contains(hit) && svg.contains("aria-label=\"a &quot;b&quot;\""), "{svg}");
    }
}

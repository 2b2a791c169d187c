//! Drawings of bodies: outlines, arrows, dimensions and texts at any position, as SVG.
//!
//! Charts come from the drawing library. It rounds to whole pixels and has no arrows, so sketches are written directly.

use super::tooltip::escape;
use super::{FONT, RGBColor};
use std::fmt::Write;

/// A position [px], y downwards.
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

/// A line: colour, width [px], and whether it is dashed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Colour.
    pub colour: RGBColor,
    /// Width [px].
    pub width: f64,
    /// Whether it is dashed.
    pub dashed: bool,
}

impl Line {
    /// A continuous line.
    pub const fn solid(colour: RGBColor, width: f64) -> Self {
        Self { colour, width, dashed: false }
    }
}

/// Size of text [px].
pub const TEXT: f64 = 14.0;
/// Length of the head of an arrow [px].
const HEAD: f64 = 9.0;

/// A drawing.
#[derive(Debug, Clone)]
pub struct Sketch {
    size: (u32, u32),
    body: String,
}

fn hex(RGBColor(r, g, b): RGBColor) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

impl Sketch {
    /// An empty sheet of so many pixels.
    pub fn new(size: (u32, u32)) -> Self {
        Self { size, body: String::new() }
    }

    /// Fills a polygon with a colour, as far as it covers (0 to 1), and draws its outline.
    pub fn polygon(&mut self, corners: &[At], fill: (RGBColor, f64), outline: Option<Line>) {
        let points = points(corners);
        let stroke = outline.map_or_else(String::new, stroke);
        let _ = writeln!(
            self.body,
            "<polygon points=\"{points}\" fill=\"{}\" fill-opacity=\"{}\" stroke-linejoin=\"round\"{stroke}/>",
            hex(fill.0),
            fill.1
        );
    }

    /// Draws straight lines from point to point.
    pub fn lines(&mut self, corners: &[At], line: Line) {
        let _ = writeln!(
            self.body,
            "<polyline points=\"{}\" fill=\"none\" stroke-linejoin=\"round\"{}/>",
            points(corners),
            stroke(line)
        );
    }

    /// Draws a circle, filled with a colour unless that is none.
    pub fn circle(&mut self, centre: At, radius: f64, fill: Option<RGBColor>, line: Line) {
        let fill = fill.map_or_else(|| "none".to_owned(), hex);
        let _ = writeln!(
            self.body,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius:.1}\" fill=\"{fill}\"{}/>",
            centre.0,
            centre.1,
            stroke(line)
        );
    }

    /// Draws an arrow along straight lines; its head is at the last point.
    pub fn arrow(&mut self, corners: &[At], line: Line) {
        self.lines(corners, line);
        if let [.., before, tip] = corners {
            self.head(*before, *tip, line.colour);
        }
    }

    fn head(&mut self, from: At, tip: At, colour: RGBColor) {
        let (dx, dy) = (tip.0 - from.0, tip.1 - from.1);
        let length = dx.hypot(dy);
        if length > 0.0 {
            let (ux, uy) = (dx / length * HEAD, dy / length * HEAD);
            let corner = |side: f64| (tip.0 - ux - side * uy, tip.1 - uy + side * ux);
            self.polygon(&[tip, corner(0.4), corner(-0.4)], (colour, 1.0), None);
        }
    }

    /// Draws a dimension: a line with a head at both ends, and its text beside it.
    pub fn dimension(&mut self, from: At, to: At, colour: RGBColor, text: &str, at: (At, Anchor)) {
        self.lines(&[from, to], Line::solid(colour, 1.2));
        self.head(from, to, colour);
        self.head(to, from, colour);
        self.text(at.0, at.1, colour, text);
    }

    /// Writes one line of text with its middle at the height of the position. The character after a `_` is lowered. A white seam keeps it readable on lines.
    pub fn text(&mut self, at: At, anchor: Anchor, colour: RGBColor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let _ = writeln!(
            self.body,
            "<text x=\"{:.1}\" y=\"{:.1}\" dy=\"0.35em\" text-anchor=\"{anchor}\" font-family=\"{FONT}\" font-size=\"{TEXT}\" \
             fill=\"{}\" stroke=\"#FFFFFF\" stroke-width=\"3.5\" stroke-linejoin=\"round\" paint-order=\"stroke\">{}</text>",
            at.0,
            at.1,
            hex(colour),
            with_subscripts(text)
        );
    }

    /// The drawing as SVG.
    pub fn finish(self) -> String {
        let (width, height) = self.size;
        format!(
            "<svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             xmlns=\"http://www.w3.org/2000/svg\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n{}</svg>\n",
            self.body
        )
    }
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

fn points(corners: &[At]) -> String {
    let words: Vec<String> = corners.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    words.join(" ")
}

fn stroke(line: Line) -> String {
    let dashes = if line.dashed { " stroke-dasharray=\"6 5\"" } else { "" };
    format!(" stroke=\"{}\" stroke-width=\"{}\"{dashes}", hex(line.colour), line.width)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a text cannot become markup, and the character after a `_` is lowered.
    #[test]
    fn texts_are_texts() {
        let mut sketch = Sketch::new((10, 10));
        sketch.text((1.0, 2.0), Anchor::End, RGBColor(0, 0, 255), "l_x < <b>");
        let svg = sketch.finish();
        let expected = ">l<tspan dy=\"3.5\" font-size=\"10.5\">x</tspan><tspan dy=\"-3.5\"> &lt; &lt;b&gt;</tspan></text>";
        assert!(svg.contains(expected) && svg.contains("fill=\"#0000FF\""), "{svg}");
    }
}

//! What a drawing tells about its points: invisible shapes over them, with a title that browsers show and with the
//! values as attributes for programs.

use std::fmt::Write;

/// Where a point can be pointed at, in the drawing's pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Around a marker.
    Around {
        /// Its centre.
        at: (i32, i32),
        /// How far from it.
        radius: i32,
    },
    /// A cell, from its upper left to its lower right corner.
    Cell {
        /// Upper left.
        from: (i32, i32),
        /// Lower right.
        to: (i32, i32),
    },
}

/// A point of a drawing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Hit {
    /// Where it is.
    pub shape: Shape,
    /// What is told about it, in lines; the first is the heading.
    pub title: String,
    /// Names and values of the attributes `data-NAME`; names are plain words.
    pub data: Vec<(&'static str, String)>,
}

/// Adds the points to a drawing, on top of everything, the last of them uppermost.
pub fn append(svg: &str, hits: &[Hit]) -> String {
    let Some(end) = svg.rfind("</svg>").filter(|_| !hits.is_empty()) else { return svg.to_owned() };
    let mut text = String::with_capacity(svg.len() + 256 * hits.len());
    text.push_str(&svg[..end]);
    text.push_str("<g class=\"hits\" fill=\"none\" pointer-events=\"all\">\n");
    for hit in hits {
        let name = match hit.shape {
            Shape::Around { at: (x, y), radius } => {
                let _ = write!(text, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"");
                "circle"
            }
            Shape::Cell { from: (left, top), to: (right, bottom) } => {
                let (width, height) = (right - left, bottom - top);
                let _ = write!(text, "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"");
                "rect"
            }
        };
        for (attribute, value) in &hit.data {
            let _ = write!(text, " data-{attribute}=\"{}\"", escape(value));
        }
        let _ = writeln!(text, "><title>{}</title></{name}>", escape(&hit.title));
    }
    text.push_str("</g>\n");
    text.push_str(&svg[end..]);
    text
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
            // XML has no place for control characters.
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: what a study names cannot become markup, and a drawing without points stays as it is.
    #[test]
    fn text_stays_text() {
        let shape = Shape::Around { at: (3, 4), radius: 5 };
        let hit = Hit { shape, title: "<script>\u{1}".to_owned(), data: vec![("job", "\"><b>".to_owned())] };
        let svg = append("<svg>\n</svg>\n", &[hit]);
        let expected = "<circle cx=\"3\" cy=\"4\" r=\"5\" data-job=\"&quot;&gt;&lt;b&gt;\"><title>&lt;script&gt; </title></circle>";
        assert!(svg.contains(expected) && svg.ends_with("</g>\n</svg>\n"), "{svg}");
        assert_eq!(append("<svg></svg>", &[]), "<svg></svg>");
    }
}

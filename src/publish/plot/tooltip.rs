//! Tooltips in a drawing: invisible shapes with a title, which browsers show, and with values as attributes, which
//! programs read.

use std::fmt::Write;

/// The area that has a tooltip, in pixels of the drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A circle around a marker.
    Around {
        /// Centre.
        at: (i32, i32),
        /// Radius.
        radius: i32,
    },
    /// A rectangle.
    Cell {
        /// Upper left corner.
        from: (i32, i32),
        /// Lower right corner.
        to: (i32, i32),
    },
}

/// A shape with a tooltip.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TooltipTarget {
    /// Where the pointer shows the tooltip.
    pub shape: Shape,
    /// The text in lines; the first is the heading.
    pub title: String,
    /// Names and values of the attributes `data-NAME`; names are lower-case ASCII letters.
    pub data: Vec<(&'static str, String)>,
}

/// Adds shapes with tooltips to a drawing, on top of everything, the last of them uppermost.
pub fn append(svg: &str, targets: &[TooltipTarget]) -> String {
    let Some(end) = svg.rfind("</svg>").filter(|_| !targets.is_empty()) else { return svg.to_owned() };
    let mut text = String::with_capacity(svg.len() + 256 * targets.len());
    text.push_str(&svg[..end]);
    text.push_str("<g class=\"hits\" fill=\"none\" pointer-events=\"all\">\n");
    for target in targets {
        let name = match target.shape {
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
        for (attribute, value) in &target.data {
            let _ = write!(text, " data-{attribute}=\"{}\"", escape(value));
        }
        let _ = writeln!(text, "><title>{}</title></{name}>", escape(&target.title));
    }
    text.push_str("</g>\n");
    text.push_str(&svg[end..]);
    text
}

/// Text for XML, in an element or an attribute.
pub(super) fn escape(text: &str) -> String {
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

    /// Protects: a name or message of a study cannot become markup, and a drawing without tooltips is unchanged.
    #[test]
    fn text_stays_text() {
        let shape = Shape::Around { at: (3, 4), radius: 5 };
        let target = TooltipTarget {
            shape,
            title: "<script>\u{1}".to_owned(),
            data: vec![("job", "\"><b>".to_owned())],
        };
        let svg = append("<svg>\n</svg>\n", &[target]);
        let expected = "<circle cx=\"3\" cy=\"4\" r=\"5\" data-job=\"&quot;&gt;&lt;b&gt;\"><title>&lt;script&gt; </title></circle>";
        assert!(svg.contains(expected) && svg.ends_with("</g>\n</svg>\n"), "{svg}");
        assert_eq!(append("<svg></svg>", &[]), "<svg></svg>");
    }
}

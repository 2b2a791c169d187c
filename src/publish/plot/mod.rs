//! Drawing as SVG.
//!
//! The drawing library rounds to whole pixels, so drawings are made at twice the size that they are shown at.

pub mod axis;
pub mod hits;
pub mod palette;
pub mod panel;

use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, IntoDrawingArea, RGBColor, SVGBackend, Text, WHITE};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{IntoFont, TextStyle};

/// Why a figure could not be drawn.
pub type FigureError = plotters::drawing::DrawingAreaErrorKind<std::io::Error>;

/// Room around plot and legend [px].
pub const MARGIN: i32 = 36;
/// Size of text [px].
pub const TEXT: i32 = 34;
/// Fonts that have μ, ω and the dash, on every system one.
pub const FONT: &str = "Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";
/// Width of a curve [px].
pub const CURVE_WIDTH: u32 = 4;
/// Width of a guide [px].
pub const GUIDE_WIDTH: u32 = 3;
/// Length of a dash and of the gap after it [px].
pub const DASH: i32 = 12;
/// Colour of the lines at ticks.
pub const GRID: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);

/// A part of a drawing.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Makes a drawing of `size` [px] and gives it as SVG that is shown at half of it.
///
/// # Errors
/// Those of `draw`.
pub fn drawn(
    size: (u32, u32),
    draw: impl FnOnce(&Area) -> Result<(), FigureError>,
) -> Result<String, FigureError> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE)?;
        draw(&root)?;
        root.present()?;
    }
    let attributes = |(width, height): (u32, u32)| format!("width=\"{width}\" height=\"{height}\"");
    Ok(svg.replacen(&attributes(size), &attributes((size.0 / 2, size.1 / 2)), 1))
}

/// Writes a line of text, centred on its height.
///
/// # Errors
/// The drawing library's.
pub fn write(area: &Area, text: &str, at: (i32, i32), size: i32, anchor: HPos) -> Result<(), FigureError> {
    // XML has no place for control characters.
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let style = TextStyle::from((FONT, size).into_font()).pos(Pos::new(anchor, VPos::Center));
    area.draw(&Text::new(text, at, style))
}

/// The size at which text of this length stays within `room`: a character is about half as wide as high.
pub fn fitting(characters: usize, room: i32) -> i32 {
    (room * 2 / characters.max(1) as i32).clamp(8, TEXT)
}

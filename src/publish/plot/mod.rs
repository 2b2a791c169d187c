//! Drawing as SVG.
//!
//! The drawing library rounds to whole pixels, so drawings are made at twice the size that they are shown at.

pub mod axis;
pub mod canvas;
pub mod hits;
pub mod palette;
pub mod panel;

use plotters::prelude::RGBColor;

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

//! Drawings as SVG.
//!
//! The drawing library rounds to whole pixels, so drawings are made at twice the size that they are shown at. All
//! lengths here are in pixels of the drawing.

pub mod axis;
pub mod canvas;
pub mod palette;
pub mod panel;
pub mod tooltip;

pub use plotters::prelude::RGBColor;

impl From<crate::publish::chart::Rgb> for RGBColor {
    fn from(colour: crate::publish::chart::Rgb) -> Self {
        Self(colour.0, colour.1, colour.2)
    }
}

/// An error of the drawing library.
pub type DrawError = plotters::drawing::DrawingAreaErrorKind<std::io::Error>;

/// Space around the plot and the legend [px].
pub const MARGIN: i32 = 36;
/// Size of text [px].
pub const TEXT: i32 = 34;
/// Fonts with Greek letters and dashes. Every system has one of them.
pub const FONT: &str = "Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";
/// Width of a curve [px].
pub const CURVE_WIDTH: u32 = 4;
/// Width of a guide line [px].
pub const GUIDE_WIDTH: u32 = 3;
/// Length of a dash and of the gap after it [px].
pub const DASH: i32 = 12;
/// Colour of grid lines.
pub const GRID: RGBColor = RGBColor(0xE4, 0xE4, 0xE4);

//! The parts that all drawings share: the sheet, text, a caption, a frame.

#![expect(clippy::cast_possible_wrap, reason = "pixels and characters: thousands, not billions")]

use super::axis::Axis;
use super::tooltip::{self, TooltipTarget};
use super::{DrawError, FONT, GRID, MARGIN, TEXT};
use crate::publish::error::FigureError;
use plotters::chart::{ChartContext, MeshStyle};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::prelude::{
    BLACK, DrawingArea, IntoDrawingArea, PathElement, RGBColor, Rectangle, SVGBackend, Text, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, IntoFont, TRANSPARENT};

/// A part of a sheet.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// A part of a sheet with two axes.
pub type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

/// Width of a sheet with a legend beside the plot [px].
pub const WIDTH: u32 = 1800;
/// Its usual height [px].
pub const HEIGHT: u32 = 1120;
/// Height of a caption [px].
const CAPTION_HEIGHT: u32 = 64;
/// Height of the labels below an abscissa, with its name [px].
pub const X_LABELS: u32 = 104;

/// Draws on a white sheet of `size` [px], which is shown at half that size, and adds the tooltips that `draw` returns.
///
/// # Errors
/// Those of `draw`.
pub fn sheet(
    size: (u32, u32),
    draw: impl FnOnce(&Area) -> Result<Vec<TooltipTarget>, DrawError>,
) -> Result<String, FigureError> {
    let mut svg = String::new();
    let targets = draw_into(&mut svg, size, draw).map_err(FigureError::new)?;
    let as_text = |width: u32, height: u32| format!("width=\"{width}\" height=\"{height}\"");
    let svg = svg.replacen(&as_text(size.0, size.1), &as_text(size.0 / 2, size.1 / 2), 1);
    Ok(tooltip::append(&svg, &targets))
}

fn draw_into(
    svg: &mut String,
    size: (u32, u32),
    draw: impl FnOnce(&Area) -> Result<Vec<TooltipTarget>, DrawError>,
) -> Result<Vec<TooltipTarget>, DrawError> {
    let root = SVGBackend::with_string(svg, size).into_drawing_area();
    root.fill(&WHITE)?;
    let targets = draw(&root)?;
    root.present()?;
    Ok(targets)
}

/// Height of a caption [px]: 0 if it is empty.
pub fn caption_height(caption: &str) -> u32 {
    if caption.is_empty() { 0 } else { CAPTION_HEIGHT }
}

/// Draws a caption at the top unless it is empty, and returns the area below it.
///
/// # Errors
/// Those of the drawing library.
pub fn caption<'a>(root: &Area<'a>, words: &str) -> Result<Area<'a>, DrawError> {
    if words.is_empty() {
        return Ok(root.clone());
    }
    let (top, below) = root.split_vertically(CAPTION_HEIGHT);
    let width = root.dim_in_pixel().0 as i32;
    let size = fitting_size(words.chars().count(), width - 2 * MARGIN);
    write(&top, words, (width / 2, CAPTION_HEIGHT as i32 * 2 / 3), size, HPos::Center)?;
    Ok(below)
}

/// Writes one line of black text, vertically centred at `at`.
///
/// # Errors
/// Those of the drawing library.
pub fn write(area: &Area, text: &str, at: (i32, i32), size: i32, anchor: HPos) -> Result<(), DrawError> {
    write_coloured(area, text, at, size, anchor, BLACK)
}

/// As [`write`], in a colour.
///
/// # Errors
/// Those of the drawing library.
pub fn write_coloured(
    area: &Area,
    text: &str,
    at: (i32, i32),
    size: i32,
    anchor: HPos,
    colour: RGBColor,
) -> Result<(), DrawError> {
    // XML does not allow control characters.
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let style = (FONT, size).into_font().color(&colour).pos(Pos::new(anchor, VPos::Center));
    area.draw(&Text::new(text, at, style))
}

/// The text size at which so many characters are not wider than `room` [px]. A character is about half as wide as high.
pub fn fitting_size(characters: usize, room: i32) -> i32 {
    (room * 2 / characters.max(1) as i32).clamp(8, TEXT)
}

/// The grid and the axes of a chart in the common style. The caller adds the names of the axes and draws it.
pub fn mesh<'a, 'b, 'c>(chart: &'b mut Chart<'a, 'c>) -> MeshStyle<'a, 'b, Axis, Axis, SVGBackend<'c>> {
    let mut mesh = chart.configure_mesh();
    mesh.bold_line_style(GRID.stroke_width(2))
        .light_line_style(TRANSPARENT)
        .axis_style(BLACK.stroke_width(2))
        .set_all_tick_mark_size(8)
        .x_label_style((FONT, TEXT))
        .y_label_style((FONT, TEXT))
        .axis_desc_style((FONT, TEXT + 4));
    mesh
}

/// Draws the upper and the right side of the frame around a chart; the axes are the other two.
///
/// # Errors
/// Those of the drawing library.
pub fn frame(chart: &Chart) -> Result<(), DrawError> {
    let area = chart.plotting_area().strip_coord_spec();
    let (right, bottom) = (area.dim_in_pixel().0 as i32 - 1, area.dim_in_pixel().1 as i32 - 1);
    area.draw(&PathElement::new([(0, 0), (right, 0), (right, bottom)], BLACK.stroke_width(2)))
}

/// Draws the frame around a chart on all sides, for a chart without an axis below.
///
/// # Errors
/// Those of the drawing library.
pub fn whole_frame(chart: &Chart) -> Result<(), DrawError> {
    let area = chart.plotting_area().strip_coord_spec();
    let (right, bottom) = (area.dim_in_pixel().0 as i32 - 1, area.dim_in_pixel().1 as i32 - 1);
    let corners = [(0, 0), (right, 0), (right, bottom), (0, bottom), (0, 0)];
    area.draw(&PathElement::new(corners, BLACK.stroke_width(2)))
}

/// Fills a rectangle from its upper left to its lower right corner.
///
/// # Errors
/// Those of the drawing library.
pub fn fill_rectangle(
    area: &Area,
    from: (i32, i32),
    to: (i32, i32),
    colour: RGBColor,
) -> Result<(), DrawError> {
    area.draw(&Rectangle::new([from, to], colour.filled()))
}

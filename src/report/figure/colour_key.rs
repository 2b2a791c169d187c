//! A colour key beside or above a drawing: swatches of colours with their meaning.

use crate::publish::plot::canvas::{self, Area};
use crate::publish::plot::{DrawError, MARGIN, TEXT, palette};
use plotters::prelude::{BLACK, PathElement, RGBColor, WHITE};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

/// A swatch with its meaning.
pub(super) struct KeyEntry {
    pub swatch: Swatch,
    pub label: String,
}

/// A filled square with a character in it.
pub(super) struct Swatch {
    pub fill: RGBColor,
    pub symbol: char,
    pub ink: RGBColor,
}

impl Swatch {
    /// A character in black or white on a colour.
    pub fn filled(fill: RGBColor, symbol: char) -> Self {
        Self { fill, symbol, ink: palette::contrasting(fill) }
    }

    /// A coloured character on white.
    pub fn coloured(ink: RGBColor, symbol: char) -> Self {
        Self { fill: WHITE, symbol, ink }
    }
}

/// Side of a swatch [px].
const SIDE: i32 = 44;
/// Distance of the entries of a column [px].
pub(super) const PITCH: i32 = 54;

/// Draws the entries below one another, starting at height `top` [px].
pub(super) fn draw_column(area: &Area, top: i32, entries: &[KeyEntry]) -> Result<(), DrawError> {
    let room = area.dim_in_pixel().1 as i32 - top - MARGIN / 2;
    let pitch = (room / entries.len().max(1) as i32).min(PITCH);
    for (line, entry) in entries.iter().enumerate() {
        draw(area, (0, top + pitch / 2 + line as i32 * pitch), pitch * 4 / 5, entry)?;
    }
    Ok(())
}

/// Draws the entries beside one another, starting at `left` with a distance of `pitch` [px].
pub(super) fn draw_row(area: &Area, left: i32, pitch: i32, entries: &[KeyEntry]) -> Result<(), DrawError> {
    let middle = area.dim_in_pixel().1 as i32 / 2;
    for (number, entry) in entries.iter().enumerate() {
        draw(area, (left + number as i32 * pitch, middle), SIDE, entry)?;
    }
    Ok(())
}

fn draw(area: &Area, (x, y): (i32, i32), side: i32, entry: &KeyEntry) -> Result<(), DrawError> {
    let side = side.min(SIDE);
    let size = TEXT.min(side * 4 / 5);
    let (left, right, top, bottom) = (x, x + side, y - side / 2, y - side / 2 + side);
    let Swatch { fill, symbol, ink } = entry.swatch;
    canvas::fill_rectangle(area, (left, top), (right, bottom), fill)?;
    let outline = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
    area.draw(&PathElement::new(outline, BLACK.mix(0.4).stroke_width(1)))?;
    canvas::write_coloured(area, &symbol.to_string(), (x + side / 2, y), size, HPos::Center, ink)?;
    canvas::write(area, &entry.label, (right + 16, y), size, HPos::Left)
}

//! A key beside or above a drawing: samples of colours with what they mean.

use crate::publish::plot::canvas::{self, Area};
use crate::publish::plot::{DrawError, MARGIN, TEXT, palette};
use plotters::prelude::{BLACK, PathElement, RGBColor, WHITE};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

/// An entry.
pub(super) struct KeyEntry {
    pub swatch: Swatch,
    pub label: String,
}

/// A filled square with a glyph in it.
pub(super) struct Swatch {
    pub ground: RGBColor,
    pub glyph: char,
    pub ink: RGBColor,
}

impl Swatch {
    /// A glyph that shows on its ground.
    pub fn ground(ground: RGBColor, glyph: char) -> Self {
        Self { ground, glyph, ink: palette::contrasting(ground) }
    }

    /// A glyph in its colour on white.
    pub fn ink(ink: RGBColor, glyph: char) -> Self {
        Self { ground: WHITE, glyph, ink }
    }
}

/// Side of a swatch [px].
const SAMPLE: i32 = 44;
const PITCH: i32 = 54;

/// Draws the entries below one another, from so far down.
pub(super) fn below(area: &Area, top: i32, entries: &[KeyEntry]) -> Result<(), DrawError> {
    let room = area.dim_in_pixel().1 as i32 - top - MARGIN / 2;
    let pitch = (room / entries.len().max(1) as i32).min(PITCH);
    for (line, entry) in entries.iter().enumerate() {
        draw(area, (0, top + pitch / 2 + line as i32 * pitch), pitch * 4 / 5, entry)?;
    }
    Ok(())
}

/// Draws the entries beside one another, each in so much room.
pub(super) fn beside(area: &Area, left: i32, room: i32, entries: &[KeyEntry]) -> Result<(), DrawError> {
    let middle = area.dim_in_pixel().1 as i32 / 2;
    for (place, entry) in entries.iter().enumerate() {
        draw(area, (left + place as i32 * room, middle), SAMPLE, entry)?;
    }
    Ok(())
}

fn draw(area: &Area, (x, y): (i32, i32), side: i32, entry: &KeyEntry) -> Result<(), DrawError> {
    let side = side.min(SAMPLE);
    let size = TEXT.min(side * 4 / 5);
    let (left, right, top, bottom) = (x, x + side, y - side / 2, y - side / 2 + side);
    let Swatch { ground, glyph, ink } = entry.swatch;
    canvas::fill_rectangle(area, (left, top), (right, bottom), ground)?;
    let outline = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
    area.draw(&PathElement::new(outline, BLACK.mix(0.4).stroke_width(1)))?;
    canvas::write_coloured(area, &glyph.to_string(), (x + side / 2, y), size, HPos::Center, ink)?;
    canvas::write(area, &entry.label, (right + 16, y), size, HPos::Left)
}

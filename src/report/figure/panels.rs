//! Several panels in one figure.

use crate::publish::plot::canvas::{self, Area};
use crate::publish::plot::{DrawError, MARGIN};
use plotters::style::text_anchor::HPos;

pub(super) use super::MAX_PANELS;

/// Height of a panel's title [px].
pub(super) const TITLE: u32 = 80;
/// Largest number of lines in it.
const MAX_LINES: usize = 3;
/// Size of the text in a panel [px].
pub(super) const SMALL: i32 = 28;

/// So many panels stand beside one another.
pub(super) fn columns(panels: usize) -> usize {
    match panels {
        0 | 1 => 1,
        2..=4 => 2,
        5..=9 => 3,
        _ => 4,
    }
}

/// Writes the title of a panel, in several lines if it is long, and returns the area below it.
pub(super) fn title<'a>(area: &Area<'a>, words: &str, middle: i32) -> Result<Area<'a>, DrawError> {
    let (top, below) = area.split_vertically(TITLE);
    let width = area.dim_in_pixel().0 as i32 - MARGIN / 2;
    let lines = lines(words, (2 * width / SMALL) as usize);
    let pitch = (TITLE as i32 - 8) / lines.len().max(1) as i32;
    for (number, line) in lines.iter().enumerate() {
        let size = canvas::fitting_size(line.chars().count(), width).min(pitch).clamp(16, SMALL);
        let y = TITLE as i32 - 8 - (lines.len() - number) as i32 * pitch + pitch / 2;
        canvas::write(&top, line, (middle, y), size, HPos::Center)?;
    }
    Ok(below)
}

/// Words in at most three lines of about `room` characters, divided at commas.
fn lines(words: &str, room: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in words.split(", ") {
        let is_last_line = lines.len() == MAX_LINES;
        match lines.last_mut() {
            Some(line) if is_last_line || line.chars().count() + part.chars().count() + 2 <= room => {
                line.push_str(", ");
                line.push_str(part);
            }
            _ => lines.push(part.to_owned()),
        }
    }
    lines
}

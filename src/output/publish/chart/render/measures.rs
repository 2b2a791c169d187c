//! Lengths \[px\] and the widths of texts.

use crate::publish::chart::Scale;

/// Width of a drawing.
pub const WIDTH: f64 = 780.0;
/// Space around everything.
pub const MARGIN: f64 = 10.0;
/// Space between neighbouring panels.
pub const GAP: f64 = 14.0;
/// Size of text, where panels are large and where they are small.
pub const TEXT: f64 = 15.0;
pub const SMALL: f64 = 12.5;
/// Width of a character relative to the size of the text; a little more than the mean of the usual fonts.
pub const CHARACTER: f64 = 0.54;
/// The same of a label of a tick, because digits are wider than other characters.
pub const DIGIT: f64 = 0.64;
/// Length of a tick.
pub const TICK: f64 = 5.0;
/// Smallest and largest width of the legend.
pub const LEGEND: [f64; 2] = [90.0, 235.0];
/// Height of a row of labels on top of vertical lines. There are two rows, because the lines may be close to each other.
pub const MARK_ROW: f64 = 17.0;

pub fn width_of(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * CHARACTER
}

pub fn tick_width(label: &str, size: f64) -> f64 {
    label.chars().count() as f64 * size * DIGIT
}

/// The largest width of the labels of a scale.
pub fn ticks_width(scale: &Scale, size: f64) -> f64 {
    scale.labelled_ticks().iter().map(|(_, label)| tick_width(label, size)).fold(0.0, f64::max)
}

/// Words in lines that are not wider than `room`.
pub fn wrapped(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for given in text.split('\n') {
        let mut line = String::new();
        for word in given.split(' ') {
            let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
            if line.is_empty() || width_of(&longer, size) <= room {
                line = longer;
            } else {
                lines.push(std::mem::replace(&mut line, word.to_owned()));
            }
        }
        lines.push(line);
    }
    lines
}
